// Reads single posts of level 0 between a raster's pixels. Not for public headers.
#ifndef DSPACE_TERRAIN_RASTERPROBE_H
#define DSPACE_TERRAIN_RASTERPROBE_H

#include <array>
#include <cstdint>

#include <dspace/posts/PixelWindows.h>
#include <dspace/posts/PostProbe.h>

namespace dspace {

// Posts of RasterPosts without a stretch. With poles, rows between a pole and the pixels next to
// it are not read.
class RasterProbe : public PostProbe {
public:
  RasterProbe(const PixelWindows& pixels, int subdivisions, bool poles);

  bool HasRows(std::int64_t first, std::int64_t last) const override;
  float At(std::int64_t column, std::int64_t row) override;

private:
  struct Held {
    std::int64_t column = -1; // counts tiles
    std::int64_t row = -1;
    PixelTiles::Tile tile;
    std::size_t width = 0; // of a row of it
  };
  double Pixel(std::int64_t column, std::int64_t row);

  const PixelTiles& Tiles_;
  std::int64_t Columns_; // of the raster
  std::int64_t Rows_;
  bool Periodic_;
  int Bits_;           // subdivisions
  std::int64_t Shift_; // rows from the lattice's first to that of the first pixels
  std::array<Held, 4> Held_;
};

} // namespace dspace

#endif
