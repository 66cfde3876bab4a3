// The shadow of a spherical body on an oblate one.
#ifndef DSPACE_ECLIPSE_BODY_SHADOW_H
#define DSPACE_ECLIPSE_BODY_SHADOW_H

#include <optional>

#include <Eigen/Core>

namespace dspace {

// Sun and shadowing body as spheres, in the axes of the shadowed body (its frame, about its centre)
// [m]. For where the shadow is at a time, positions are those that light connects: of the Sun and
// the body with their light times from the shadowed one (Correction::LightTime).
struct ShadowCaster {
  Eigen::Vector3d sun = Eigen::Vector3d::Zero();
  double sunRadius = 0.0;
  Eigen::Vector3d body = Eigen::Vector3d::Zero();
  double bodyRadius = 0.0;
};

// The axis of the shadow where it meets the shadowed body's ellipsoid.
struct ShadowPlace {
  Eigen::Vector3d place = Eigen::Vector3d::Zero(); // [m], in the body's axes
  double latitude_deg = 0.0;                       // geodetic
  double longitude_deg = 0.0;                      // east, -180 to 180
  double sunAltitude_deg =
      0.0; // of the axis above the plane that is normal to the geodetic vertical
  // Radii of the cones across the axis there [m]. The umbra's is negative beyond its tip: the
  // eclipse is annular.
  double umbra = 0.0;
  double penumbra = 0.0;
};

// Where the axis meets the ellipsoid of these radii (a, b, c along the axes), on the side of the
// Sun. None: it misses. Throws Error(InvalidArgument) for radii that are not above 0, a Sun that is
// not larger than the body, or bodies that touch.
std::optional<ShadowPlace> FindShadow(const ShadowCaster& caster, const Eigen::Vector3d& radii);

// The distance of the axis from the centre [m], and the radii of the umbra and penumbra in the
// plane through the centre that is normal to it: gamma, l2 and l1 of Bessel, but in metres, l2
// positive for an umbra.
struct ShadowPlane {
  double distance = 0.0;
  double umbra = 0.0;
  double penumbra = 0.0;
};
ShadowPlane ShadowAtCenter(const ShadowCaster& caster);

// Width of the path of the umbra on the ground [m], across its motion: of the ellipse that the cone
// cuts out of the tangent plane at `now`, which moves to `later`, soon after.
double UmbraWidth(const ShadowCaster& caster, const ShadowPlace& now, const ShadowPlace& later,
                  const Eigen::Vector3d& radii);

} // namespace dspace

#endif
