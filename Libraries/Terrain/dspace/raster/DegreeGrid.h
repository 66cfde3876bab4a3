// A raster on a sphere: its pixels as a grid of longitudes and latitudes.
#ifndef DSPACE_TERRAIN_DEGREEGRID_H
#define DSPACE_TERRAIN_DEGREEGRID_H

#include <dspace/raster/ElevationSource.h>

namespace dspace {

struct DegreeGrid {
  Eigen::Vector2d first_deg = Eigen::Vector2d::Zero(); // first pixel's centre: longitude (east),
                                                       // latitude
  Eigen::Vector2d step_deg = Eigen::Vector2d::Zero();  // a column to the next, a row to the next
  double radius = 0.0;                                 // [m] where height is 0
  bool periodic = false; // goes once around: the column after the last is the first
  bool repeats = false;  // the last column is the first once more: to be left out
  bool poles = false;    // first and last rows of pixels lie half a pixel from the poles
};

// Of a raster in longitude and latitude or in an equidistant cylindrical projection, north up, on a
// sphere. Ends within a hundredth of a pixel of a whole turn or a pole are taken to be there.
// Throws Error(Unsupported) for any other, and InvalidArgument for one that goes around more than
// once or beyond a pole.
DegreeGrid DegreeGridOf(const ElevationInfo& info);

} // namespace dspace

#endif
