#include <dspace/crs/BodyCoordinates.h>

#include <cmath>

namespace dspace {
namespace {

constexpr double RadiansADegree = M_PI / 180.0;

Eigen::Vector3d Normal(double longitude_deg, double latitude_deg) {
  const double longitude = longitude_deg * RadiansADegree;
  const double latitude = latitude_deg * RadiansADegree;
  return {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
          std::sin(latitude)};
}

// Where the line along the normal at a point of the ellipsoid is at `distance` from the centre.
double HeightAtDistance(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                        double distance) {
  const double along = point.dot(normal);
  const double aside = point.squaredNorm() - along * along;
  return std::sqrt(distance * distance - aside) - along;
}

} // namespace

Eigen::Vector3d GeodeticToBodyFixed(const BodyAxes& axes, double longitude_deg, double latitude_deg,
                                    double height) {
  const double a = axes.semiMajor;
  const double ratio = axes.semiMinor / a; // 1 - e^2 is its square
  const Eigen::Vector3d n = Normal(longitude_deg, latitude_deg);
  const double N = a / std::hypot(n.head<2>().norm(), ratio * n.z());
  return {(N + height) * n.x(), (N + height) * n.y(), (ratio * ratio * N + height) * n.z()};
}

BodyCoordinates BodyCoordinatesOf(const BodyAxes& axes, const VerticalDatum& datum,
                                  double longitude_deg, double latitude_deg, double height) {
  BodyCoordinates place;
  place.longitude_deg = longitude_deg;
  place.latitude_deg = latitude_deg;
  place.height = height;
  const bool sphere =
      datum.kind == VerticalDatum::Kind::Sphere || datum.kind == VerticalDatum::Kind::Radius;
  if (sphere && datum.radius > 0.0 &&
      !(datum.radius == axes.semiMajor && datum.radius == axes.semiMinor)) {
    place.height = HeightAtDistance(GeodeticToBodyFixed(axes, longitude_deg, latitude_deg, 0.0),
                                    Normal(longitude_deg, latitude_deg), datum.radius + height);
  }
  place.bodyFixed = GeodeticToBodyFixed(axes, longitude_deg, latitude_deg, place.height);
  return place;
}

} // namespace dspace
