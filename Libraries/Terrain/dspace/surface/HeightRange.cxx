#include <dspace/surface/HeightRange.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>
#include <dspace/posts/HeightGrid.h>
#include <dspace/raster/OpeningLimit.h>

#include <dspace/surface/TerrainWarnings.h>

namespace dspace {
namespace {

constexpr std::int64_t ReadWhole = 4000000; // pixels whose heights are all looked at
constexpr int Sampled = 512;                // else so many along the raster's longer side

} // namespace

HeightRange FindHeightRange(const std::string& name, const ElevationSource& source,
                            const PostPlacement& placement, const Eigen::Affine2d& pixelToPost,
                            ElevationPyramid& pyramid) {
  const OpeningLimit limit;
  const RasterWindow window = source.Info().window;
  HeightRange range;
  range.exact = std::int64_t(window.width) * window.height <= ReadWhole;
  // As a grid on a plane, which on a body is the one of longitudes and latitudes, or the pole's.
  Eigen::Affine2d postToScene = placement.PostToScene();
  if (placement.GetKind() == PostPlacement::Kind::Sphere) {
    postToScene.linear() = (placement.Radius() * placement.Step()).asDiagonal();
  } else if (placement.GetKind() == PostPlacement::Kind::Pole) {
    const double post = placement.CellSize(placement.Pole());
    postToScene.linear() = Eigen::Vector2d(post, -post).asDiagonal();
  }
  // Pixels, not means: the mean of ups and downs is neither.
  int factor = 1;
  while (!range.exact && std::max(window.width, window.height) / factor > Sampled) {
    factor *= 2;
  }
  std::vector<double> heights = source.ReadReduced({0, 0, window.width, window.height}, factor);
  const int columns = 1 + (window.width - 1) / factor;
  const int rows = 1 + (window.height - 1) / factor;
  if (!range.exact) {
    // The first picture's first level; it need not be waited for here.
    const PostLattice& lattice = pyramid.Lattice();
    const int top = lattice.levels - 1;
    const PostBlock coarsest{top, 0, 0, int(lattice.ColumnsAt(top)), int(lattice.RowsAt(top))};
    std::vector<float> posts(std::size_t(coarsest.width) * coarsest.height);
    pyramid.TryRead(coarsest, posts.data());
    if (std::all_of(heights.begin(), heights.end(), [](double h) { return std::isnan(h); })) {
      range.warnings.push_back(
          "of its " + std::to_string(window.width) + " x " + std::to_string(window.height) +
          " pixels, the " + std::to_string(columns) + " x " + std::to_string(rows) +
          " that were sampled have no data: it may contain no heights at all, or its "
          "no-data value may be wrong");
      return range; // there may be heights between
    }
  }
  postToScene.linear() = postToScene.linear() * pixelToPost.linear() * double(factor);
  range.warnings = WarningsOfFill(heights, source.Info());
  const HeightGrid grid(name, columns, rows, std::move(heights), postToScene);
  range.heights = {grid.GetMinimum(), grid.GetMaximum()};
  Eigen::AlignedBox3d box;
  for (const double c : {0.0, columns - 1.0}) {
    for (const double r : {0.0, rows - 1.0}) {
      const Eigen::Vector2d p = grid.ToScene({c, r});
      for (const double h : range.heights) {
        box.extend(Eigen::Vector3d(p.x(), p.y(), h));
      }
    }
  }
  for (std::string& warning : WarningsOfRelief(grid, box)) {
    range.warnings.push_back(std::move(warning));
  }
  if (!range.exact) {
    const double half = 0.5 * (range.heights[1] - range.heights[0]);
    range.heights = {range.heights[0] - half, range.heights[1] + half};
  }
  if (placement.OnBody() && !(range.heights[0] > -placement.Radius()) && range.exact) {
    throw Error(Error::Kind::InvalidArgument, name,
                "a height of " + std::to_string(range.heights[0]) +
                    " m lies below the body's centre");
  }
  return range;
}

} // namespace dspace
