// Grid references of WGS 84: UTM, UPS and MGRS.
#ifndef DSPACE_TERRAIN_GRIDREFERENCES_H
#define DSPACE_TERRAIN_GRIDREFERENCES_H

#include <optional>
#include <string>

#include <dspace/crs/BodyEllipsoid.h>

namespace dspace {

// Places are (longitude, latitude) [deg] on WGS 84, east and north positive, latitude geodetic.
// Source of the arithmetic: GeographicLib.

// A place in UTM, or in UPS about the poles.
struct UtmPlace {
  int zone = 0; // 1 to 60; 0: UPS
  bool north = true;
  double easting = 0.0;  // [m]
  double northing = 0.0; // [m], with the false northing of 10,000 km in the south
};

// `zone`: absent: the standard one, with the exceptions of Norway and Svalbard, and UPS beyond
// latitudes -80 and 84. Throws Error(InvalidArgument) for a latitude beyond 90 degrees, for what is
// not finite, for a zone beyond 60, and for a place that is too far from the zone.
UtmPlace UtmOf(const Eigen::Vector2d& place, std::optional<int> zone = std::nullopt);
// Throws Error(InvalidArgument) for coordinates outside of the zone's grid.
Eigen::Vector2d PlaceOfUtm(const UtmPlace& utm);

// `precision`: digits of easting and northing each, 0 to 11; 5 is a metre. Throws what UtmOf
// throws.
std::string MgrsOf(const Eigen::Vector2d& place, int precision = 5,
                   std::optional<int> zone = std::nullopt);

struct MgrsSquare {
  Eigen::Vector2d center = Eigen::Vector2d::Zero(); // (longitude, latitude) [deg]
  double side = 0.0;                                // [m], 1e5 to 1e-6
};
// Throws Error(InvalidArgument) for a text that names no square.
MgrsSquare SquareOfMgrs(const std::string& reference);

BodyEllipsoid Wgs84();
// Whether grid references and geoid heights apply: semi-axes within a millimetre of those of WGS 84
// (GRS 80, of NAD 83 and ETRS 89, is within 0.11 mm).
bool IsWgs84(const BodyEllipsoid& ellipsoid);

} // namespace dspace

#endif
