#include <dspace/scene/bodies/SunDisc.h>

#include <cmath>

#include <Eigen/Geometry>

#include <dspace/DiscLeft.h>

namespace dspace {
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
