// Directions along a lattice of posts.
#ifndef DSPACE_TERRAIN_CHARTAXES_H
#define DSPACE_TERRAIN_CHARTAXES_H

#include <dspace/posts/PostPlacement.h>

namespace dspace {

// The axes of a chart at a post, unit, in the scene. `up` is the local vertical; `north` is Y on a
// plane, the true north on a degree grid, and against the rows of a pole's chart, which has no
// other direction that is the same across the pole.
struct ChartAxes {
  Eigen::Vector3d east;
  Eigen::Vector3d north;
  Eigen::Vector3d up;
};
ChartAxes ChartAxesAt(const PostPlacement& placement, const Eigen::Vector2d& post);

} // namespace dspace

#endif
