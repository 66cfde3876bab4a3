#include <dspace/crs/BodyEllipsoid.h>

#include <cmath>
#include <string>

#include <GeographicLib/Geocentric.hpp>

#include <dspace/Error.h>

namespace dspace {

BodyEllipsoid::BodyEllipsoid(double equatorial, double polar)
    : Equatorial_(equatorial), Polar_(polar),
      Squash_((equatorial - polar) * (equatorial + polar) / (equatorial * equatorial)) {
  if (!(equatorial > 0.0 && equatorial <= 1e12 && polar <= equatorial &&
        polar >= 0.5 * equatorial)) {
    throw Error(Error::Kind::InvalidArgument, "ellipsoid",
                "radii of " + std::to_string(equatorial) + " m at the equator and " +
                    std::to_string(polar) +
                    " m at the poles are rejected; accepted is up to 1e12 m at the equator, and "
                    "from half of it to it at the poles");
  }
}

double BodyEllipsoid::EastRadius(double sine) const {
  return this->Equatorial_ / std::sqrt(1.0 - this->Squash_ * sine * sine);
}

double BodyEllipsoid::NorthRadius(double sine) const {
  const double w = 1.0 - this->Squash_ * sine * sine;
  return this->Equatorial_ * (1.0 - this->Squash_) / (w * std::sqrt(w));
}

Eigen::Vector3d BodyEllipsoid::Point(const Eigen::Vector3d& up, double height) const {
  const double east = this->EastRadius(up.z());
  return {(east + height) * up.x(), (east + height) * up.y(),
          ((1.0 - this->Squash_) * east + height) * up.z()};
}

BodyEllipsoid::Foot BodyEllipsoid::FootOf(const Eigen::Vector3d& p) const {
  const double distance = p.norm();
  if (distance == 0.0) {
    return {Eigen::Vector3d::UnitZ(), -this->Polar_};
  }
  if (this->Spherical()) {
    return {p / distance, distance - this->Equatorial_};
  }
  const GeographicLib::Geocentric body(this->Equatorial_,
                                       (this->Equatorial_ - this->Polar_) / this->Equatorial_);
  Foot foot;
  double latitude = 0.0;
  double longitude = 0.0;
  body.Reverse(p.x(), p.y(), p.z(), latitude, longitude, foot.height);
  const double phi = latitude * M_PI / 180.0;
  const double parallel = p.head<2>().norm();
  const Eigen::Vector2d east =
      parallel > 0.0 ? Eigen::Vector2d(p.head<2>() / parallel) : Eigen::Vector2d::UnitX();
  foot.up << std::cos(phi) * east, std::sin(phi);
  return foot;
}

} // namespace dspace
