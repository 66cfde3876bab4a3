// The place of a raster on the map.
#ifndef DSPACE_RASTER_RASTERPLACE_H
#define DSPACE_RASTER_RASTERPLACE_H

#include <string>

#include <Eigen/Geometry>

#include <dspace/crs/Crs.h>

namespace dspace {

// Where a terrain's raster lies: images are laid on it from pixel edge to pixel edge.
struct RasterPlace {
  std::string name; // for messages: "terrain 'gale.tif'"
  Crs crs;
  Eigen::Affine2d pixelToMap = Eigen::Affine2d::Identity(); // as in ElevationInfo
  int columns = 0;
  int rows = 0;
};

} // namespace dspace

#endif
