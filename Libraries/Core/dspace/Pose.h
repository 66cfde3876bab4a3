// A similarity transform in double precision: position, unit quaternion, uniform scale.
#ifndef DSPACE_POSE_H
#define DSPACE_POSE_H

#include <Eigen/Geometry>

namespace dspace {

// X_WG, the pose of frame G in frame W: p_W = position + rotation * (scale * p_G).
// Metres; the quaternion is unit and takes G's components to W's; scale > 0 is uniform, so that
// the poses of a tree are closed under composition (shear cannot arise). Stretching along one axis
// belongs to the geometry's own offset, not to a frame.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();           // p_WG [m]
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity(); // q_WG, scalar first when listed
  double scale = 1.0;

  // X_WH = X_WG * X_GH.
  Pose operator*(const Pose& X_GH) const {
    return {this->position + this->rotation * (this->scale * X_GH.position),
            (this->rotation * X_GH.rotation).normalized(), this->scale * X_GH.scale};
  }

  // X_GW from X_WG.
  Pose Inverse() const {
    const Eigen::Quaterniond q = this->rotation.conjugate();
    return {q * (-this->position / this->scale), q, 1.0 / this->scale};
  }

  // p_W from p_G.
  Eigen::Vector3d Apply(const Eigen::Vector3d& p_G) const {
    return this->position + this->rotation * (this->scale * p_G);
  }

  // 4 × 4 homogeneous matrix, column vectors on the right.
  Eigen::Matrix4d Matrix() const {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<3, 3>() = this->scale * this->rotation.toRotationMatrix();
    m.topRightCorner<3, 1>() = this->position;
    return m;
  }

  // Bit-wise equality of all eight numbers.
  bool operator==(const Pose& o) const {
    return this->position == o.position && this->rotation.coeffs() == o.rotation.coeffs() &&
           this->scale == o.scale;
  }
  bool operator!=(const Pose& o) const { return !(*this == o); }
};

// Doubles of a pose in an array: px py pz qw qx qy qz scale.
constexpr int PoseSize = 8;

} // namespace dspace

#endif
