#include <dspace/clipmap/ColorGridsOf.h>

#include <cmath>

#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/clipmap/PoleCharts.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace {
namespace {

constexpr double Degrees = 180.0 / M_PI;

// Of a plane, or of a raster in the plane of a pole.
ColorGrid RasterGrid(const StreamedTerrain& terrain) {
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
  grid.rootPosts = 2.0 * placement.Pole();
  grid.extent = Eigen::AlignedBox2d(grid.firstPost, grid.rootPosts);
  return grid;
}

} // namespace

std::vector<ColorGrid> ColorGridsOf(const StreamedTerrain& terrain,
                                    const std::vector<ClipmapChart>& poles) {
  std::vector<ColorGrid> grids;
  const bool degrees = terrain.Placement().GetKind() == PostPlacement::Kind::Sphere;
  grids.push_back(degrees ? BodyGrid(terrain) : RasterGrid(terrain));
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
