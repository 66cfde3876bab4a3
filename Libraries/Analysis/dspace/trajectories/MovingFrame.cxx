#include <dspace/trajectories/MovingFrame.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr TimeSpan Always = {-std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::infinity()};

Eigen::Vector3d Direction(const Eigen::Vector3d& v, const std::string& object, const char* what) {
  const double length = v.norm();
  if (!(length > 0.0)) {
    Reject(object, std::string(what) + " has no direction; accepted: times at which it has one");
  }
  return v / length;
}

Eigen::Matrix3d Axes(const Eigen::Vector3d& x, const Eigen::Vector3d& y, const Eigen::Vector3d& z) {
  Eigen::Matrix3d axes;
  axes << x, y, z;
  return axes;
}

// Two times about `time_s` within the span, for differences.
std::pair<double, double> About(double time_s, double step, const TimeSpan& span) {
  return {std::max(time_s - step, span.begin), std::min(time_s + step, span.end)};
}

// From the rotations at two times: the axis and angle of what turns one into the other.
Eigen::Vector3d RateBetween(const Eigen::Matrix3d& before, const Eigen::Matrix3d& after,
                            double dt) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(after * before.transpose()));
  return dt > 0.0 ? Eigen::Vector3d(turn.axis() * (turn.angle() / dt)) : Eigen::Vector3d::Zero();
}

State StateAt(const TrajectoryPtr& body, double time_s) {
  return body ? body->At(time_s) : State();
}

} // namespace

TimeSpan Common(const TimeSpan& a, const TimeSpan& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

State FramePlace::FromReference(const State& state_F) const {
  const Eigen::Vector3d p = state_F.position - this->position;
  const Eigen::Vector3d v = state_F.velocity - this->velocity - this->angularVelocity.cross(p);
  return {this->rotation.transpose() * p, this->rotation.transpose() * v};
}

TwoBodyFrame::TwoBodyFrame(std::string name, TrajectoryPtr first, TrajectoryPtr second,
                           double share)
    : Name_(std::move(name)), First_(std::move(first)), Second_(std::move(second)), Share_(share) {
  RequireFraction(this->Name_, "the place of its origin between the bodies", share);
  if (!this->First_ && !this->Second_) {
    Reject(this->Name_, "both of its bodies are the centre; accepted: two that are apart");
  }
}

TimeSpan TwoBodyFrame::Span() const {
  return Common(this->First_ ? this->First_->Span() : Always,
                this->Second_ ? this->Second_->Span() : Always);
}

State TwoBodyFrame::Between(double time_s) const {
  const State first = StateAt(this->First_, time_s);
  const State second = StateAt(this->Second_, time_s);
  return {second.position - first.position, second.velocity - first.velocity};
}

FramePlace TwoBodyFrame::At(double time_s) const {
  RequireInSpan(this->Name_, time_s, this->Span());
  const State first = StateAt(this->First_, time_s);
  const State between = this->Between(time_s);
  const Eigen::Vector3d& r = between.position;
  const Eigen::Vector3d h = r.cross(between.velocity);
  const Eigen::Vector3d x = Direction(r, this->Name_, "the line between its bodies");
  const Eigen::Vector3d z = Direction(h, this->Name_, "the angular momentum of its bodies");
  FramePlace place;
  place.position = first.position + this->Share_ * r;
  place.velocity = first.velocity + this->Share_ * between.velocity;
  place.rotation = Axes(x, z.cross(x), z);
  // About Z by the motion in the plane, about X by what accelerates it out of the plane.
  const double period = 2.0 * M_PI * r.squaredNorm() / h.norm();
  const auto [before, after] = About(time_s, 1e-5 * period, this->Span());
  double turning = 0.0;
  if (after > before) {
    const Eigen::Vector3d acceleration =
        (this->Between(after).velocity - this->Between(before).velocity) / (after - before);
    turning = acceleration.dot(z) * r.norm() / h.norm();
  }
  place.angularVelocity = h / r.squaredNorm() + turning * x;
  return place;
}

LocalFrame::LocalFrame(std::string name, TrajectoryPtr craft, Axes axes)
    : Name_(std::move(name)), Craft_(std::move(craft)), Axes_(axes) {
  if (!this->Craft_) {
    Reject(this->Name_, "it has no craft; accepted: a trajectory");
  }
}

FramePlace LocalFrame::At(double time_s) const {
  const auto axesOf = [this](const State& state) -> Eigen::Matrix3d {
    if (this->Axes_ == Axes::Reference) {
      return Eigen::Matrix3d::Identity();
    }
    const Eigen::Vector3d up = Direction(state.position, this->Name_, "the local vertical");
    const Eigen::Vector3d h =
        Direction(state.position.cross(state.velocity), this->Name_, "the angular momentum");
    switch (this->Axes_) {
    case Axes::Lvlh:
      return dspace::Axes(h.cross(up), -h, -up);
    case Axes::Rtn:
      return dspace::Axes(up, h.cross(up), h);
    default: {
      const Eigen::Vector3d forward = state.velocity.normalized();
      return dspace::Axes(forward, h.cross(forward), h);
    }
    }
  };
  const State state = this->Craft_->At(time_s);
  FramePlace place;
  place.position = state.position;
  place.velocity = state.velocity;
  place.rotation = axesOf(state);
  if (this->Axes_ != Axes::Reference) {
    const double rate = state.position.cross(state.velocity).norm() / state.position.squaredNorm();
    const auto [before, after] = About(time_s, 1e-3 / rate, this->Span());
    place.angularVelocity = RateBetween(axesOf(this->Craft_->At(before)),
                                        axesOf(this->Craft_->At(after)), after - before);
  }
  return place;
}

TurningFrame::TurningFrame(std::string name, TrajectoryPtr body, Turn turn, TimeSpan span)
    : Name_(std::move(name)), Body_(std::move(body)), Turn_(std::move(turn)), Span_(span) {}

TimeSpan TurningFrame::Span() const {
  return this->Body_ ? Common(this->Span_, this->Body_->Span()) : this->Span_;
}

FramePlace TurningFrame::At(double time_s) const {
  RequireInSpan(this->Name_, time_s, this->Span());
  const State body = StateAt(this->Body_, time_s);
  FramePlace place;
  place.position = body.position;
  place.velocity = body.velocity;
  place.rotation = this->Turn_(time_s);
  const auto [before, after] = About(time_s, 1.0, this->Span());
  place.angularVelocity = RateBetween(this->Turn_(before), this->Turn_(after), after - before);
  return place;
}

TimeSpan RelativeTrajectory::Span() const {
  return Common(this->Trajectory_->Span(), this->Frame_->Span());
}

std::vector<TimeSpan> RelativeTrajectory::Parts() const {
  std::vector<TimeSpan> parts;
  for (const TimeSpan& part : this->Trajectory_->Parts()) {
    const TimeSpan common = Common(part, this->Frame_->Span());
    if (common.begin <= common.end) {
      parts.push_back(common);
    }
  }
  return parts;
}

State RelativeTrajectory::At(double time_s) const {
  return this->Frame_->At(time_s).FromReference(this->Trajectory_->At(time_s));
}

} // namespace dspace
