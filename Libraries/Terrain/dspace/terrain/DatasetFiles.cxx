#include <dspace/terrain/DatasetFiles.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include <cpl_string.h>
#include <gdal_priv.h>

#include <dspace/FilesRead.h>

#include "GdalErrors.h"
#include "NetworkScope.h"
#include "OpenRaster.h"

namespace dspace {
namespace {

namespace fs = std::filesystem;

// The file on a disk behind GDAL's name of one: "/vsizip//a/b.zip/c.tif" lies in "/a/b.zip".
std::string OnDisk(const std::string& name) {
  std::string rest = name;
  while (rest.compare(0, 4, "/vsi") == 0 && !IsRemote(rest)) {
    const std::size_t slash = rest.find('/', 1);
    if (slash == std::string::npos) {
      return name;
    }
    if (rest.compare(0, slash, "/vsisubfile") == 0) { // "/vsisubfile/0_100,FILE"
      const std::size_t comma = rest.find(',', slash);
      if (comma == std::string::npos) {
        return name;
      }
      rest.erase(0, comma + 1);
      continue;
    }
    rest.erase(0, slash + 1);
    if (!rest.empty() && rest[0] == '{') { // "/vsizip/{FILE}/inside"
      rest = rest.substr(1, rest.find('}') - 1);
    }
  }
  std::error_code error;
  for (fs::path part = rest; part.has_relative_path(); part = part.parent_path()) {
    if (fs::exists(part, error)) {
      return part.string();
    }
  }
  return name;
}

bool IsMosaic(const std::string& path) {
  std::string start(1024, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(start.data(), std::streamsize(start.size()));
  start.resize(std::size_t(in.gcount()));
  return start.find("<VRTDataset") != std::string::npos ||
         start.find("<OGRVRTDataSource") != std::string::npos;
}

constexpr int Nesting = 16;

void Gather(const std::string& path, int depth, std::set<std::string>& files) {
  const DatasetPointer dataset(GDALDataset::Open(path.c_str(), GDAL_OF_READONLY));
  if (!dataset) {
    return;
  }
  const CPLStringList found(dataset->GetFileList());
  for (int i = 0; i < found.size(); ++i) {
    const std::string file = OnDisk(found[i]);
    if (files.insert(file).second && file != path && depth < Nesting && !IsRemote(file) &&
        IsMosaic(path)) {
      Gather(found[i], depth + 1, files);
    }
  }
}

} // namespace

void NoteDataset(GDALDataset& dataset) {
  const CPLStringList files(dataset.GetFileList());
  for (int i = 0; i < files.size(); ++i) {
    NoteFileRead(OnDisk(files[i]));
  }
}

std::vector<std::string> MosaicFiles(const std::string& path) {
  if (!IsMosaic(path)) {
    return {};
  }
  RegisterGdal();
  const GdalErrors quiet;
  std::set<std::string> files;
  Gather(path, 0, files);
  return {files.begin(), files.end()};
}

} // namespace dspace
