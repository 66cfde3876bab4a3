// A colour ramp's colour at a place between its ends. Not for public headers.
#ifndef DSPACE_TERRAIN_RAMPCOLOR_H
#define DSPACE_TERRAIN_RAMPCOLOR_H

#include <dspace/terrain/DrapeImage.h>

namespace dspace {

// From 0 (its first colour) to 1 (its last); outside them those two.
std::array<double, 3> ColorAt(const ColorRamp& ramp, double where);

} // namespace dspace

#endif
