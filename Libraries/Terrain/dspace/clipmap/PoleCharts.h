// The charts with which a whole body is drawn about its poles.
#ifndef DSPACE_TERRAIN_POLECHARTS_H
#define DSPACE_TERRAIN_POLECHARTS_H

#include <vector>

#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace {

// North and south, for a terrain on a body that reaches both; else none. Each has a pyramid of its
// own with a quarter of `options`' budget. About a pole all columns of some rows are read at once:
// at most 65536 of them, hence of a finer degree grid a coarser level. A group's
// patches lie on the charts themselves.
std::vector<ClipmapChart> PoleChartsOf(const StreamedTerrain& terrain, int cells,
                                       const ElevationPyramidOptions& options = {});

// The plane of a pole's chart as a CRS, in metres, and posts of the chart to it.
Crs PolarCrs(const StreamedTerrain& terrain, bool south);
Eigen::Affine2d PostToPolarMap(const StreamedTerrain& terrain, const PostPlacement& chart);

} // namespace dspace

#endif
