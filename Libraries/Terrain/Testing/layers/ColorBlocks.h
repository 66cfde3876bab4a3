// Colour grids by hand, and what a layer gives for their texels.
#ifndef DSPACE_TEST_COLORBLOCKS_H
#define DSPACE_TEST_COLORBLOCKS_H

#include <array>
#include <cstdint>
#include <vector>

#include <dspace/layers/ColorLayer.h>

namespace dspace::testing {

// Posts are the texels of zoom 0; `corner` is the map place of the first one's outer corner.
inline ColorGrid GridAt(const Crs& crs, const Eigen::Vector2d& corner, const Eigen::Vector2d& texel,
                        double size = ColorGrid::TileTexels) {
  ColorGrid grid;
  grid.crs = crs;
  grid.rootPosts.setConstant(ColorGrid::TileTexels);
  grid.postToMap.linear() = texel.asDiagonal();
  grid.postToMap.translation() = corner;
  grid.extent = Eigen::AlignedBox2d(Eigen::Vector2d::Zero(),
                                    Eigen::Vector2d(Eigen::Vector2d::Constant(size)));
  return grid;
}

// A whole body in degrees, from longitude -180 on.
inline ColorGrid GlobeGrid(const Crs& crs) {
  ColorGrid grid = GridAt(crs, {-180.0, 90.0}, {180.0 / 256.0, -180.0 / 256.0});
  grid.rootColumns = 2;
  grid.periodic = true;
  grid.extent = Eigen::AlignedBox2d(Eigen::Vector2d::Zero(), Eigen::Vector2d(512.0, 256.0));
  return grid;
}

struct Texels {
  ColorBlock block;
  bool any = false;
  std::vector<std::uint8_t> rgba;
  const std::uint8_t* At(int x, int y) const {
    return &this->rgba[4 * (std::size_t(y) * this->block.width + x)];
  }
};

inline Texels ReadTexels(const ColorLayer& layer, const ColorGrid& grid, const ColorBlock& block) {
  Texels texels{block, false,
                std::vector<std::uint8_t>(std::size_t(block.width) * block.height * 4)};
  texels.any = layer.Read(grid, block, texels.rgba.data());
  return texels;
}

// The map place of a texel's middle.
inline Eigen::Vector2d MiddleOf(const ColorGrid& grid, const ColorBlock& block, int x, int y) {
  return grid.TexelToMap(block.zoom) *
         Eigen::Vector2d(double(block.column + x) + 0.5, double(block.row + y) + 0.5);
}

} // namespace dspace::testing

#endif
