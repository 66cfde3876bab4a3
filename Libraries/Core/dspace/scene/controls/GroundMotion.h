// The motions of a camera above ground, each a pure function.
#ifndef DSPACE_SCENE_GROUND_MOTION_H
#define DSPACE_SCENE_GROUND_MOTION_H

#include <dspace/Pose.h>
#include <dspace/scene/controls/Navigation.h>

namespace dspace {

// The rotation R_FC that is level (the camera's X axis is perpendicular to `up_F`, its Y axis does
// not point up) and turns the direction `ray_C` into that of `aim_F` (any lengths but 0). Of two,
// the one whose elevation is nearer to that of `before`. None: no level camera does that, or the
// direction is vertical.
std::optional<Eigen::Quaterniond> LevelAim(const Eigen::Quaterniond& before,
                                           const Eigen::Vector3d& ray_C,
                                           const Eigen::Vector3d& aim_F,
                                           const Eigen::Vector3d& up_F);

// R_FC with the same line of sight, level. A vertical line of sight keeps the heading of the
// camera's X axis.
Eigen::Quaterniond LevelSight(const Eigen::Quaterniond& before, const Eigen::Vector3d& up_F);

// The point `clearance` [m] above the ground on the vertical of `p_F` if it is lower; else p_F.
Eigen::Vector3d AboveGround(const NavigationGround& ground, const Eigen::Vector3d& p_F,
                            double clearance);

// A step of a person: `forward` and `right` [m] along the level, from the eye of X_FC to
// `eyeHeight` above the ground there. Heading and elevation remain. Where the ground ends, the
// person stays. Without ground (`ground` null, or none here) the step is perpendicular to `up_F`.
Pose WalkStep(const Pose& X_FC, const NavigationGround* ground, const Eigen::Vector3d& up_F,
              double forward, double right, double eyeHeight);

} // namespace dspace

#endif
