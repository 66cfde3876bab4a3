#include <dspace/eclipse/BodyShadow.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr double Degrees = 180.0 / M_PI;

struct Axis {
  Eigen::Vector3d direction; // away from the Sun
  double apart = 0.0;        // of Sun and body [m]
  double umbraSine = 0.0;    // of the cones' half angles
  double penumbraSine = 0.0;
};

Axis AxisOf(const ShadowCaster& caster) {
  const char* about = "shadow of a body";
  Require(caster.bodyRadius > 0.0, about, "the body's radius", caster.bodyRadius, "above 0 metres");
  Require(caster.sunRadius > caster.bodyRadius, about, "the Sun's radius", caster.sunRadius,
          "above the body's");
  Axis axis;
  const Eigen::Vector3d way = caster.body - caster.sun;
  axis.apart = way.norm();
  Require(axis.apart > caster.sunRadius + caster.bodyRadius, about, "the distance of Sun and body",
          axis.apart, "more than the sum of their radii");
  axis.direction = way / axis.apart;
  axis.umbraSine = (caster.sunRadius - caster.bodyRadius) / axis.apart;
  axis.penumbraSine = (caster.sunRadius + caster.bodyRadius) / axis.apart;
  return axis;
}

// Radii of the cones across the axis, at the distance `z` behind the body's centre.
double UmbraAt(const ShadowCaster& caster, const Axis& axis, double z) {
  const double cosine = std::sqrt(1.0 - axis.umbraSine * axis.umbraSine);
  return (caster.bodyRadius - z * axis.umbraSine) / cosine;
}

double PenumbraAt(const ShadowCaster& caster, const Axis& axis, double z) {
  const double cosine = std::sqrt(1.0 - axis.penumbraSine * axis.penumbraSine);
  return (caster.bodyRadius + z * axis.penumbraSine) / cosine;
}

Eigen::Vector3d NormalAt(const Eigen::Vector3d& place, const Eigen::Vector3d& radii) {
  return place.cwiseQuotient(radii.cwiseProduct(radii)).normalized();
}

} // namespace

std::optional<ShadowPlace> FindShadow(const ShadowCaster& caster, const Eigen::Vector3d& radii) {
  for (int i = 0; i < 3; ++i) {
    Require(radii[i] > 0.0 && std::isfinite(radii[i]), "shadow of a body",
            "a radius of the shadowed body", radii[i], "above 0 metres");
  }
  const Axis axis = AxisOf(caster);
  // In axes in which the ellipsoid is a unit sphere; from the point of the axis that is closest to
  // the centre there, so that no large numbers are subtracted.
  const Eigen::Vector3d d = axis.direction.cwiseQuotient(radii);
  const Eigen::Vector3d o = caster.body.cwiseQuotient(radii);
  const double closest = -o.dot(d) / d.squaredNorm();
  const Eigen::Vector3d foot = o + closest * d;
  const double square = 1.0 - foot.squaredNorm();
  if (square < 0.0 || closest < 0.0) {
    return std::nullopt;
  }
  const double back = std::sqrt(square / d.squaredNorm());
  const double z = closest - back;
  ShadowPlace found;
  found.place = (foot - back * d).cwiseProduct(radii);
  const Eigen::Vector3d up = NormalAt(found.place, radii);
  found.latitude_deg = std::atan2(up.z(), up.head<2>().norm()) * Degrees;
  found.longitude_deg = std::atan2(up.y(), up.x()) * Degrees;
  found.sunAltitude_deg = std::asin(std::clamp(-axis.direction.dot(up), -1.0, 1.0)) * Degrees;
  found.umbra = UmbraAt(caster, axis, z);
  found.penumbra = PenumbraAt(caster, axis, z);
  return found;
}

ShadowPlane ShadowAtCenter(const ShadowCaster& caster) {
  const Axis axis = AxisOf(caster);
  const double z = -caster.body.dot(axis.direction);
  return {(caster.body + z * axis.direction).norm(), UmbraAt(caster, axis, z),
          PenumbraAt(caster, axis, z)};
}

double UmbraWidth(const ShadowCaster& caster, const ShadowPlace& now, const ShadowPlace& later,
                  const Eigen::Vector3d& radii) {
  const Axis axis = AxisOf(caster);
  const Eigen::Vector3d up = NormalAt(now.place, radii);
  const Eigen::Vector3d along = (later.place - now.place).normalized();
  const Eigen::Vector3d across = up.cross(along).normalized();
  // The ellipse: the radius across the axis, and longer along the Sun's azimuth.
  const Eigen::Vector3d side = up.cross(axis.direction).normalized();
  const Eigen::Vector3d azimuth = side.cross(up);
  const double sine = std::sin(now.sunAltitude_deg / Degrees);
  return 2.0 * std::abs(now.umbra) * std::hypot(across.dot(side), across.dot(azimuth) / sine);
}

} // namespace dspace
