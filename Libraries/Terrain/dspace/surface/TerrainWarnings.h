// Warnings about doubtful places and heights of a terrain when it is loaded.
#ifndef DSPACE_TERRAIN_TERRAINWARNINGS_H
#define DSPACE_TERRAIN_TERRAINWARNINGS_H

#include <string>
#include <vector>

#include <dspace/posts/HeightGrid.h>
#include <dspace/raster/ElevationSource.h>

namespace dspace {

// The file's own, what its vertical datum leaves open, and on a plane the map's scale.
std::vector<std::string> WarningsOfPlace(const ElevationInfo& info, bool onPlane);

// Reliefs that are suspiciously flat or steep for metres; `scene` is what `grid` spans [m].
std::vector<std::string> WarningsOfRelief(const HeightGrid& grid, const Eigen::AlignedBox3d& scene);

} // namespace dspace

#endif
