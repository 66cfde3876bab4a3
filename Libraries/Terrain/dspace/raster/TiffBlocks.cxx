#include <dspace/raster/TiffBlocks.h>

#include <cpl_string.h>

namespace dspace {

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

TiffBlock FindTiffBlock(GDALRasterBand& band, int column, int row) {
  const auto item = [&](const char* what) -> std::uint64_t {
    const char* text =
        band.GetMetadataItem(CPLSPrintf("BLOCK_%s_%d_%d", what, column, row), "TIFF");
    return text ? CPLScanUIntBig(text, 24) : 0;
  };
  TiffBlock block;
  block.offset = item("OFFSET");
  block.size = block.offset != 0 ? item("SIZE") : 0;
  return block;
}

} // namespace dspace
