// Terrains made in tests, and what is checked on them by brute force.
#ifndef DSPACE_TEST_GRIDS_H
#define DSPACE_TEST_GRIDS_H

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>

#include <dspace/surface/GridTerrain.h>

namespace dspace::testing {

// Pixel corners to map for square pixels of `size`, north up, top-left corner at (x, y).
inline Eigen::Affine2d NorthUp(double x, double y, double size) {
  Eigen::Affine2d m = Eigen::Affine2d::Identity();
  m.linear() << size, 0.0, 0.0, -size;
  m.translation() << x, y;
  return m;
}

// Heights are a function of map coordinates at the posts.
inline std::shared_ptr<const GridTerrain>
Sampled(int columns, int rows, const Eigen::Affine2d& pixelToMap,
        const std::function<double(const Eigen::Vector2d&)>& height, double originHeight = 0.0) {
  std::vector<double> heights;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      heights.push_back(height(pixelToMap * Eigen::Vector2d(c + 0.5, r + 0.5)));
  return std::make_shared<GridTerrain>("test", columns, rows, std::move(heights), pixelToMap, Crs(),
                                       VerticalDatum(), std::nullopt, originHeight);
}

// Random posts on a smooth swell; `holes` is the share of posts without data.
inline std::shared_ptr<const GridTerrain> Rough(int columns, int rows, unsigned seed,
                                                double holes = 0.0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<double> heights;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double h = 3.0 * std::sin(0.11 * c) * std::cos(0.07 * r) + unit(random);
      heights.push_back(unit(random) < holes ? std::numeric_limits<double>::quiet_NaN() : h);
    }
  return std::make_shared<GridTerrain>("rough", columns, rows, std::move(heights),
                                       NorthUp(1000.0, 2000.0, 0.7));
}

} // namespace dspace::testing

#endif
