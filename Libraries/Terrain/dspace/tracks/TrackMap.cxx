#include <dspace/tracks/TrackMap.h>

#include <algorithm>
#include <cmath>

#include <dspace/tracks/WheelTracks.h>

namespace dspace {
namespace {

constexpr double Margin = 1.05; // of angles on the sphere for those of verticals of an ellipsoid
constexpr double Slack = 1e-9;  // [rad] for rounding

Eigen::AlignedBox2d Corners(const Eigen::Affine2d& map, const Eigen::AlignedBox2d& of) {
  Eigen::AlignedBox2d box;
  for (int i = 0; i < 4; ++i) {
    box.extend(map * of.corner(Eigen::AlignedBox2d::CornerType(i)));
  }
  return box;
}

} // namespace

Eigen::Vector3d TrackMap::UpOf(const Eigen::Vector2d& angles) {
  const double c = std::cos(angles.y());
  return {c * std::cos(angles.x()), c * std::sin(angles.x()), std::sin(angles.y())};
}

std::optional<TrackMap> TrackMap::Of(const PostPlacement& placement, const WheelTracks& tracks) {
  std::shared_ptr<const TrackChart> chart = placement.OnBody() ? tracks.Chart() : nullptr;
  if (placement.OnBody() && !chart) {
    return std::nullopt;
  }
  return TrackMap(placement, std::move(chart));
}

Eigen::Vector3d TrackMap::UpAt(const Eigen::Vector2d& post) const {
  return UpOf(this->Placement_.Angles(post));
}

Eigen::Vector2d TrackMap::ToTracks(const Eigen::Vector2d& post) const {
  return this->Chart_ ? this->Chart_->ToChart(this->UpAt(post))
                      : Eigen::Vector2d(this->Placement_.PostToScene() * post);
}

double TrackMap::Scale(const Eigen::Vector2d& post, double height) const {
  if (!this->Chart_) {
    return 1.0;
  }
  const Eigen::Vector3d up = this->UpAt(post);
  const double radius = this->Placement_.Body().EastRadius(up.z());
  return this->Chart_->Scale(up) / std::max(1.0 + height / radius, 1.0 / TrackChart::Widest);
}

Eigen::AlignedBox2d TrackMap::BoxOf(const Eigen::AlignedBox2d& posts) const {
  if (!this->Chart_) {
    return Corners(this->Placement_.PostToScene(), posts);
  }
  const Eigen::Vector2d half = 0.5 * posts.diagonal();
  const Eigen::Vector2d middle = posts.center();
  Eigen::Vector3d up = this->UpAt(middle);
  double angle = 0.0;
  if (this->Placement_.GetKind() == PostPlacement::Kind::Pole) {
    angle = 2.0 * this->Placement_.PlaneStep() * half.norm();
  } else {
    // Along the middle's parallel, then along a meridian.
    const Eigen::Vector2d& step = this->Placement_.Step();
    angle = half.x() * std::abs(step.x()) * up.head<2>().norm() + half.y() * std::abs(step.y());
  }
  return this->Chart_->BoxOf(this->Chart_->ToSphere(up), Margin * angle + Slack);
}

Eigen::AlignedBox2d TrackMap::PostsIn(const Eigen::AlignedBox2d& box, double column) const {
  if (!this->Chart_) {
    return Corners(this->Placement_.SceneToPost(), box);
  }
  const Eigen::Vector3d up = this->Chart_->ToUp(box.center());
  const double angle = Margin * this->Chart_->AngleOf(box) + Slack;
  const PostPlacement& placement = this->Placement_;
  if (placement.GetKind() == PostPlacement::Kind::Pole) {
    // The image of a circle is a circle.
    const Eigen::Vector3d d = placement.ToChart(up);
    const double aside = d.head<2>().norm();
    const double distance = std::atan2(aside, d.z());
    const double far = std::tan(0.5 * std::min(distance + angle, 3.1));
    const double near = std::tan(0.5 * (distance - angle));
    const Eigen::Vector2d way =
        aside > 0.0 ? Eigen::Vector2d(d.head<2>() / aside) : Eigen::Vector2d::UnitX();
    const Eigen::Vector2d half =
        Eigen::Vector2d::Constant(0.5 * (far - near) / placement.PlaneStep());
    const Eigen::Vector2d middle = placement.PostOnPlane(0.5 * (near + far) * way);
    return {middle - half, middle + half};
  }
  const double latitude = std::atan2(up.z(), up.head<2>().norm());
  const double longitude = std::atan2(up.y(), up.x());
  const double turn = 2.0 * M_PI / std::abs(placement.Step().x());
  const double sine = std::sin(angle) / std::max(std::cos(latitude), 1e-300);
  const bool around = std::abs(latitude) + angle >= 0.5 * M_PI || sine >= 1.0;
  double c = (longitude - placement.First().x()) / placement.Step().x();
  c += turn * std::round((column - c) / turn);
  const double across = around ? 0.5 * turn : std::asin(sine) / std::abs(placement.Step().x());
  const double r = (latitude - placement.First().y()) / placement.Step().y();
  const double along = angle / std::abs(placement.Step().y());
  if (around) {
    c = column;
  }
  return {Eigen::Vector2d(c - across, r - along), Eigen::Vector2d(c + across, r + along)};
}

} // namespace dspace
