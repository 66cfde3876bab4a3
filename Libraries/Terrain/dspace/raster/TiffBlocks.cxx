#include <dspace/raster/TiffBlocks.h>

#include <cpl_string.h>

namespace dspace {
namespace {

std::uint64_t Item(GDALRasterBand& band, const char* what, int column, int row) {
  const char* text = band.GetMetadataItem(CPLSPrintf("BLOCK_%s_%d_%d", what, column, row), "TIFF");
  return text ? CPLScanUIntBig(text, 24) : 0;
}

} // namespace

TiffBlocks TiffBlocksOf(GDALRasterBand& band) {
  GDALDataset* dataset = band.GetDataset();
  if (!dataset || !dataset->GetDriver() ||
      !EQUAL(dataset->GetDriver()->GetDescription(), "GTiff")) {
    return TiffBlocks::NoTiff;
  }
  int width = 1;
  int height = 1;
  band.GetBlockSize(&width, &height);
  const char* bits = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
  return height > 1 || !bits || !EQUAL(bits, "1") ? TiffBlocks::Known : TiffBlocks::Unknown;
}

std::uint64_t TiffBlockOffset(GDALRasterBand& band, int column, int row) {
  return Item(band, "OFFSET", column, row);
}

std::uint64_t TiffBlockSize(GDALRasterBand& band, int column, int row) {
  return Item(band, "SIZE", column, row);
}

} // namespace dspace
