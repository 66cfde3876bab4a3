#include <dspace/clipmap/PoleCharts.h>

#include <algorithm>
#include <sstream>

#include <dspace/clipmap/ClipmapLevels.h>
#include <dspace/posts/PolarPosts.h>
#include <dspace/tracks/TrackPosts.h>

namespace dspace {

Crs PolarCrs(const StreamedTerrain& terrain, bool south) {
  std::ostringstream text;
  text.precision(17);
  text << "+proj=stere +lat_0=" << (south ? -90 : 90)
       << " +lon_0=-90 +R=" << terrain.Info().crs.GetAxes().semiMajor << " +no_defs";
  return Crs::FromText(text.str());
}

Eigen::Affine2d PostToPolarMap(const StreamedTerrain& terrain, const PostPlacement& chart) {
  const double step = 2.0 * terrain.Info().crs.GetAxes().semiMajor * chart.PlaneStep();
  Eigen::Affine2d map = Eigen::Affine2d::Identity();
  map.linear() << step, 0.0, 0.0, -step;
  map.translation() = -(map.linear() * chart.Pole());
  return map;
}

std::vector<ClipmapChart> PoleChartsOf(const StreamedTerrain& terrain, int cells,
                                       const ElevationPyramidOptions& options) {
  constexpr std::int64_t MaximumColumns = 65536;
  const std::shared_ptr<ElevationPyramid>& pyramid = terrain.Pyramid();
  const PostLattice& lattice = pyramid->Lattice();
  if (!terrain.ReachesPoles() || !lattice.periodic) {
    return {};
  }
  int complete = terrain.FullLevel();
  while (complete < lattice.levels - 1 && lattice.ColumnsAt(complete) > MaximumColumns) {
    ++complete;
  }
  ElevationPyramidOptions quarter = options;
  quarter.byteBudget = std::max(options.byteBudget / 4, std::size_t(4) << 20);
  // Patches are laid on the chart itself: around a pole their posts would be too many columns.
  const std::shared_ptr<const PostSource>& bare = terrain.BarePosts();
  const auto* group = dynamic_cast<const GroupPosts*>(bare.get());
  const std::shared_ptr<const PostSource> base = group ? group->Base() : bare;
  std::vector<ClipmapChart> charts;
  for (const bool south : {false, true}) {
    const auto posts = std::make_shared<const PolarPosts>(base, terrain.Placement(), complete,
                                                          south, CoarsestFor(cells));
    std::shared_ptr<const PostSource> source = posts;
    if (group) {
      const auto data =
          group->Data() ? std::make_shared<const PolarPosts>(group->Data(), terrain.Placement(),
                                                             complete, south, CoarsestFor(cells))
                        : nullptr;
      source = group->WithBase(posts, PolarCrs(terrain, south),
                               PostToPolarMap(terrain, posts->Placement()), data);
    }
    const std::shared_ptr<const TrackPosts> tracked =
        terrain.TrackedPosts(source, posts->Placement());
    const auto over = std::make_shared<ElevationPyramid>(tracked, quarter);
    terrain.Follow(tracked, over);
    charts.push_back({over, posts->Placement()});
  }
  return charts;
}

} // namespace dspace
