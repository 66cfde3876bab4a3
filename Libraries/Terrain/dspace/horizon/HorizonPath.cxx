#include <dspace/horizon/HorizonPath.h>

#include <algorithm>
#include <cmath>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;

} // namespace

ChartDirection ChartDirectionAt(const PostPlacement& placement, const Eigen::Vector2d& post,
                                const Eigen::Vector3d& direction_S) {
  const ChartAxes axes = ChartAxesAt(placement, post);
  const double east = axes.east.dot(direction_S);
  const double north = axes.north.dot(direction_S);
  const double azimuth = std::atan2(east, north) / Degree;
  return {azimuth < 0.0 ? azimuth + 360.0 : azimuth,
          std::atan2(axes.up.dot(direction_S), std::hypot(east, north)) / Degree};
}

HorizonPath::HorizonPath(const PostPlacement& placement, const Eigen::Vector2d& post,
                         double azimuth_deg)
    : Placement_(placement), Post_(post) {
  const double east = std::sin(azimuth_deg * Degree);
  const double north = std::cos(azimuth_deg * Degree);
  const ChartAxes axes = ChartAxesAt(placement, post);
  this->Up_ = axes.up;
  this->Along_ = east * axes.east + north * axes.north;
  this->AlongNormals_ = this->Along_;
  if (placement.GetKind() == PostPlacement::Kind::Plane) {
    this->PerMetre_ = placement.SceneToPost().linear() * Eigen::Vector2d(east, north);
    return;
  }
  const double longitude = placement.Angles(post).x();
  this->Meridian_ = {std::cos(longitude), std::sin(longitude)};
  const BodyEllipsoid& body = placement.Body();
  if (!body.Spherical()) {
    this->Foot_ = body.Point(this->Up_, 0.0);
    // A metre to the east turns the vertical by another angle than one to the north.
    const double sine = this->Up_.z();
    const Eigen::Vector3d toPole = Eigen::Vector3d::UnitZ() - sine * this->Up_;
    if (toPole.norm() > 1e-9) {
      const Eigen::Vector3d trueNorth = toPole.normalized();
      const double alongNorth = this->Along_.dot(trueNorth);
      this->AlongNormals_ = ((this->Along_ - alongNorth * trueNorth) / body.EastRadius(sine) +
                             alongNorth * trueNorth / body.NorthRadius(sine))
                                .normalized();
    }
  }
}

HorizonPath::Point HorizonPath::At(double distance) const {
  if (this->Straight()) {
    return {this->Post_ + distance * this->PerMetre_, 0.0, 1.0, distance, 0.0};
  }
  const double radius = this->Placement_.Radius();
  const double angle = distance / radius;
  const double sine = std::sin(angle);
  const double half = std::sin(0.5 * angle);
  const double cosine = 1.0 - 2.0 * half * half;
  const Eigen::Vector3d vertical = cosine * this->Up_ + sine * this->AlongNormals_;
  Point point;
  if (this->Placement_.GetKind() == PostPlacement::Kind::Sphere) {
    const double latitude = std::atan2(vertical.z(), vertical.head<2>().norm());
    const double cl = this->Meridian_.x(), sl = this->Meridian_.y();
    const double east =
        std::atan2(cl * vertical.y() - sl * vertical.x(), cl * vertical.x() + sl * vertical.y());
    point.post = {this->Post_.x() + east / this->Placement_.Step().x(),
                  (latitude - this->Placement_.First().y()) / this->Placement_.Step().y()};
  } else {
    point.post = this->Placement_.PostTowards(this->Placement_.ToChart(vertical));
  }
  if (this->Placement_.Body().Spherical()) {
    point.fall = -2.0 * radius * half * half;
    point.rise = cosine;
    point.away = radius * sine;
    point.spread = sine;
    return point;
  }
  const Eigen::Vector3d apart = this->Placement_.Body().Point(vertical, 0.0) - this->Foot_;
  point.fall = apart.dot(this->Up_);
  point.rise = vertical.dot(this->Up_);
  point.away = apart.dot(this->Along_);
  point.spread = vertical.dot(this->Along_);
  return point;
}

// A chord of length d departs from a great circle that is p from the pole by d^2 / 8 p on the map
// of a degree grid, and by less on a pole's chart up to the equator.
double HorizonPath::FineStep(const Point& from, double s, double post) const {
  constexpr double Bow = 8.0 * 2e-5;
  double polar = this->Placement_.Radius();
  if (this->Placement_.GetKind() == PostPlacement::Kind::Sphere) {
    const double latitude = this->Placement_.Angles(from.post).y();
    polar *= std::abs(std::cos(latitude)) / std::max(std::abs(std::sin(latitude)), 1e-6);
  }
  // The pole may come nearer on the way.
  const double step = std::sqrt(Bow * std::max(s, 0.25 * post) * std::max(polar, 0.05 * post));
  return std::clamp(step, 0.01 * post, 8.0 * post);
}

} // namespace dspace
