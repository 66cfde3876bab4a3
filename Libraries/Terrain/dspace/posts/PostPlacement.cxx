#include <dspace/posts/PostPlacement.h>

#include <algorithm>
#include <cmath>
#include <vector>

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
  placement.Body_ = BodyEllipsoid(radius, radius);
  placement.MiddleColumn_ = middleColumn;
  return placement;
}

PostPlacement PostPlacement::OnEllipsoid(const Eigen::Vector2d& first_deg,
                                         const Eigen::Vector2d& step_deg, const BodyEllipsoid& body,
                                         double middleColumn) {
  PostPlacement placement = OnSphere(first_deg, step_deg, body.Equatorial(), middleColumn);
  placement.Body_ = body;
  return placement;
}

PostPlacement PostPlacement::OnPole(bool south, double spacing, double half, double radius) {
  if (!(spacing > 0.0 && std::isfinite(spacing)) || !(radius > 0.0 && radius <= 1e12) ||
      !std::isfinite(half)) {
    throw Error(Error::Kind::InvalidArgument, "terrain",
                "a spacing of more than 0 m and a radius in (0, 1e12] m are accepted");
  }
  PostPlacement placement;
  placement.Kind_ = Kind::Pole;
  placement.South_ = south;
  placement.PlaneStep_ = 0.5 * spacing / radius;
  placement.Half_ = half;
  placement.Radius_ = radius;
  placement.Body_ = BodyEllipsoid(radius, radius);
  return placement;
}

PostPlacement PostPlacement::OnPole(bool south, double spacing, double half,
                                    const BodyEllipsoid& body) {
  PostPlacement placement = OnPole(south, spacing, half, body.Equatorial());
  placement.Body_ = body;
  return placement;
}

Eigen::Vector2d PostPlacement::Angles(const Eigen::Vector2d& post) const {
  if (this->Kind_ != Kind::Pole) {
    return this->First_ + post.cwiseProduct(this->Step_);
  }
  const Eigen::Vector2d u = this->OnPlaneOfPole(post);
  const double latitude = 0.5 * M_PI - 2.0 * std::atan(u.norm());
  return {std::atan2(this->South_ ? -u.y() : u.y(), u.x()), this->South_ ? -latitude : latitude};
}

Eigen::Vector3d PostPlacement::ToScene(const Eigen::Vector2d& post, double height) const {
  if (this->Kind_ == Kind::Plane) {
    const Eigen::Vector2d xy = this->PostToScene_ * post;
    return {xy.x(), xy.y(), height - this->OriginHeight_};
  }
  if (this->Kind_ == Kind::Pole) {
    const Eigen::Vector2d u = this->OnPlaneOfPole(post);
    const double q = u.squaredNorm();
    const Eigen::Vector3d p =
        this->Body_.Spherical()
            ? Eigen::Vector3d((this->Radius_ + height) / (1.0 + q) *
                              Eigen::Vector3d(2.0 * u.x(), 2.0 * u.y(), 1.0 - q))
            : this->Body_.Point(Eigen::Vector3d(2.0 * u.x(), 2.0 * u.y(), 1.0 - q) / (1.0 + q),
                                height);
    return this->South_ ? Eigen::Vector3d(p.x(), -p.y(), -p.z()) : p;
  }
  const Eigen::Vector2d angles = this->First_ + post.cwiseProduct(this->Step_);
  const double c = std::cos(angles.y());
  const Eigen::Vector3d up(c * std::cos(angles.x()), c * std::sin(angles.x()),
                           std::sin(angles.y()));
  return this->Body_.Spherical() ? Eigen::Vector3d((this->Radius_ + height) * up)
                                 : this->Body_.Point(up, height);
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
  if (!this->Body_.Spherical()) { // the place of a sphere with the same vertical
    const BodyEllipsoid::Foot foot = this->Body_.FootOf(p_S);
    PostPlacement sphere = *this;
    sphere.Body_ = BodyEllipsoid(this->Radius_, this->Radius_);
    const Eigen::Vector3d post = sphere.ToPosts(foot.up * this->Radius_);
    return {post.x(), post.y(), foot.height};
  }
  if (this->Kind_ == Kind::Pole) {
    Eigen::Vector3d d = p_S / distance;
    if (this->South_) {
      d = Eigen::Vector3d(d.x(), -d.y(), -d.z());
    }
    // The other pole is infinitely far: a place far outside stands for it.
    const Eigen::Vector2d u = d.head<2>() / std::max(1.0 + d.z(), 1e-9);
    return {this->Half_ + u.x() / this->PlaneStep_, this->Half_ - u.y() / this->PlaneStep_,
            distance - this->Radius_};
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
  if (this->OnBody() && !this->Body_.Spherical()) {
    return this->Body_.FootOf(p_S).up;
  }
  return this->Kind_ == Kind::Plane || distance == 0.0 ? Eigen::Vector3d(0.0, 0.0, 1.0)
                                                       : Eigen::Vector3d(p_S / distance);
}

Eigen::Vector3d PostPlacement::North(const Eigen::Vector3d& p_S) const {
  if (this->Kind_ == Kind::Plane) {
    return Eigen::Vector3d::UnitY();
  }
  const Eigen::Vector3d up = this->Up(p_S);
  const double longitude = std::atan2(up.y(), up.x());
  return up.cross(Eigen::Vector3d(-std::sin(longitude), std::cos(longitude), 0.0));
}

Eigen::AlignedBox3d PostPlacement::BoundsOf(const Eigen::Vector2d& last, double low,
                                            double high) const {
  Eigen::AlignedBox3d box;
  const auto extend = [&](const Eigen::Vector2d& post) {
    box.extend(this->ToScene(post, low));
    box.extend(this->ToScene(post, high));
  };
  if (this->Kind_ == Kind::Plane) {
    for (const double c : {0.0, last.x()}) {
      for (const double r : {0.0, last.y()}) {
        extend({c, r});
      }
    }
    return box;
  }
  // Sines and cosines have their extremes at the ends and at whole quarters of a turn between.
  const auto places = [](double from, double to) {
    std::vector<double> angles = {from, to};
    for (double a = std::ceil(std::min(from, to) / (0.5 * M_PI)) * 0.5 * M_PI;
         a < std::max(from, to); a += 0.5 * M_PI) {
      angles.push_back(a);
    }
    return angles;
  };
  const Eigen::Vector2d end = this->First_ + last.cwiseProduct(this->Step_);
  for (const double longitude : places(this->First_.x(), end.x())) {
    for (const double latitude : places(this->First_.y(), end.y())) {
      extend((Eigen::Vector2d(longitude, latitude) - this->First_).cwiseQuotient(this->Step_));
    }
  }
  return box;
}

double PostPlacement::CellSize(const Eigen::Vector2d& post) const {
  if (this->Kind_ == Kind::Plane) {
    return std::max(this->PostToScene_.linear().col(0).norm(),
                    this->PostToScene_.linear().col(1).norm());
  }
  if (this->Kind_ == Kind::Pole) {
    const double q = this->OnPlaneOfPole(post).squaredNorm();
    const double radius =
        this->Body_.Spherical() ? this->Radius_ : this->Body_.EastRadius((1.0 - q) / (1.0 + q));
    return 2.0 * radius * this->PlaneStep_ / (1.0 + q);
  }
  const double latitude = this->First_.y() + post.y() * this->Step_.y();
  if (!this->Body_.Spherical()) {
    const double sine = std::sin(latitude);
    return std::max(this->Body_.EastRadius(sine) * std::abs(this->Step_.x() * std::cos(latitude)),
                    this->Body_.NorthRadius(sine) * std::abs(this->Step_.y()));
  }
  return this->Radius_ *
         std::max(std::abs(this->Step_.x() * std::cos(latitude)), std::abs(this->Step_.y()));
}

} // namespace dspace
