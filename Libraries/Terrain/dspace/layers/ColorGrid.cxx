#include <dspace/layers/ColorGrid.h>

#include <algorithm>
#include <cmath>

#include <dspace/terrain/ClipmapTerrain.h>
#include <dspace/terrain/PoleCharts.h>
#include <dspace/terrain/StreamedTerrain.h>

namespace dspace {
namespace {

constexpr double Degrees = 180.0 / M_PI;

ColorGrid PlaneGrid(const StreamedTerrain& terrain) {
  const ElevationInfo& info = terrain.Info();
  const Eigen::Affine2d& post = terrain.PixelToPost();
  const Eigen::Vector2d size(info.window.width, info.window.height);
  ColorGrid grid;
  grid.firstPost = post * Eigen::Vector2d::Zero();
  // A zoom has just the raster's own pixels: images of its shape are not resampled.
  double root = ColorGrid::TileTexels;
  while (root < size.maxCoeff()) {
    root *= 2.0;
  }
  grid.rootPosts = post.linear().diagonal() * root;
  grid.extent = Eigen::AlignedBox2d(grid.firstPost, Eigen::Vector2d(post * size));
  return grid;
}

// All of the body: its tiles are the same whatever the raster is.
ColorGrid BodyGrid(const StreamedTerrain& terrain) {
  const PostPlacement& placement = terrain.Placement();
  const Eigen::Vector2d step = placement.Step() * Degrees;
  const Eigen::Vector2d first = placement.First() * Degrees;
  const ElevationInfo& info = terrain.Info();
  const Eigen::Affine2d& post = terrain.PixelToPost();
  ColorGrid grid;
  grid.extent = Eigen::AlignedBox2d(
      Eigen::Vector2d(post * Eigen::Vector2d::Zero()),
      Eigen::Vector2d(post * Eigen::Vector2d(info.window.width, info.window.height)));
  grid.periodic = terrain.Pyramid()->Lattice().periodic;
  grid.rootColumns = 2;
  grid.rootPosts = step.cwiseAbs().cwiseInverse() * 180.0;
  // Longitude -180 (or 180 where columns run west), or where a part of the body begins.
  grid.firstPost.x() = grid.periodic ? (std::copysign(180.0, -step.x()) - first.x()) / step.x()
                                     : grid.extent.min().x();
  grid.firstPost.y() = (std::copysign(90.0, -step.y()) - first.y()) / step.y();
  if (grid.periodic) { // once around, and over the poles
    grid.extent = Eigen::AlignedBox2d(
        grid.firstPost,
        Eigen::Vector2d(grid.firstPost + grid.rootPosts.cwiseProduct(Eigen::Vector2d(2.0, 1.0))));
  }
  return grid;
}

ColorGrid PoleGrid(const StreamedTerrain& terrain, const PostPlacement& placement) {
  ColorGrid grid;
  grid.crs = PolarCrs(terrain, placement.South());
  grid.postToMap = PostToPolarMap(terrain, placement);
  grid.rootPosts.setConstant(2.0 * placement.Half());
  grid.extent = Eigen::AlignedBox2d(grid.firstPost, grid.rootPosts);
  return grid;
}

} // namespace

Eigen::Affine2d ColorGrid::TexelToPost(int zoom) const {
  Eigen::Affine2d map = Eigen::Affine2d::Identity();
  map.linear() = (this->rootPosts * std::ldexp(1.0 / TileTexels, -zoom)).asDiagonal();
  map.translation() = this->firstPost;
  return map;
}

double ColorGrid::RootTexelSize() const {
  const Eigen::Vector2d middle = this->extent.center();
  const Eigen::Vector2d texel = this->rootPosts / TileTexels;
  double most = 0.0;
  for (int axis = 0; axis < 2; ++axis) { // from a small step: zoom 0 may be large on its body
    constexpr double Part = 1e-3;
    const Eigen::Vector2d half = 0.5 * Part * texel[axis] * Eigen::Vector2d::Unit(axis);
    const Eigen::Vector3d across =
        this->placement.ToScene(middle + half, 0.0) - this->placement.ToScene(middle - half, 0.0);
    most = std::max(most, across.norm() / Part);
  }
  return most;
}

int ColorGrid::ZoomFor(double pixel) const {
  const double zoom = std::ceil(std::log2(this->RootTexelSize() / pixel) - 1e-6);
  return static_cast<int>(std::clamp(zoom, 0.0, double(MostZoom)));
}

std::vector<ColorGrid> ColorGridsOf(const StreamedTerrain& terrain,
                                    const std::vector<ClipmapChart>& poles) {
  std::vector<ColorGrid> grids;
  grids.push_back(terrain.Placement().OnBody() ? BodyGrid(terrain) : PlaneGrid(terrain));
  grids[0].placement = terrain.Placement();
  grids[0].crs = terrain.Info().crs;
  grids[0].postToMap = terrain.Info().pixelToMap * terrain.PixelToPost().inverse();
  for (const ClipmapChart& pole : poles) {
    grids.push_back(PoleGrid(terrain, pole.placement));
    grids.back().placement = pole.placement;
  }
  return grids;
}

} // namespace dspace
