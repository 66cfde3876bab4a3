// Where the blocks (tiles, strips) of a TIFF lie in its file.
#pragma once

#include <cstdint>

#include <cpl_conv.h>
#include <gdal_priv.h>

namespace dspace {

enum class TiffBlocks {
  Known,   // TiffBlockOffset and TiffBlockSize work
  Unknown, // a bitmap of one strip: GDAL gives the strip line by line, and a question about a line
           // makes GDAL's band unusable
  NoTiff,  // another format
};
TiffBlocks TiffBlocksOf(GDALRasterBand& band);

// Of a block of a band whose blocks are Known: bytes from the start of the file, 0 where the file
// leaves the block out; and its bytes, as stored. They read no pixels.
std::uint64_t TiffBlockOffset(GDALRasterBand& band, int column, int row);
std::uint64_t TiffBlockSize(GDALRasterBand& band, int column, int row);

// While it lives, TIFFs that this thread opens give each strip as one block. Without it, GDAL
// splits a strip that covers the whole file into lines, which hides its size.
class WholeStrips {
public:
  WholeStrips() : Setting_("GDAL_ENABLE_TIFF_SPLIT", "NO", false) {}

private:
  CPLConfigOptionSetter Setting_;
};

} // namespace dspace
