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

// A lowest or highest value that looks like a mark of pixels without data that the file does not
// state: a usual one (-32768, -9999, ...) away from all others by a quarter of their range, or one
// of at least three pixels, and one in 2,000, by twice their range. `heights` are those of the
// source or a sample, NaN where there are none.
std::vector<std::string> WarningsOfFill(const std::vector<double>& heights,
                                        const ElevationInfo& info);

// Reliefs that are suspiciously flat or steep for metres; `scene` is what `grid` spans [m].
std::vector<std::string> WarningsOfRelief(const HeightGrid& grid, const Eigen::AlignedBox3d& scene);

} // namespace dspace

#endif
