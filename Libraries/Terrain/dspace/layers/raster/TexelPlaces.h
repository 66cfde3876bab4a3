// Where the texels of a square lie in a raster. Not for public headers.
#ifndef DSPACE_LAYERS_TEXELPLACES_H
#define DSPACE_LAYERS_TEXELPLACES_H

#include <array>
#include <cstdint>
#include <vector>

#include <dspace/layers/ColorGrid.h>

namespace dspace {

class PixelFinder;

// Corners in pixels: top left, top right, bottom left, bottom right; x in any turn, but all four in
// one.
struct TexelCorners {
  std::array<Eigen::Vector2d, 4> at;
  Eigen::Vector2d Across() const {
    return 0.5 * (this->at[1] - this->at[0] + this->at[3] - this->at[2]);
  }
  Eigen::Vector2d Down() const {
    return 0.5 * (this->at[2] - this->at[0] + this->at[3] - this->at[1]);
  }
  Eigen::Vector2d Inside(double u, double v) const {
    return (1.0 - v) * (this->at[0] + u * (this->at[1] - this->at[0])) +
           v * (this->at[2] + u * (this->at[3] - this->at[2]));
  }
};

// Texels x to x + size - 1 of a square, and as many rows: between the corners their places are
// bilinear. One that is torn is a texel at a pole or at an edge of a projection, each of whose
// places is asked for.
struct TexelPatch {
  static constexpr int TornPlaces = 4; // a side

  int x = 0;
  int y = 0;
  int size = 1;
  int torn = -1; // the first of its places, row by row, in TexelPlaces::Torn(); else -1
  TexelCorners corners;

  // Of texel coordinates in the square.
  Eigen::Vector2d At(double across, double down) const {
    return this->corners.Inside((across - this->x) / this->size, (down - this->y) / this->size);
  }
};

// PROJ is asked at the corners, edges and middles of squares of texels, and what lies between is
// interpolated where that is right to a hundredth of a pixel, or of a texel where that is larger;
// else the square is quartered.
class TexelPlaces {
public:
  static constexpr int Side = 64;

  // Texels column..column + Side - 1, and as many rows. `turn`: of the raster [pixels], or 0.
  TexelPlaces(const ColorGrid& grid, int zoom, std::int64_t column, std::int64_t row,
              const PixelFinder& finder, double turn);

  // Of all texels but those outside the grid's extent.
  const std::vector<TexelPatch>& Patches() const { return this->Patches_; }
  const std::vector<Eigen::Vector2d>& Torn() const { return this->Torn_; }

private:
  void Fill(const PixelFinder& finder, int x, int y, int size, const TexelCorners& corners);
  void Tear(const PixelFinder& finder);
  Eigen::Vector2d Near(const Eigen::Vector2d& p, const Eigen::Vector2d& to) const;

  Eigen::Affine2d TexelToMap_;
  Eigen::AlignedBox2d Extent_; // in texels from the square's corner
  double Turn_ = 0.0;
  std::vector<TexelPatch> Patches_;
  std::vector<Eigen::Vector2d> Torn_;
};

} // namespace dspace

#endif
