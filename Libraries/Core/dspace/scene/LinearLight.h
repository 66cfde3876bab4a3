// Display values and linear light.
#ifndef DSPACE_SCENE_LINEAR_LIGHT_H
#define DSPACE_SCENE_LINEAR_LIGHT_H

#include <array>

namespace dspace {

// sRGB display value (0 to 1) to linear light (IEC 61966-2-1).
float LinearFromSrgb(double value);

std::array<float, 3> LinearColor(const std::array<double, 3>& srgb);

} // namespace dspace

#endif
