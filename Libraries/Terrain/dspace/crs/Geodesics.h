// The shortest lines along a body's ellipsoid.
#ifndef DSPACE_TERRAIN_GEODESICS_H
#define DSPACE_TERRAIN_GEODESICS_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/crs/BodyEllipsoid.h>

namespace dspace {

// Places are (longitude, latitude) [deg], east and north positive, latitude geodetic.

// "longitude 12, latitude 91"
std::string PlaceText(const Eigen::Vector2d& place);
// Throws Error(InvalidArgument) for a latitude beyond 90 degrees, and for what is not finite.
void RequirePlace(const Eigen::Vector2d& place);

// The shortest line from one place to another.
struct Geodesic {
  double distance = 0.0;       // [m], at height 0
  double azimuth_deg = 0.0;    // at the first place, clockwise from north, 0 to 360
  double endAzimuth_deg = 0.0; // of the same line at the second place
};

// Where a line ends.
struct GeodesicEnd {
  Eigen::Vector2d place = Eigen::Vector2d::Zero(); // longitude -180 to 180
  double azimuth_deg = 0.0;                        // 0 to 360
};

// A polygon whose edges are geodesics.
struct GeodesicPolygon {
  double area = 0.0;      // [m^2], at height 0; of the side that is no larger than half of the body
  double perimeter = 0.0; // [m]
};

// The geodesic problems of one ellipsoid, to some nanometres. Source: C. F. F. Karney, "Algorithms
// for geodesics", J. Geodesy 87, 43-55 (2013): GeographicLib's series for flattenings up to 1/100,
// its elliptic integrals beyond.
class Geodesics {
public:
  explicit Geodesics(const BodyEllipsoid& ellipsoid);
  ~Geodesics();
  Geodesics(const Geodesics&) = delete;
  Geodesics& operator=(const Geodesics&) = delete;

  // The inverse problem. Throws as RequirePlace does. Where several lines are equally short
  // (opposite points), one of them.
  Geodesic Between(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;
  // The direct problem. A negative distance goes backwards. Throws also for an azimuth and a
  // distance that are not finite.
  GeodesicEnd EndOf(const Eigen::Vector2d& from, double azimuth_deg, double distance) const;
  // The polygon with these corners, in either order; edges must not cross (the caller's duty). It
  // may hold a pole. Throws as RequirePlace does, and Error(InvalidArgument) for fewer than 3
  // corners. On the Earth the area is within 0.1 m^2 an edge (Karney 2013, section 6).
  GeodesicPolygon Around(const std::vector<Eigen::Vector2d>& corners) const;

private:
  struct Solver;
  std::unique_ptr<const Solver> Solver_;
};

} // namespace dspace

#endif
