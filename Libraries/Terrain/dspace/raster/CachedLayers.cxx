#include <dspace/raster/CachedLayers.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

#include <dspace/raster/OpenRaster.h>

namespace dspace {
namespace {

namespace fs = std::filesystem;
constexpr const char* Mark = "-layer-";
constexpr std::size_t HashLength = 32;

} // namespace

bool IsLayerFile(const std::string& file) {
  const fs::path path(file);
  const std::string name = path.filename().string();
  return path.extension() == ".tif" && name.find(Mark) == HashLength &&
         name.find_first_not_of("0123456789abcdef") == HashLength;
}

std::vector<ElevationCacheEntry> LayerEntries(const std::vector<std::string>& files) {
  std::map<std::string, ElevationCacheEntry> entries; // by what stands before the level
  std::vector<std::string> sorted = files;
  std::sort(sorted.begin(), sorted.end());
  for (const std::string& file : sorted) {
    const std::string stem = file.substr(0, file.rfind('-') + 1);
    std::error_code gone;
    const auto bytes = fs::file_size(file, gone);
    if (gone) {
      continue;
    }
    ElevationCacheEntry& entry = entries[stem];
    entry.file = entry.file.empty() ? file : entry.file;
    entry.layerFiles.push_back(file);
    entry.bytes += bytes;
    ++entry.levels;
    const GdalErrors quiet;
    const DatasetPointer dataset = OpenOwnTiff(file);
    entry.damaged |= !dataset;
    const char* path = dataset ? dataset->GetMetadataItem(LayerPathItem) : nullptr;
    entry.path = path ? ToUtf8(path) : entry.path;
  }
  std::vector<ElevationCacheEntry> all;
  all.reserve(entries.size());
  for (auto& [stem, entry] : entries) {
    all.push_back(std::move(entry));
  }
  return all;
}

void VerifyLayerFile(const std::string& file) {
  GdalErrors errors;
  const DatasetPointer dataset = OpenOwnTiff(file);
  bool good = dataset != nullptr;
  for (int band = 1; good && band <= dataset->GetRasterCount(); ++band) {
    std::vector<double> row(std::size_t(dataset->GetRasterXSize()));
    for (int y = 0; good && y < dataset->GetRasterYSize(); ++y) {
      const int width = dataset->GetRasterXSize();
      good = dataset->GetRasterBand(band)->RasterIO(GF_Read, 0, y, width, 1, row.data(), width, 1,
                                                    GDT_Float64, 0, 0, nullptr) == CE_None;
    }
  }
  if (!good || errors.Failed()) {
    throw Error(Error::Kind::Corrupt, "cached overviews '" + file + "'",
                "cannot be read: " + errors.Message("GDAL gave no reason"));
  }
}

} // namespace dspace
