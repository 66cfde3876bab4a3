#include <dspace/scene/Stretch.h>

#include <cmath>

#include <Eigen/SVD>

namespace dspace {

double LargestStretch(const Eigen::Affine3d& transform) {
  const Eigen::Matrix3d linear = transform.linear();
  // Most only turn, and stretch all lengths alike: their columns stand at right angles.
  const Eigen::Matrix3d products = linear.transpose() * linear;
  const double square = products(0, 0);
  if ((products - square * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= 1e-14 * square) {
    return std::sqrt(square);
  }
  return Eigen::JacobiSVD<Eigen::Matrix3d>(linear).singularValues()[0];
}

} // namespace dspace
