// The body that a raster stands on.
#ifndef DSPACE_TERRAIN_RASTERBODY_H
#define DSPACE_TERRAIN_RASTERBODY_H

#include <dspace/crs/BodyEllipsoid.h>
#include <dspace/raster/ElevationSource.h>

namespace dspace {

// What can stand on a body, for messages.
constexpr const char* AcceptedOnBody =
    "accepted on a body is a north-up grid in longitude and latitude, or a raster in an "
    "equidistant cylindrical or polar stereographic projection of a sphere; or draw it on a plane";

// Where height 0 is: the CRS's sphere, with the radius of the vertical datum if that states one, or
// the ellipsoid of revolution of longitudes and latitudes. Throws Error(Unsupported) for an
// ellipsoid under a projection or under heights above a sphere, and for one that is not oblate.
BodyEllipsoid BodyOfRaster(const ElevationInfo& info);

} // namespace dspace

#endif
