#include <dspace/raster/DatasetFiles.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>

#include <cpl_minixml.h>
#include <cpl_string.h>
#include <gdal_priv.h>

#include <dspace/Error.h>
#include <dspace/FilesRead.h>

#include <dspace/gdal/GdalErrors.h>
#include <dspace/raster/NetworkScope.h>
#include <dspace/raster/OpenRaster.h>

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

// What GDAL tells documents by.
std::string Head(const std::string& path) {
  std::string start(1024, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(start.data(), std::streamsize(start.size()));
  start.resize(std::size_t(in.gcount()));
  return start;
}

bool IsMosaic(const std::string& path) {
  const std::string start = Head(path);
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

[[noreturn]] void Refuse(const std::string& path, const std::string& what) {
  throw Error(Error::Kind::InvalidArgument, "file '" + path + "'",
              "it " + what + "; accepted here: a mosaic (VRT) of plain files that are allowed too");
}

void Show(const std::string& path, int depth);

void ShowSource(const CPLXMLNode& node, const std::string& mosaic, int depth) {
  const std::string name = CPLGetXMLValue(&node, "", "");
  const bool relative = std::atoi(CPLGetXMLValue(&node, "relativetoVRT", "0")) != 0;
  const fs::path source = relative ? fs::path(mosaic).parent_path() / name : fs::path(name);
  std::error_code error;
  if (name.find('<') != std::string::npos || !fs::is_regular_file(source, error)) {
    // Shown first: whether there is a file elsewhere is not told.
    FilesGuard::Show(source.string());
    Refuse(mosaic, "names '" + name.substr(0, 200) + "', which is no plain file");
  }
  Show(source.string(), depth + 1);
}

// Documents are GDAL's to read: tags in upper and lower case are the same.
void ShowBelow(const CPLXMLNode* node, const std::string& mosaic, int depth) {
  for (; node; node = node->psNext) {
    const std::string name = node->pszValue ? node->pszValue : "";
    if (node->eType == CXT_Element && EQUAL(name.c_str(), "SourceFilename")) {
      ShowSource(*node, mosaic, depth);
      continue;
    }
    for (const char* other :
         {"SourceDataset", "SrcDataSource", "GDALWarpOptions", "OpenOptions",
          "PansharpeningOptions", "PixelFunctionCode", "Group", "ArraySource"}) {
      if (node->eType == CXT_Element && EQUAL(name.c_str(), other)) {
        Refuse(mosaic, "has the element '" + name + "'");
      }
    }
    if (node->eType == CXT_Attribute && EQUAL(name.c_str(), "subClass") && node->psChild &&
        !EQUAL(node->psChild->pszValue, "VRTSourcedRasterBand")) {
      Refuse(mosaic, "is of the sort '" + std::string(node->psChild->pszValue) + "'");
    }
    ShowBelow(node->psChild, mosaic, depth);
  }
}

void Show(const std::string& path, int depth) {
  FilesGuard::Show(path);
  const std::string head = Head(path);
  for (const char* other :
       {"<GDAL_WMS", "<GDAL_WMTS", "<Capabilities", "<WMS_Capabilities", "<WMT_MS_Capabilities",
        "<WCS_GDAL", "<TileMapService", "<OGRVRTDataSource", "<GDALTileIndexDataset",
        "<OGRWFSDataSource", "<wfs:", "<WFS_"}) {
    if (head.find(other) != std::string::npos) {
      Refuse(path, "is a document of the sort '" + std::string(other + 1) + "'");
    }
  }
  if (head.find("<VRTDataset") == std::string::npos) {
    return;
  }
  if (depth >= Nesting) {
    Refuse(path, "is a mosaic of mosaics, " + std::to_string(Nesting) + " deep");
  }
  const std::unique_ptr<CPLXMLNode, decltype(&CPLDestroyXMLNode)> document(
      CPLParseXMLFile(path.c_str()), CPLDestroyXMLNode);
  ShowBelow(document.get(), path, depth);
}

} // namespace

void ShowSources(const std::string& path) {
  if (FilesGuard::Lives()) {
    const GdalErrors quiet;
    Show(path, 0);
  }
}

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
