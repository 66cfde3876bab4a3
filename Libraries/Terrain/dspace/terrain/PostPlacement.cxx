#include <dspace/terrain/PostPlacement.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;

} // namespace

PostPlacement PostPlacement::OnPlane(const Eigen::Affine2d& postToScene, double originHeight) {
  PostPlacement placement;
  placement.Kind_ = Kind::Plane;
  placement.PostToScene_ = postToScene;
  placement.SceneToPost_ = postToScene.inverse();
  placement.OriginHeight_ = originHeight;
  if (!postToScene.matrix().allFinite() || !placement.SceneToPost_.matrix().allFinite()) {
    throw Error(Error::Kind::InvalidArgument, "terrain",
                "the map from posts to the scene has no inverse");
  }
  return placement;
}

PostPlacement PostPlacement::OnSphere(const Eigen::Vector2d& first_deg,
                                      const Eigen::Vector2d& step_deg, double radius,
                                      double middleColumn) {
  if (!first_deg.allFinite() || !step_deg.allFinite() || step_deg.x() == 0.0 ||
      step_deg.y() == 0.0 || !(radius > 0.0 && radius <= 1e12) || !std::isfinite(middleColumn)) {
    throw Error(Error::Kind::InvalidArgument, "terrain",
                "steps of a degree grid that are not 0 and a radius in (0, 1e12] m are accepted");
  }
  PostPlacement placement;
  placement.Kind_ = Kind::Sphere;
  placement.First_ = first_deg * Degree;
  placement.Step_ = step_deg * Degree;
  placement.Radius_ = radius;
  placement.MiddleColumn_ = middleColumn;
  return placement;
}

Eigen::Vector3d PostPlacement::ToScene(const Eigen::Vector2d& post, double height) const {
  if (this->Kind_ == Kind::Plane) {
    const Eigen::Vector2d xy = this->PostToScene_ * post;
    return {xy.x(), xy.y(), height - this->OriginHeight_};
  }
  const Eigen::Vector2d angles = this->First_ + post.cwiseProduct(this->Step_);
  const double c = std::cos(angles.y());
  return (this->Radius_ + height) *
         Eigen::Vector3d(c * std::cos(angles.x()), c * std::sin(angles.x()), std::sin(angles.y()));
}

Eigen::Vector3d PostPlacement::ToPosts(const Eigen::Vector3d& p_S) const {
  if (this->Kind_ == Kind::Plane) {
    const Eigen::Vector2d post = this->SceneToPost_ * Eigen::Vector2d(p_S.head<2>());
    return {post.x(), post.y(), p_S.z() + this->OriginHeight_};
  }
  const double distance = p_S.norm();
  if (distance == 0.0) {
    return {0.0, 0.0, -this->Radius_};
  }
  const double latitude = std::atan2(p_S.z(), p_S.head<2>().norm());
  const double middle = this->MiddleColumn_ * this->Step_.x();
  const double east =
      middle + std::remainder(std::atan2(p_S.y(), p_S.x()) - this->First_.x() - middle, 2.0 * M_PI);
  return {east / this->Step_.x(), (latitude - this->First_.y()) / this->Step_.y(),
          distance - this->Radius_};
}

Eigen::Vector3d PostPlacement::Up(const Eigen::Vector3d& p_S) const {
  const double distance = p_S.norm();
  return this->Kind_ == Kind::Plane || distance == 0.0 ? Eigen::Vector3d(0.0, 0.0, 1.0)
                                                       : Eigen::Vector3d(p_S / distance);
}

double PostPlacement::CellSize(const Eigen::Vector2d& post) const {
  if (this->Kind_ == Kind::Plane) {
    return std::max(this->PostToScene_.linear().col(0).norm(),
                    this->PostToScene_.linear().col(1).norm());
  }
  const double latitude = this->First_.y() + post.y() * this->Step_.y();
  return this->Radius_ *
         std::max(std::abs(this->Step_.x() * std::cos(latitude)), std::abs(this->Step_.y()));
}

} // namespace dspace
