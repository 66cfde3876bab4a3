// The motions of a camera that is moved by hand, each a pure function.
#ifndef DSPACE_SCENE_ORBIT_MOTION_H
#define DSPACE_SCENE_ORBIT_MOTION_H

#include <dspace/scene/Camera.h>

namespace dspace {

// Sine of the angle between sight and `up` below which the camera's X says the heading.
inline constexpr double NearlyUpright = 1e-6;

// X_FC turned about `pivot_F`: by `turn_deg` about `up_F` (unit; counter-clockwise seen from above)
// and by `rise_deg` of the line of sight's elevation, which stops at straight up and down. The
// result is level, keeps the distance to the pivot, and, from a level pose, the pivot's pixel.
Pose OrbitAbout(const Pose& X_FC, const Eigen::Vector3d& pivot_F, const Eigen::Vector3d& up_F,
                double turn_deg, double rise_deg);

// X_FC moved parallel to the image so that `point_F` comes to pixel (x, y).
Pose PanTo(const Pose& X_FC, const Projection& projection, const Eigen::Vector3d& point_F, double x,
           double y, int width, int height);

// Distance to `pivot_F` times `factor` (> 0), keeping the pivot's pixel. Perspective kinds move
// along the line to the pivot, which stays at twice the near distance or farther (if it was) and
// within 1e15 m; an orthographic camera scales its height (1e-9 to 1e15 m) and moves sideways.
void DollyTo(Pose& X_FC, Projection& projection, const Eigen::Vector3d& pivot_F, double factor);

} // namespace dspace

#endif
