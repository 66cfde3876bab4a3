#include <dspace/terrain/PoleCharts.h>

#include <algorithm>

#include <dspace/terrain/ClipmapLevels.h>
#include <dspace/terrain/PolarPosts.h>

namespace dspace {

std::vector<ClipmapChart> PoleChartsOf(const StreamedTerrain& terrain, int cells,
                                       const ElevationPyramidOptions& options) {
  constexpr std::int64_t MostColumns = 65536;
  const std::shared_ptr<ElevationPyramid>& pyramid = terrain.Pyramid();
  const PostLattice& lattice = pyramid->Lattice();
  if (!terrain.ReachesPoles() || !lattice.periodic) {
    return {};
  }
  // The raster's own posts are those of the level below the one of its pixels: rows count from the
  // poles, half a pixel beside.
  int complete = terrain.Group() ? 0 : std::max(terrain.Subdivisions() - 1, 0);
  while (complete < lattice.levels - 1 && lattice.ColumnsAt(complete) > MostColumns) {
    ++complete;
  }
  ElevationPyramidOptions quarter = options;
  quarter.byteBudget = std::max(options.byteBudget / 4, std::size_t(4) << 20);
  const std::shared_ptr<const PostSource> base(pyramid, &pyramid->Source());
  std::vector<ClipmapChart> charts;
  for (const bool south : {false, true}) {
    const auto posts = std::make_shared<const PolarPosts>(base, terrain.Placement(), complete,
                                                          south, CoarsestFor(cells));
    charts.push_back({std::make_shared<ElevationPyramid>(posts, quarter), posts->Placement()});
  }
  return charts;
}

} // namespace dspace
