#include <dspace/raster/DatasetFiles.h>

#include <filesystem>
#include <fstream>
#include <set>

#include <cpl_string.h>
#include <gdal_priv.h>

#include <dspace/FilesRead.h>

#include <dspace/gdal/GdalErrors.h>
#include <dspace/raster/DatasetGate.h>
#include <dspace/raster/NetworkScope.h>
#include <dspace/raster/UnderlyingFile.h>

namespace dspace {
namespace {

namespace fs = std::filesystem;

// What GDAL tells documents by.
std::string Head(const std::string& path) {
  std::string start(1024, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(start.data(), std::streamsize(start.size()));
  start.resize(std::size_t(in.gcount()));
  return start;
}

bool NamesSources(const std::string& path) {
  const std::string start = Head(path);
  return start.find("<VRTDataset") != std::string::npos ||
         start.find("<OGRVRTDataSource") != std::string::npos;
}

constexpr int MaximumDepth = 16;

void Gather(const std::string& path, int depth, std::set<std::string>& files) {
  const DatasetPointer dataset = OpenDataset(path, DatasetKind::Any);
  if (!dataset) {
    return;
  }
  const CPLStringList found(dataset->GetFileList());
  for (int i = 0; i < found.size(); ++i) {
    const std::string file = UnderlyingFile(found[i]);
    if (files.insert(file).second && file != path && depth < MaximumDepth && !IsRemote(file) &&
        NamesSources(path)) {
      Gather(found[i], depth + 1, files);
    }
  }
}

} // namespace

void NoteDataset(GDALDataset& dataset) {
  const CPLStringList files(dataset.GetFileList());
  for (int i = 0; i < files.size(); ++i) {
    NoteFileRead(UnderlyingFile(files[i]));
  }
}

std::vector<std::string> MosaicFiles(const std::string& path) {
  if (!NamesSources(path)) {
    return {};
  }
  RegisterGdal();
  const GdalErrors quiet;
  std::set<std::string> files;
  Gather(path, 0, files);
  return {files.begin(), files.end()};
}

} // namespace dspace
