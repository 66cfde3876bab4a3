// Squares of texels, and the raster's cells that they are means of. Not for public headers.
#ifndef DSPACE_LAYERS_SQUAREREADER_H
#define DSPACE_LAYERS_SQUAREREADER_H

#include <vector>

#include "BlockSampler.h"
#include "TexelPlaces.h"

namespace dspace {

// Places of a square, and the cells that they lie in.
struct TexelSquare {
  TexelSquare(const ColorGrid& grid, int zoom, std::int64_t column, std::int64_t row,
              const PixelFinder& finder, double turn)
      : places(grid, zoom, column, row, finder, turn) {}

  TexelPlaces places;
  std::vector<Eigen::Vector2d> torn; // places in each torn texel, in their order
  LevelWindow window;
  int blockColumn = 0; // of its first texel in the block; may lie outside
  int blockRow = 0;
};

class SquareReader {
public:
  SquareReader(const RasterLevels& levels, const RasterPosition& raster)
      : Levels_(levels), Raster_(raster) {}

  // False where it does not meet the raster.
  bool Settle(TexelSquare& square) const;
  void Read(const LevelWindow& window, std::vector<float>& cells) const;
  void Sample(const TexelSquare& square, const LevelWindow& window, const std::vector<float>& cells,
              const ColorBlock& block, float* texels) const;

private:
  Eigen::AlignedBox2d Reach(TexelSquare& square, Eigen::Vector2d& texel) const;
  bool Columns(const Eigen::AlignedBox2d& reach, LevelWindow& window) const;
  Eigen::Vector2d CellsAPixel(const LevelWindow& window) const {
    return {double(this->Levels_.ColumnsAt(window.levelX)) / this->Raster_.width,
            double(this->Levels_.RowsAt(window.levelY)) / this->Raster_.height};
  }

  const RasterLevels& Levels_;
  const RasterPosition& Raster_;
};

} // namespace dspace

#endif
