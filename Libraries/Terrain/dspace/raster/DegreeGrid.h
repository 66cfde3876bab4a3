// A raster on a body: its pixels as a grid of longitudes and latitudes.
#ifndef DSPACE_TERRAIN_DEGREEGRID_H
#define DSPACE_TERRAIN_DEGREEGRID_H

#include <dspace/crs/BodyEllipsoid.h>
#include <dspace/raster/ElevationSource.h>

namespace dspace {

struct DegreeGrid {
  Eigen::Vector2d first_deg = Eigen::Vector2d::Zero(); // first pixel's centre: longitude (east),
                                                       // latitude
  Eigen::Vector2d step_deg = Eigen::Vector2d::Zero();  // a column to the next, a row to the next
  BodyEllipsoid body;                                  // where height is 0
  bool periodic = false; // goes once around: the column after the last is the first
  bool repeats = false;  // the last column is the first once more: to be left out
  bool poles = false;    // first and last rows of pixels lie half a pixel from the poles
};

// Of a raster in longitude and latitude, north up, on a sphere or an ellipsoid of revolution, or in
// an equidistant cylindrical projection of a sphere. Ends within a hundredth of a pixel of a whole
// turn or a pole are taken to be there. Throws Error(Unsupported) for any other, and
// InvalidArgument for one that goes around more than once or beyond a pole.
DegreeGrid DegreeGridOf(const ElevationInfo& info);

// Stretches `pixelToMap` as ElevationOptions::closesAround states. Other rasters stay as they are.
// Throws Error(Unsupported) for a projection that is no degree grid.
void CloseAround(ElevationInfo& info);

} // namespace dspace

#endif
