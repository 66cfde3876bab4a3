#include <dspace/crs/GridReferences.h>

#include <cmath>

#include <GeographicLib/Constants.hpp>
#include <GeographicLib/MGRS.hpp>
#include <GeographicLib/UTMUPS.hpp>

#include <dspace/Checks.h>
#include <dspace/crs/Geodesics.h>

namespace dspace {
namespace {

// `find` with GeographicLib's errors as ours.
template<class Find> auto Found(const std::string& object, const char* accepted, Find find) {
  try {
    return find();
  } catch (const GeographicLib::GeographicErr& error) {
    Reject(object, std::string(error.what()) + "; accepted: " + accepted);
  }
}

} // namespace

UtmPlace UtmOf(const Eigen::Vector2d& place, std::optional<int> zone) {
  RequirePlace(place);
  const std::string object = "place " + PlaceText(place);
  if (zone && (*zone < 0 || *zone > 60)) {
    Reject(object, "the UTM zone is " + std::to_string(*zone) +
                       "; accepted: 1 to 60, or 0 for UPS about the poles");
  }
  return Found(object, "places that are near the zone", [&] {
    UtmPlace utm;
    GeographicLib::UTMUPS::Forward(place.y(), place.x(), utm.zone, utm.north, utm.easting,
                                   utm.northing,
                                   zone.value_or(int(GeographicLib::UTMUPS::STANDARD)));
    return utm;
  });
}

Eigen::Vector2d PlaceOfUtm(const UtmPlace& utm) {
  const std::string object = "UTM coordinates " + NumberText(utm.easting) + ", " +
                             NumberText(utm.northing) + " in zone " + std::to_string(utm.zone) +
                             (utm.north ? " north" : " south");
  if (utm.zone < 0 || utm.zone > 60) {
    Reject(object, "there is no such zone; accepted: 1 to 60, or 0 for UPS about the poles");
  }
  if (!std::isfinite(utm.easting) || !std::isfinite(utm.northing)) {
    Reject(object, "accepted: finite numbers");
  }
  return Found(object, "coordinates inside of the zone's grid", [&] {
    Eigen::Vector2d place;
    GeographicLib::UTMUPS::Reverse(utm.zone, utm.north, utm.easting, utm.northing, place.y(),
                                   place.x());
    return place;
  });
}

std::string MgrsOf(const Eigen::Vector2d& place, int precision, std::optional<int> zone) {
  const std::string object = "place " + PlaceText(place);
  if (precision < 0 || precision > 11) {
    Reject(object, "the precision of its MGRS reference is " + std::to_string(precision) +
                       "; accepted: 0 to 11 digits");
  }
  const UtmPlace utm = UtmOf(place, zone);
  return Found(object, "places that have an MGRS reference", [&] {
    std::string text;
    GeographicLib::MGRS::Forward(utm.zone, utm.north, utm.easting, utm.northing, place.y(),
                                 precision, text);
    return text;
  });
}

MgrsSquare SquareOfMgrs(const std::string& reference) {
  const std::string object = "MGRS reference '" + reference + "'";
  const char* accepted = "a text such as '33UXP0500044000'";
  return Found(object, accepted, [&] {
    UtmPlace utm;
    int precision = -1;
    GeographicLib::MGRS::Reverse(reference, utm.zone, utm.north, utm.easting, utm.northing,
                                 precision);
    if (precision < 0 || !std::isfinite(utm.easting)) { // "INV", or a zone alone
      Reject(object, std::string("it names no square; accepted: ") + accepted);
    }
    return MgrsSquare{PlaceOfUtm(utm), std::pow(10.0, 5 - precision)};
  });
}

BodyEllipsoid Wgs84() {
  const double equatorial = GeographicLib::Constants::WGS84_a();
  return {equatorial, equatorial * (1.0 - GeographicLib::Constants::WGS84_f())};
}

bool IsWgs84(const BodyEllipsoid& ellipsoid) {
  const BodyEllipsoid earth = Wgs84();
  return std::abs(ellipsoid.Equatorial() - earth.Equatorial()) < 1e-3 &&
         std::abs(ellipsoid.Polar() - earth.Polar()) < 1e-3;
}

} // namespace dspace
