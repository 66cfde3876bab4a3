#include <dspace/orientation/Site.h>

#include <cmath>

#include <dspace/Checks.h>
#include <dspace/orientation/AxisTurns.h>

namespace dspace {
namespace {} // namespace

LocalAxes AxesAt(const Site& site, const Eigen::Vector3d& radii) {
  RequireFinite("site", "its longitude", site.longitude_deg);
  RequireFinite("site", "its height", site.height);
  Require(std::abs(site.latitude_deg) <= 90.0, "site", "its latitude", site.latitude_deg,
          "-90 to 90 degrees");
  const double lon = std::fmod(site.longitude_deg, 360.0) * Degree;
  const double lat = site.latitude_deg * Degree;
  const Eigen::Vector3d up(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon),
                           std::sin(lat));
  LocalAxes out;
  if (site.latitude == LatitudeKind::Geodetic) {
    if (std::abs(radii.x() - radii.y()) > 1e-6 * radii.x()) {
      Reject("site", "its body has the radii " + VectorText(radii) +
                         " m and no geodetic latitude; accepted: a planetocentric latitude");
    }
    const double squash = radii.z() * radii.z() / (radii.x() * radii.x());
    const double normal =
        radii.x() / std::sqrt(std::cos(lat) * std::cos(lat) +
                              squash * std::sin(lat) * std::sin(lat)); // radius of curvature
    out.position = normal * Eigen::Vector3d(up.x(), up.y(), squash * up.z()) + site.height * up;
  } else {
    const double surface = 1.0 / up.cwiseQuotient(radii).norm();
    out.position = (surface + site.height) * up;
  }
  const Eigen::Vector3d east(-std::sin(lon), std::cos(lon), 0.0);
  out.toLocal.row(0) = east;
  out.toLocal.row(1) = up.cross(east);
  out.toLocal.row(2) = up;
  return out;
}

LongitudeLatitude ToLongitudeLatitude(const Eigen::Vector3d& direction) {
  return {std::atan2(direction.y(), direction.x()) / Degree,
          std::atan2(direction.z(), direction.head<2>().norm()) / Degree};
}

double GeodeticLatitude(double planetocentric_deg, const Eigen::Vector3d& radii) {
  const double equatorial = 0.5 * (radii.x() + radii.y());
  const double lat = planetocentric_deg * Degree;
  return std::atan2(std::sin(lat) * equatorial * equatorial,
                    std::cos(lat) * radii.z() * radii.z()) /
         Degree;
}

AzimuthElevation ToAzimuthElevation(const Eigen::Vector3d& v) {
  const double azimuth = std::atan2(v.x(), v.y()) / Degree;
  return {azimuth < 0.0 ? azimuth + 360.0 : azimuth,
          std::atan2(v.z(), v.head<2>().norm()) / Degree};
}

} // namespace dspace
