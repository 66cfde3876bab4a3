// After how much of map x a CRS repeats. Not for public headers.
#ifndef DSPACE_TERRAIN_MAPTURN_H
#define DSPACE_TERRAIN_MAPTURN_H

#include <dspace/crs/Crs.h>

namespace dspace {

// [map units]; 0 where x does not repeat: longitudes and equidistant cylindrical projections do.
double MapTurn(const Crs& crs);

} // namespace dspace

#endif
