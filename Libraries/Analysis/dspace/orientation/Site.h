// A place on a body, and its horizon.
#ifndef DSPACE_ORIENTATION_SITE_H
#define DSPACE_ORIENTATION_SITE_H

#include <Eigen/Core>

namespace dspace {

enum class LatitudeKind {
  Planetocentric, // of the direction from the body's centre
  Geodetic        // of the ellipsoid's normal (planetographic); on a sphere the same
};

// A place by longitude (east), latitude [deg] and height [m], in a body's fixed axes.
struct Site {
  double longitude_deg = 0.0;
  double latitude_deg = 0.0;
  // Geodetic: along the normal from the ellipsoid. Planetocentric: along the line from the centre,
  // from where that line leaves the ellipsoid.
  double height = 0.0;
  LatitudeKind latitude = LatitudeKind::Planetocentric;
};

// A place with its horizontal axes, in the body-fixed axes.
struct LocalAxes {
  Eigen::Vector3d position; // [m] from the body's centre
  // Components in body-fixed axes to those along east, north, up. Up is the ellipsoid's normal
  // (geodetic) or the direction from the centre (planetocentric). At a pole, east is that of the
  // site's meridian.
  Eigen::Matrix3d toLocal;
};

// `radii` [m] of the ellipsoid along the body-fixed x, y and z axes; for geodetic sites x and y
// must be equal within 1e-6 of themselves, else Error(InvalidArgument). Throws
// Error(InvalidArgument) for a latitude beyond 90 degrees, and for what is not finite.
LocalAxes AxesAt(const Site& site, const Eigen::Vector3d& radii);

// Longitude and planetocentric latitude of a direction in body-fixed axes [deg], longitude in
// (-180, 180].
struct LongitudeLatitude {
  double longitude_deg = 0.0;
  double latitude_deg = 0.0;
};
LongitudeLatitude ToLongitudeLatitude(const Eigen::Vector3d& direction);
// The geodetic latitude of the point of a spheroid with the planetocentric latitude [deg].
double GeodeticLatitude(double planetocentric_deg, const Eigen::Vector3d& radii);

// Azimuth (clockwise from north, 0 to 360) and elevation [deg] of a vector along east, north, up.
struct AzimuthElevation {
  double azimuth_deg = 0.0;
  double elevation_deg = 0.0;
};
AzimuthElevation ToAzimuthElevation(const Eigen::Vector3d& eastNorthUp);

} // namespace dspace

#endif
