#include <dspace/posts/ChartAxes.h>

#include <cmath>

namespace dspace {

ChartAxes ChartAxesAt(const PostPlacement& placement, const Eigen::Vector2d& post) {
  if (placement.GetKind() == PostPlacement::Kind::Plane) {
    return {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
  }
  if (placement.GetKind() == PostPlacement::Kind::Sphere) {
    const Eigen::Vector2d angles = placement.Angles(post);
    const double sl = std::sin(angles.x()), cl = std::cos(angles.x());
    const double sp = std::sin(angles.y()), cp = std::cos(angles.y());
    return {{-sl, cl, 0.0}, {-sp * cl, -sp * sl, cp}, {cp * cl, cp * sl, sp}};
  }
  // The stereographic plane keeps angles.
  const Eigen::Vector2d u = placement.OnPlaneOfPole(post);
  const double t = 1.0 + u.squaredNorm();
  const auto inScene = [&](const Eigen::Vector3d& v) { return placement.FromChart(v); };
  return {inScene({1.0 - 2.0 * u.x() * u.x() / t, -2.0 * u.x() * u.y() / t, -2.0 * u.x() / t}),
          inScene({-2.0 * u.x() * u.y() / t, 1.0 - 2.0 * u.y() * u.y() / t, -2.0 * u.y() / t}),
          inScene({2.0 * u.x() / t, 2.0 * u.y() / t, (2.0 - t) / t})};
}

} // namespace dspace
