// What names and poses a frame accepts: used wherever one comes from outside.
#ifndef DSPACE_FRAME_RULES_H
#define DSPACE_FRAME_RULES_H

#include <cstddef>
#include <string>

#include <dspace/Pose.h>

namespace dspace {

// How far a quaternion's norm may be from 1.
constexpr double UnitQuaternionTolerance = 1e-6;

// Positions are within 1e18 m (106 light-years) on each axis, so that squares of what reaches the
// GPU stay inside a float; scales are 1e-12 to 1e12.
constexpr double MaximumCoordinate = 1e18;
constexpr double MinimumScale = 1e-12;
constexpr double MaximumScale = 1e12;

// Names are at most so many bytes of UTF-8, as those of files are.
constexpr std::size_t MaximumFrameName = 255;

// 1 to MaximumFrameName bytes of UTF-8, neither "." nor "..", no '/' and no control character (a
// byte below 32, or 127).
bool IsValidFrameName(const std::string& name);

// Throws Error(InvalidArgument) naming `object` and the name.
[[noreturn]] void RejectFrameName(const std::string& object, const std::string& name);

// Within MaximumCoordinate on each axis; false for NaN.
bool IsValidPosition(const Eigen::Vector3d& p);

// Position valid, scale in [MinimumScale, MaximumScale], quaternion unit within
// UnitQuaternionTolerance.
bool IsValidPose(const Pose& X);

// Throws Error(InvalidArgument) naming `object` and the value that makes X invalid.
[[noreturn]] void RejectPose(const std::string& object, const Pose& X);

// A valid pose with its quaternion normalised. One that is already unit to the rounding of a
// normalisation is left as it is, so that doing it twice is doing it once.
Pose NormalisedPose(const Pose& X);

// The pose in px py pz qw qx qy qz scale.
Pose PoseFromRow(const double* row);

} // namespace dspace

#endif
