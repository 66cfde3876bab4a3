// Longitude, latitude and height on a body's ellipsoid, and body-fixed coordinates.
#ifndef DSPACE_TERRAIN_BODYCOORDINATES_H
#define DSPACE_TERRAIN_BODYCOORDINATES_H

#include <limits>

#include <Eigen/Core>

#include <dspace/crs/VerticalDatum.h>

namespace dspace {

// One place in the coordinates of its body; NaN where there are none.
struct BodyCoordinates {
  double longitude_deg = std::numeric_limits<double>::quiet_NaN(); // east, -180 to 180
  double latitude_deg = std::numeric_limits<double>::quiet_NaN();  // geodetic: of the normal
  double height = std::numeric_limits<double>::quiet_NaN(); // [m] above the ellipsoid or sphere
  // From the body's centre, Z to its north pole, X to longitude 0 [m].
  Eigen::Vector3d bodyFixed = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
};

// Body-fixed coordinates of a place on an ellipsoid of revolution. Source: EPSG Guidance Note 7-2,
// 4.1.1 (geographic 3D to geocentric).
Eigen::Vector3d GeodeticToBodyFixed(const BodyAxes& axes, double longitude_deg, double latitude_deg,
                                    double height);

// `height` is above the zero of `datum`. The height above the ellipsoid differs from it where the
// zero is a sphere of another radius, along the ellipsoid's normal. The height above a geoid or an
// areoid, and above an unknown zero, is taken as that above the ellipsoid (DatumErrorBound).
BodyCoordinates BodyCoordinatesOf(const BodyAxes& axes, const VerticalDatum& datum,
                                  double longitude_deg, double latitude_deg, double height);

} // namespace dspace

#endif
