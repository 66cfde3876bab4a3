// Where a camera must stand to show things whole.
#ifndef DSPACE_SCENE_CAMERA_FIT_H
#define DSPACE_SCENE_CAMERA_FIT_H

#include <vector>

#include <dspace/scene/Camera.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace {

// `camera`, which now is at `pose`, moved without a turn so that its picture shows all spheres
// whole (in the frame of `pose` [m]; a radius of 0 is a point), as large as the free space of
// `margin` times their size on each side allows. Its mount is fixed in that frame. An orthographic
// camera gets another height; it moves along its line of sight only where a near or far distance
// that is set, or the camera's own plane, would cut the spheres. Off-axis and perspective cameras
// keep their tangents, and stand so far away that the nearest point is beyond near.
// `aspect`: width / height of the picture. Throws Error(InvalidArgument) naming the camera: no
// sphere, spheres that are all the same point, a margin not of 0 to 10, an aspect not of 1e-6 to
// 1e6, numbers that are not finite.
Camera FitCamera(const Camera& camera, const CameraPose& pose,
                 const std::vector<BoundingSphere>& spheres_F, double margin, double aspect);

} // namespace dspace

#endif
