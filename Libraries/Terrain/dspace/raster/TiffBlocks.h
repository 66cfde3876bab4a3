// Where the blocks (tiles, strips) of a TIFF lie in its file.
#pragma once

#include <cstdint>

#include <cpl_conv.h>
#include <gdal_priv.h>

namespace dspace {

enum class TiffBlocks {
  Known,   // FindTiffBlock works
  Unknown, // a bitmap of one strip: GDAL gives the strip line by line, and a question about a line
           // makes GDAL's band unusable
  NoTiff,  // another format
};
TiffBlocks TiffBlocksOf(GDALRasterBand& band);

struct TiffBlock {
  std::uint64_t offset = 0; // bytes from the start of the file; 0: the file leaves the block out
  std::uint64_t size = 0;   // bytes, as stored
};

// Of a band whose blocks are Known. Reads no pixels.
TiffBlock FindTiffBlock(GDALRasterBand& band, int column, int row);

// While it lives, TIFFs that this thread opens give each strip as one block. Without it, GDAL
// splits a strip that covers the whole file into lines, which hides its size.
class WholeStrips {
public:
  WholeStrips() : Setting_("GDAL_ENABLE_TIFF_SPLIT", "NO", false) {}

private:
  CPLConfigOptionSetter Setting_;
};

} // namespace dspace
