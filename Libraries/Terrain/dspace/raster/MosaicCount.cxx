#include <dspace/raster/MosaicCount.h>

#include <cstdint>
#include <map>

#include <gdal_priv.h>

#include <dspace/Budgets.h>
#include <dspace/Error.h>
#include <dspace/raster/MosaicSources.h>
#include <dspace/raster/NetworkScope.h>

namespace dspace {
namespace {

constexpr int MosaicNesting = 16;

[[noreturn]] void RejectMosaic(const std::string& path, const std::string& why) {
  throw Error(Error::Kind::InvalidArgument, "file '" + path.substr(0, 1000) + "'", why);
}

class MosaicCounter {
public:
  // Never more than the limit.
  std::uint64_t FilesBelow(const std::string& path, int depth) {
    if (const auto known = this->Known_.find(path); known != this->Known_.end()) {
      if (known->second == UnderWay) {
        RejectMosaic(path,
                     "it is among its own sources; accepted here: a mosaic (VRT) of plain files");
      }
      return known->second;
    }
    if (depth > MosaicNesting) {
      RejectMosaic(path, "a chain of " + std::to_string(MosaicNesting) +
                             " files that refer to each other leads to it");
    }
    this->Known_[path] = UnderWay;
    std::uint64_t files = 0;
    for (const std::string& source : MosaicSources(path)) {
      files += 1 + (this->IsOne(source) ? this->FilesBelow(source, depth + 1) : 0);
      if (files > this->Limit_) {
        throw Error(Error::Kind::Resource, "file '" + path.substr(0, 1000) + "'",
                    "this mosaic (VRT) makes more files be opened, counting the sources of its "
                    "sources; " +
                        BudgetText(Budget::MosaicFiles));
      }
    }
    this->Known_[path] = files;
    return files;
  }

private:
  static constexpr std::uint64_t UnderWay = ~std::uint64_t(0);

  bool IsOne(const std::string& source) {
    if (IsRemote(source)) {
      return false;
    }
    const auto [known, isNew] = this->Mosaics_.emplace(source, false);
    if (isNew) {
      known->second = IsMosaic(source);
    }
    return known->second;
  }

  const std::uint64_t Limit_ = BudgetOf(Budget::MosaicFiles);
  std::map<std::string, std::uint64_t> Known_;
  std::map<std::string, bool> Mosaics_;
};

} // namespace

bool IsMosaic(const std::string& path) {
  GDALDriver* vrt = GetGDALDriverManager()->GetDriverByName("VRT");
  GDALOpenInfo info(path.c_str(), GDAL_OF_RASTER);
  return vrt && vrt->pfnIdentify && vrt->pfnIdentify(&info) == TRUE;
}

void CheckMosaicSize(const std::string& path) {
  MosaicCounter().FilesBelow(path, 0);
}

} // namespace dspace
