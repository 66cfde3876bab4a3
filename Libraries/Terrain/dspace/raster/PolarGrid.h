// A raster on a body in the stereographic plane of a pole.
#ifndef DSPACE_TERRAIN_POLARGRID_H
#define DSPACE_TERRAIN_POLARGRID_H

#include <optional>

#include <dspace/crs/BodyEllipsoid.h>
#include <dspace/raster/ElevationSource.h>

namespace dspace {

// As PostPlacement::AtPole takes it.
struct PolarGrid {
  bool south = false;
  double step = 0.0;                              // of a pixel, in twice the sphere's radius
  Eigen::Vector2d pole = Eigen::Vector2d::Zero(); // in pixels from the first one's centre
  double east_deg = 0.0;                          // longitude along which columns run from the pole
  BodyEllipsoid body;                             // where height is 0
};

// None for a raster of another kind: what PROJ says of the projection decides, not its name, so
// that any scale, true latitude, false origin and unit is understood. Throws
// Error(Unsupported) for one whose pixels are not square, are mirrored, or lie more than 35
// degrees beyond the equator, and what BodyOfRaster throws.
std::optional<PolarGrid> PolarGridOf(const ElevationInfo& info);

} // namespace dspace

#endif
