#include <dspace/scene/Stretch.h>

#include <Eigen/SVD>

namespace dspace {

double LargestStretch(const Eigen::Affine3d& transform) {
  const Eigen::Matrix3d linear = transform.linear();
  return Eigen::JacobiSVD<Eigen::Matrix3d>(linear).singularValues()[0];
}

} // namespace dspace
