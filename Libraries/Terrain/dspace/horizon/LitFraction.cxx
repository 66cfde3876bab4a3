#include <dspace/horizon/LitFraction.h>

#include <algorithm>
#include <cmath>

namespace dspace {

double LitFraction(double above, double slope, double radius) {
  const double distance = above / std::sqrt(1.0 + slope * slope); // of the centre from the line
  if (!(radius > 0.0)) {
    return distance >= 0.0 ? 1.0 : 0.0;
  }
  const double x = std::clamp(distance / radius, -1.0, 1.0);
  return 0.5 + (x * std::sqrt(1.0 - x * x) + std::asin(x)) / M_PI;
}

} // namespace dspace
