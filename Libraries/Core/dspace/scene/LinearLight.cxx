#include <dspace/scene/LinearLight.h>

#include <cmath>

namespace dspace {

float LinearFromSrgb(double value) {
  return static_cast<float>(value <= 0.04045 ? value / 12.92
                                             : std::pow((value + 0.055) / 1.055, 2.4));
}

std::array<float, 3> LinearColor(const std::array<double, 3>& srgb) {
  return {LinearFromSrgb(srgb[0]), LinearFromSrgb(srgb[1]), LinearFromSrgb(srgb[2])};
}

} // namespace dspace
