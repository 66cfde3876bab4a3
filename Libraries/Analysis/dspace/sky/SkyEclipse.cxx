#include <dspace/sky/SkyEclipse.h>

#include <cmath>

#include <Eigen/Geometry>

#include <dspace/DiscLeft.h>

namespace dspace {

std::optional<int> EclipserOver(int body) {
  constexpr int Moon = 301;
  constexpr int Earth = 399;
  return body == Moon    ? std::optional<int>(Earth)
         : body == Earth ? std::optional<int>(Moon)
                         : std::nullopt;
}

double SunLeftOver(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& place,
                   const SkyBody& sun, double tdb) {
  const std::optional<int> eclipser = EclipserOver(place.body);
  if (!eclipser) {
    return 1.0;
  }
  const SkyBody other = Look(ephemeris, frames, place, *eclipser, tdb);
  const double apart = std::atan2(sun.eastNorthUp.cross(other.eastNorthUp).norm(),
                                  sun.eastNorthUp.dot(other.eastNorthUp));
  return DiscLeft(sun.radius_deg, other.radius_deg, apart * 180.0 / M_PI);
}

} // namespace dspace
