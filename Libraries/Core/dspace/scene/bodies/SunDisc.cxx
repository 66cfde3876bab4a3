#include <dspace/scene/bodies/SunDisc.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

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

double SunLeft(const SunBlocker& blocker, const Eigen::Vector3d& sun, double radius) {
  const Eigen::Vector3d body = blocker.unit * blocker.center;
  const Eigen::Vector3d toSun = blocker.unit * sun;
  const double away = toSun.norm();
  const Eigen::Vector3d s = toSun / away;
  const double along = body.dot(s);
  const double square = body.squaredNorm();
  constexpr double Nearest = 1.01 * 1.01;
  if (square < Nearest || along <= 0.0 || along >= away) {
    return 1.0;
  }
  const Eigen::Vector3d aside = body - along * s;
  const double sine = aside.norm();
  const Eigen::Vector3d u = sine > 1e-12 ? Eigen::Vector3d(aside / sine) : s.unitOrthogonal();
  const double a = radius * (blocker.unit.transpose() * u).norm() / away;
  return DiscLeft(a, std::asin(1.0 / std::sqrt(square)), std::atan2(sine, along));
}

} // namespace dspace
