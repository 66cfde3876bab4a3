#include <dspace/layers/ColorGrid.h>

#include <algorithm>
#include <cmath>

namespace dspace {

Eigen::Affine2d ColorGrid::TexelToPost(int zoom) const {
  Eigen::Affine2d map = Eigen::Affine2d::Identity();
  map.linear() = (this->rootPosts * std::ldexp(1.0 / TileTexels, -zoom)).asDiagonal();
  map.translation() = this->firstPost;
  return map;
}

double ColorGrid::RootTexelSize() const {
  const Eigen::Vector2d middle = this->extent.center();
  const Eigen::Vector2d texel = this->rootPosts / TileTexels;
  double most = 0.0;
  for (int axis = 0; axis < 2; ++axis) { // from a small step: zoom 0 may be large on its body
    constexpr double Part = 1e-3;
    const Eigen::Vector2d half = 0.5 * Part * texel[axis] * Eigen::Vector2d::Unit(axis);
    const Eigen::Vector3d across =
        this->placement.ToScene(middle + half, 0.0) - this->placement.ToScene(middle - half, 0.0);
    most = std::max(most, across.norm() / Part);
  }
  return most;
}

int ColorGrid::ZoomFor(double pixel) const {
  const double zoom = std::ceil(std::log2(this->RootTexelSize() / pixel) - 1e-6);
  return static_cast<int>(std::clamp(zoom, 0.0, double(MaximumZoom)));
}

} // namespace dspace
