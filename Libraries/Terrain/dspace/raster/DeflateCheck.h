// Verifies the checksums of compressed blocks of a GeoTIFF, which GDAL does not.
#ifndef DSPACE_TERRAIN_DEFLATECHECK_H
#define DSPACE_TERRAIN_DEFLATECHECK_H

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_set>

#include <dspace/raster/ElevationSource.h>

class GDALDataset;
class GDALRasterBand;

namespace dspace {

// Every stream of zlib ends with a checksum (Adler-32) of what it holds. libtiff stops reading a
// stream when a block is full, before the checksum, so that flipped bytes may pass unnoticed. Each
// block that is read is therefore inflated once more, the first time. For files that GDAL's GTiff
// driver reads with DEFLATE from a disk; of all others nothing is said. Not for several threads at
// once.
class DeflateCheck {
public:
  // Keeps nothing of the band.
  DeflateCheck(GDALDataset& dataset, GDALRasterBand& band);
  ~DeflateCheck();

  // Describes the damage of blocks that meet a window of the file's own pixels; empty if none.
  std::string Check(GDALRasterBand& band, const RasterWindow& window);

private:
  bool IsIntact(GDALRasterBand& band, int column, int row);
  struct Closed {
    void operator()(void* file) const;
  };
  std::unique_ptr<void, Closed> File_; // null: nothing to check
  int Width_ = 1;                      // pixels of a block
  int Height_ = 1;
  std::size_t Bytes_ = 0; // of a block that is not compressed
  std::unordered_set<std::uint64_t> Checked_;
};

} // namespace dspace

#endif
