// Where the texels of a square lie in a raster. Not for public headers.
#ifndef DSPACE_LAYERS_TEXELPLACES_H
#define DSPACE_LAYERS_TEXELPLACES_H

#include <array>
#include <cstdint>
#include <vector>

#include <dspace/layers/ColorGrid.h>

namespace dspace {

class PixelFinder;

// A texel's corners in pixels: top left, top right, bottom left, bottom right; x in any turn, but
// all four in one.
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

// PROJ is asked at the corners, edges and middles of squares of texels, and what lies between is
// interpolated where that is right to a hundredth of a pixel, or of a texel where that is larger;
// else the square is quartered.
class TexelPlaces {
public:
  static constexpr int Side = 64;
  enum class State : std::uint8_t {
    Absent,  // outside the grid's extent
    Regular, // its corners say where all of it is
    Torn     // at a pole or an edge of a projection: ask the finder
  };

  // Texels column..column + Side - 1, and as many rows. `turn`: of the raster [pixels], or 0.
  TexelPlaces(const ColorGrid& grid, int zoom, std::int64_t column, std::int64_t row,
              const PixelFinder& finder, double turn);

  State StateOf(int x, int y) const { return this->States_[std::size_t(y) * Side + x]; }
  TexelCorners CornersOf(int x, int y) const;
  // Exactly, of texel coordinates from the square's corner.
  Eigen::Vector2d Exact(double x, double y) const;

private:
  void Fill(int x, int y, int size);
  Eigen::Vector2d Near(const Eigen::Vector2d& p, const Eigen::Vector2d& to) const;
  Eigen::Vector2d& Corner(int x, int y) {
    return this->Corners_[std::size_t(y) * (Side + 1) + std::size_t(x)];
  }

  const PixelFinder& Finder_;
  Eigen::Affine2d TexelToMap_;
  Eigen::AlignedBox2d Extent_; // in texels from the square's corner
  double Turn_ = 0.0;
  std::vector<Eigen::Vector2d> Corners_;
  std::vector<State> States_;
};

} // namespace dspace

#endif
