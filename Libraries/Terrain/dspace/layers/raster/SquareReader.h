// Squares of texels, and the raster's cells that they are means of. Not for public headers.
#ifndef DSPACE_LAYERS_SQUAREREADER_H
#define DSPACE_LAYERS_SQUAREREADER_H

#include <vector>

#include <dspace/layers/raster/BlockSampler.h>
#include <dspace/layers/raster/TexelPlaces.h>

namespace dspace {

// Of a square's texels: from left and top up to before right and bottom.
struct TexelRange {
  int left = 0;
  int top = 0;
  int right = TexelPlaces::Side;
  int bottom = TexelPlaces::Side;
};

// Places of a square, and the cells that they lie in.
struct TexelSquare {
  TexelPlaces places;
  TexelRange wanted;   // that lie in the block
  int blockColumn = 0; // of its first texel in the block; may lie outside
  int blockRow = 0;
  LevelWindow window; // that holds what is wanted
};

class SquareReader {
public:
  SquareReader(const RasterLevels& levels, const RasterPosition& raster)
      : Levels_(levels), Raster_(raster) {}

  // False where what is wanted does not meet the raster. The level is that of the whole square, so
  // that it is the same for all blocks.
  bool ChooseLevel(TexelSquare& square) const;
  void Read(const LevelWindow& window, std::vector<float>& cells) const;
  void Sample(const TexelSquare& square, const LevelWindow& window, const std::vector<float>& cells,
              const ColorBlock& block, float* texels) const;

private:
  bool Rows(const Eigen::AlignedBox2d& reach, LevelWindow& window) const;
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
