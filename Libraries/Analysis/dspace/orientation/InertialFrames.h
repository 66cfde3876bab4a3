// The 21 inertial frames that SPICE has built in.
#ifndef DSPACE_ORIENTATION_INERTIAL_FRAMES_H
#define DSPACE_ORIENTATION_INERTIAL_FRAMES_H

#include <Eigen/Core>

namespace dspace {

// Ids 1 to InertialFrameCount.
// Source: NAIF, "Frames Required Reading", appendix "Built-in inertial reference frames".
constexpr int InertialFrameCount = 21;
const char* InertialFrameName(int id);

// From the components in J2000 to those in the frame.
const Eigen::Matrix3d& InertialRotation(int id);

} // namespace dspace

#endif
