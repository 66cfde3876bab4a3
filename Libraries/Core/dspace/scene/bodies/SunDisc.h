// How much of the Sun's disc a body leaves to be seen from a place: eclipses.
#ifndef DSPACE_SCENE_SUN_DISC_H
#define DSPACE_SCENE_SUN_DISC_H

#include <Eigen/Core>

namespace dspace {

// A body in the way, as seen from a place.
struct SunBlocker {
  Eigen::Vector3d center; // from the place [m]
  // From the axes of `center` to axes in which the body is a unit sphere [1/m].
  Eigen::Matrix3d unit;
};

// The lit fraction, 0 to 1, by the reference in double precision that the shader follows
// (Shaders/Eclipse.glsl). `sun`: the Sun's centre from the place [m], `radius` its radius [m]. The
// disc is of even radiance (no limb darkening). In the axes in which the body is a sphere the
// body's limb is a circle; the Sun, a small ellipse there, counts as the circle that touches the
// same tangent across the line of centres: where it is half hidden by the Earth (flattening 1/298)
// that is off by 1e-5 of the disc. Places closer than 1 % of the radius to the body's surface are
// not hidden by it: there its own horizon counts.
double SunLeft(const SunBlocker& blocker, const Eigen::Vector3d& sun, double radius);

} // namespace dspace

#endif
