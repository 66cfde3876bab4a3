// Valid names and poses of frames, for all input from outside.
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

// Longest name [bytes of UTF-8], as for files.
constexpr std::size_t MaximumFrameName = 255;

// 1 to MaximumFrameName bytes of UTF-8, neither "." nor "..", no '/' and no control character (a
// byte below 32, or 127).
bool IsValidFrameName(const std::string& name);

// The valid name that is nearest to one from a file: what a name cannot hold becomes '_', and what
// is too long is cut.
std::string MappedFrameName(const std::string& name);

// Throws Error(InvalidArgument) naming `object` and the name.
[[noreturn]] void RejectFrameName(const std::string& object, const std::string& name);

// Within MaximumCoordinate on each axis; false for NaN.
bool IsValidPosition(const Eigen::Vector3d& p);

// Position valid, scale in [MinimumScale, MaximumScale], quaternion unit within
// UnitQuaternionTolerance.
bool IsValidPose(const Pose& X);

// Throws Error(InvalidArgument) naming `object` and the value that makes X invalid.
[[noreturn]] void RejectPose(const std::string& object, const Pose& X);

// Returns a valid pose with a normalised quaternion. A quaternion that is unit to rounding is
// unchanged, so that the function is idempotent.
Pose NormalisedPose(const Pose& X);

// The pose in px py pz qw qx qy qz scale.
Pose PoseFromRow(const double* row);

} // namespace dspace

#endif
