// The grids of colour tiles of a terrain that is drawn as a clipmap.
#ifndef DSPACE_CLIPMAP_COLORGRIDSOF_H
#define DSPACE_CLIPMAP_COLORGRIDSOF_H

#include <vector>

#include <dspace/layers/ColorGrid.h>

namespace dspace {

class StreamedTerrain;
struct ClipmapChart;

// One grid for the terrain's own posts, then one for each polar chart (PoleChartsOf), in this
// order.
std::vector<ColorGrid> ColorGridsOf(const StreamedTerrain& terrain,
                                    const std::vector<ClipmapChart>& poles);

} // namespace dspace

#endif
