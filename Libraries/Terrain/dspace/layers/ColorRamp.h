// Colour ramps: colours by height, slope or any other value.
#ifndef DSPACE_LAYERS_COLORRAMP_H
#define DSPACE_LAYERS_COLORRAMP_H

#include <array>
#include <vector>

namespace dspace {

// Colours spaced evenly from the least to the greatest value, linear between them.
using ColorRamp = std::vector<std::array<double, 3>>; // sRGB in [0, 1]; at least one

// The ramp's colour at `where`: 0 is its first colour, 1 its last. Values outside [0, 1] give the
// nearer of the two. The ramp has at least one colour.
std::array<double, 3> ColorAt(const ColorRamp& ramp, double where);

// A natural ramp for colour by height, from deep green over ochre to white.
ColorRamp TerrainRamp();

} // namespace dspace

#endif
