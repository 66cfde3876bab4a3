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
  return OnPole(south, spacing, half, BodyEllipsoid(radius, radius));
}

PostPlacement PostPlacement::OnPole(bool south, double spacing, double half,
                                    const BodyEllipsoid& body) {
  return AtPole(south, 0.5 * spacing / body.Equatorial(), {half, half}, 0.0, body);
}

PostPlacement PostPlacement::AtPole(bool south, double planeStep, const Eigen::Vector2d& pole,
                                    double east_deg, const BodyEllipsoid& body) {
  const double radius = body.Equatorial();
  if (!(planeStep > 0.0 && std::isfinite(planeStep)) || !(radius > 0.0 && radius <= 1e12) ||
      !pole.allFinite() || !std::isfinite(east_deg)) {
    throw Error(Error::Kind::InvalidArgument, "terrain",
                "a spacing of more than 0 m and a radius in (0, 1e12] m are accepted");
  }
  PostPlacement placement;
  placement.Kind_ = Kind::Pole;
  placement.South_ = south;
  placement.PlaneStep_ = planeStep;
  placement.Pole_ = pole;
  // Quarters of a turn exactly: common maps have them.
  const double turns = std::remainder(east_deg, 360.0);
  placement.East_ = turns * Degree;
  placement.Turn_ = {std::cos(placement.East_), std::sin(placement.East_)};
  if (std::remainder(turns, 90.0) == 0.0) {
    placement.Turn_ = placement.Turn_.array().round();
  }
  placement.Radius_ = radius;
  placement.Body_ = body;
  return placement;
}

Eigen::Vector3d PostPlacement::FromChart(const Eigen::Vector3d& v_P) const {
  const double side = this->South_ ? -1.0 : 1.0;
  const Eigen::Vector2d v(v_P.x(), side * v_P.y());
  return {this->Turn_.x() * v.x() - this->Turn_.y() * v.y(),
          this->Turn_.y() * v.x() + this->Turn_.x() * v.y(), side * v_P.z()};
}

Eigen::Vector3d PostPlacement::ToChart(const Eigen::Vector3d& v_S) const {
  const double side = this->South_ ? -1.0 : 1.0;
  return {this->Turn_.x() * v_S.x() + this->Turn_.y() * v_S.y(),
          side * (this->Turn_.x() * v_S.y() - this->Turn_.y() * v_S.x()), side * v_S.z()};
}

Eigen::Vector2d PostPlacement::PostTowards(const Eigen::Vector3d& direction_P) const {
  const double length = direction_P.norm();
  const Eigen::Vector2d u =
      direction_P.head<2>() / std::max(length + direction_P.z(), 1e-9 * length);
  return this->PostOnPlane(u);
}

Eigen::Vector2d PostPlacement::Angles(const Eigen::Vector2d& post) const {
  if (this->Kind_ != Kind::Pole) {
    return this->First_ + post.cwiseProduct(this->Step_);
  }
  const Eigen::Vector2d u = this->OnPlaneOfPole(post);
  const double latitude = 0.5 * M_PI - 2.0 * std::atan(u.norm());
  const double longitude = std::atan2(this->South_ ? -u.y() : u.y(), u.x()) + this->East_;
  return {std::remainder(longitude, 2.0 * M_PI), this->South_ ? -latitude : latitude};
}

Eigen::Vector2d PostPlacement::PostAt(const Eigen::Vector2d& angles) const {
  if (this->Kind_ != Kind::Pole) {
    return (angles - this->First_).cwiseQuotient(this->Step_);
  }
  const double c = std::cos(angles.y());
  return this->PostTowards(
      this->ToChart({c * std::cos(angles.x()), c * std::sin(angles.x()), std::sin(angles.y())}));
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
    return this->FromChart(p);
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
    const Eigen::Vector2d post = this->PostTowards(this->ToChart(p_S));
    return {post.x(), post.y(), distance - this->Radius_};
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

// Posts (0, 0) to `last` of a pole's chart in which a scene coordinate of the sphere may be
// extreme: corners, the ends of the scene's axes, and places of the sides.
std::vector<Eigen::Vector2d> PostPlacement::ExtremesOf(const Eigen::Vector2d& last) const {
  std::vector<Eigen::Vector2d> posts;
  const auto take = [&](const Eigen::Vector2d& u) {
    const Eigen::Vector2d post = this->PostOnPlane(u);
    if ((post.array() >= 0.0).all() && (post.array() <= last.array()).all()) {
      posts.push_back(post);
    }
  };
  const Eigen::Vector2d x = this->ToChart(Eigen::Vector3d::UnitX()).head<2>();
  const Eigen::Vector2d y = this->ToChart(Eigen::Vector3d::UnitY()).head<2>();
  for (const Eigen::Vector2d& axis : {x, y}) {
    take(axis);
    take(-axis);
  }
  take(Eigen::Vector2d::Zero());
  for (int side = 0; side < 4; ++side) {
    const Eigen::Vector2d corner((side & 1) != 0 ? last.x() : 0.0,
                                 (side & 2) != 0 ? last.y() : 0.0);
    posts.push_back(corner);
    // Columns and rows are a + t b on the plane, with a the nearest to the pole.
    const Eigen::Vector2d b = Eigen::Vector2d::Unit(side == 0 || side == 3 ? 0 : 1);
    const Eigen::Vector2d at = this->OnPlaneOfPole(corner);
    const Eigen::Vector2d a = at - b * b.dot(at);
    const auto takeOfSide = [&](double t) { // rounding must not take it off the side
      posts.push_back(this->PostOnPlane(a + t * b).cwiseMax(0.0).cwiseMin(last));
    };
    const double one = 1.0 + a.squaredNorm();
    takeOfSide(0.0); // height over the equator
    for (const Eigen::Vector2d& axis : {x, y}) {
      // 2 (e a + t e b) / (1 + a^2 + t^2) is extreme where (e b) t^2 + 2 (e a) t - (e b) one = 0.
      const double ea = axis.dot(a), eb = axis.dot(b);
      const double root = std::sqrt(ea * ea + eb * eb * one);
      if (eb != 0.0) {
        takeOfSide((-ea + root) / eb);
        takeOfSide((-ea - root) / eb);
      } else {
        takeOfSide(0.0);
      }
    }
  }
  return posts;
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
  if (this->Kind_ == Kind::Pole) {
    for (const Eigen::Vector2d& post : this->ExtremesOf(last)) {
      extend(post);
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
