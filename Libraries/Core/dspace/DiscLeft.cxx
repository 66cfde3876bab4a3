#include <dspace/DiscLeft.h>

#include <algorithm>
#include <cmath>

namespace dspace {
namespace {

// A segment of a unit circle that spans the half angle `alpha`.
double Segment(double alpha) {
  return alpha < 0.1 ? alpha * alpha * alpha * (2.0 / 3.0) * (1.0 - 0.2 * alpha * alpha)
                     : alpha - std::sin(alpha) * std::cos(alpha);
}

} // namespace

double DiscLeft(double a, double b, double d) {
  if (d >= a + b) {
    return 1.0;
  }
  if (d <= b - a) {
    return 0.0;
  }
  if (d <= a - b) {
    return 1.0 - b * b / (a * a);
  }
  // The chord through both crossings: its distance from the first centre.
  const double x = std::clamp(((d - b) * (d + b) + a * a) / (2.0 * d), -a, a);
  const double half = std::sqrt(std::max(0.0, (a - x) * (a + x)));
  const double alpha = std::acos(x / a);
  const double beta = std::atan2(half, d - x);
  return std::clamp(1.0 - (a * a * Segment(alpha) + b * b * Segment(beta)) / (M_PI * a * a), 0.0,
                    1.0);
}

} // namespace dspace
