// Selects the tiles of a terrain's colour layers that a view needs. No OpenGL.
#ifndef DSPACE_LAYERS_VISIBLETILES_H
#define DSPACE_LAYERS_VISIBLETILES_H

#include <array>
#include <functional>
#include <vector>

#include <dspace/clipmap/ClipmapBlocks.h>
#include <dspace/layers/ColorGrid.h>

namespace dspace {

struct LayerView {
  ClipmapViewVolume sight;
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX(); // of the camera, unit, in the terrain's frame
  bool parallel = false;
  double pixel = 1e-3;    // [m] a pixel's side; of a perspective view at 1 m of depth
  double cosCorner = 0.5; // cosine of the angle between `forward` and the picture's corners
  std::array<double, 2> heights = {0, 0}; // [m] that the ground stays within
  // Of the ground at a place in posts [m]; where it is not known yet, any.
  std::function<double(const Eigen::Vector2d& post)> height;
};

// Tiles that the view may see, down to zoom `finest` or until their texels are as small as pixels;
// with each tile those that it is a part of. Coarse ones first, of a zoom the nearest. At most
// `most`: then those are left out whose texels are smallest on the screen.
std::vector<ColorTile> VisibleTiles(const ColorGrid& grid, int chart, const LayerView& view,
                                    int finest, std::size_t most);

} // namespace dspace

#endif
