#include <dspace/layers/ColorRamp.h>

#include <algorithm>
#include <cstddef>

namespace dspace {

std::array<double, 3> ColorAt(const ColorRamp& ramp, double where) {
  const double at = std::clamp(where, 0.0, 1.0) * static_cast<double>(ramp.size() - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(at), ramp.size() - 1);
  const std::size_t next = std::min(i + 1, ramp.size() - 1);
  const double f = at - static_cast<double>(i);
  std::array<double, 3> color;
  for (int k = 0; k < 3; ++k)
    color[k] = ramp[i][k] * (1.0 - f) + ramp[next][k] * f;
  return color;
}

ColorRamp TerrainRamp() {
  return {{0.16, 0.35, 0.28}, {0.45, 0.58, 0.33}, {0.82, 0.74, 0.48},
          {0.66, 0.44, 0.28}, {0.55, 0.45, 0.42}, {0.97, 0.97, 0.97}};
}

} // namespace dspace
