#include <dspace/raster/BlockBudget.h>

#include <algorithm>
#include <cstdint>

#include <dspace/Budgets.h>
#include <dspace/Error.h>
#include <dspace/raster/NetworkScope.h>

namespace dspace {
namespace {

void RequireBand(GDALRasterBand& band, std::uint64_t bands, const std::string& path) {
  int width = 0;
  int height = 0;
  band.GetBlockSize(&width, &height);
  const auto sample =
      static_cast<std::uint64_t>(std::max(1, GDALGetDataTypeSizeBytes(band.GetRasterDataType())));
  // Sides are below 2^31: the product of the first two fits.
  const std::uint64_t pixels = std::uint64_t(width) * std::uint64_t(height);
  if (width < 1 || height < 1 || pixels > BudgetOf(Budget::BlockBytes) / (sample * bands)) {
    throw Error(Error::Kind::Resource, "raster '" + path.substr(0, 1000) + "'",
                "its blocks have " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels of " + std::to_string(sample * bands) + " bytes; " +
                    BudgetText(Budget::BlockBytes));
  }
}

} // namespace

void RequireBlockBytes(GDALDataset& dataset, const std::string& path) {
  const int count = dataset.GetRasterCount();
  const char* interleave = dataset.GetMetadataItem("INTERLEAVE", "IMAGE_STRUCTURE");
  const std::uint64_t together =
      interleave && EQUAL(interleave, "PIXEL") ? static_cast<std::uint64_t>(count) : 1;
  for (int i = 1; i <= count; ++i) {
    GDALRasterBand& band = *dataset.GetRasterBand(i);
    RequireBand(band, together, path);
    // Asking for the overviews of a file on a server may send requests.
    for (int k = 0; i == 1 && !IsRemote(path) && k < band.GetOverviewCount(); ++k) {
      if (GDALRasterBand* overview = band.GetOverview(k)) {
        RequireBand(*overview, together, path);
      }
    }
  }
}

} // namespace dspace
