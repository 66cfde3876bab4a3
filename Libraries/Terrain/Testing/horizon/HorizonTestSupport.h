// Horizons by exact rays, for tests.
#ifndef DSPACE_TEST_HORIZON_TEST_SUPPORT_H
#define DSPACE_TEST_HORIZON_TEST_SUPPORT_H

#include <cmath>
#include <vector>

#include <dspace/horizon/HorizonPath.h>
#include <dspace/horizon/HorizonSweep.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace::testing {

constexpr double ToRadians = M_PI / 180.0;

inline double ToDegrees(float tangent) {
  return std::atan(double(tangent)) / ToRadians;
}

// Elevation [deg] above which a ray from a post of level 0 (of `chart`; null: the terrain's own)
// leaves the terrain, by bisection to a hundred thousandth of a degree; -90 where nothing is in
// sight. Where the ground of the post itself is in the way of lower rays, they start `lift` [m]
// above it.
inline double ExactHorizon(const StreamedTerrain& terrain, const Eigen::Vector2d& post,
                           double height, double azimuth_deg, double lift = 1e-4,
                           const PostPlacement* chart = nullptr) {
  const PostPlacement& placement = chart ? *chart : terrain.Placement();
  const ChartAxes axes = ChartAxesAt(placement, post);
  const Eigen::Vector3d eye = placement.ToScene(post, height + lift);
  const Eigen::Vector3d along = std::sin(azimuth_deg * ToRadians) * axes.east +
                                std::cos(azimuth_deg * ToRadians) * axes.north;
  const auto hidden = [&](double elevation) {
    const Eigen::Vector3d ray =
        std::cos(elevation * ToRadians) * along + std::sin(elevation * ToRadians) * axes.up;
    return terrain.Intersect(eye, ray).hit;
  };
  // From above: below the ground, where there are holes, a ray may miss it again.
  double high = 89.0;
  double low = high;
  while (low > -89.0 && !hidden(low)) {
    high = low;
    low -= 0.5;
  }
  if (low <= -89.0) {
    return -90.0;
  }
  while (high - low > 1e-5) {
    const double middle = 0.5 * (low + high);
    (hidden(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// The sweep of one post.
inline std::pair<double, double> SweptHorizon(const HorizonSweep& sweep, int level, std::int64_t c,
                                              std::int64_t r, double azimuth_deg) {
  float all = 0.0f;
  float distant = 0.0f;
  sweep.Sweep({level, c, r, 1, 1}, azimuth_deg, &all, &distant);
  return {ToDegrees(all), ToDegrees(distant)};
}

} // namespace dspace::testing

#endif
