// How much a transform lengthens what it moves.
#ifndef DSPACE_SCENE_STRETCH_H
#define DSPACE_SCENE_STRETCH_H

#include <Eigen/Geometry>

namespace dspace {

// The largest factor by which the transform stretches a length: its largest singular value.
double LargestStretch(const Eigen::Affine3d& transform);

} // namespace dspace

#endif
