#include <dspace/trajectories/Attitude.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <dspace/Checks.h>

namespace dspace {
namespace {

// The axes of two directions: the first, the normal of both, and what completes them. A zero normal
// where they are parallel.
Eigen::Matrix3d Triad(const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  Eigen::Matrix3d axes;
  const Eigen::Vector3d x = first.normalized();
  const Eigen::Vector3d z = x.cross(second.normalized());
  axes << x, z.cross(x), z;
  return axes;
}

// Sine of the least angle between directions that tell a plane.
constexpr double Parallel = 1e-9;

bool Orthonormalize(Eigen::Matrix3d& axes) {
  const double sine = axes.col(2).norm();
  if (!(sine > Parallel)) {
    return false;
  }
  axes.col(1) /= sine;
  axes.col(2) /= sine;
  return true;
}

} // namespace

RuleAttitude::RuleAttitude(std::string name, TrajectoryPtr craft, const PointingRule& rule,
                           SunDirection sun)
    : Name_(std::move(name)), Craft_(std::move(craft)), Rule_(rule), Sun_(std::move(sun)) {
  RequireFinite(this->Name_, "the primary axis", rule.axis);
  RequireFinite(this->Name_, "the secondary axis", rule.secondaryAxis);
  Eigen::Matrix3d axes = Triad(rule.axis, rule.secondaryAxis);
  if (!Orthonormalize(axes)) {
    Reject(this->Name_, "its axes " + VectorText(rule.axis) + " and " +
                            VectorText(rule.secondaryAxis) +
                            " are zero or parallel; accepted: two different axes");
  }
  if (rule.direction == rule.secondaryDirection) {
    Reject(this->Name_, "its two directions are the same; accepted: two different ones");
  }
  const auto sunlit = PointingRule::Direction::Sun;
  if ((rule.direction == sunlit || rule.secondaryDirection == sunlit) && !this->Sun_) {
    Reject(this->Name_,
           "the direction of the Sun is not known; accepted: trajectories about a body of "
           "the ephemeris");
  }
}

Eigen::Vector3d RuleAttitude::Towards(PointingRule::Direction direction, double time_s,
                                      const State& state) const {
  switch (direction) {
  case PointingRule::Direction::Nadir:
    return -state.position;
  case PointingRule::Direction::Velocity:
    return state.velocity;
  case PointingRule::Direction::OrbitNormal:
    return state.position.cross(state.velocity);
  default:
    return this->Sun_(time_s, state.position);
  }
}

Eigen::Quaterniond RuleAttitude::At(double time_s) const {
  const State state = this->Craft_->At(time_s);
  const Eigen::Vector3d first = this->Towards(this->Rule_.direction, time_s, state);
  const Eigen::Vector3d second = this->Towards(this->Rule_.secondaryDirection, time_s, state);
  Eigen::Matrix3d reference = Triad(first, second);
  Eigen::Matrix3d body = Triad(this->Rule_.axis, this->Rule_.secondaryAxis);
  Orthonormalize(body); // checked
  if (!(first.norm() > 0.0) || !(second.norm() > 0.0) || !Orthonormalize(reference)) {
    Reject(this->Name_, "at " + NumberText(time_s) +
                            " s past J2000 its two directions are zero or "
                            "parallel; accepted: times at which they tell a plane");
  }
  return Eigen::Quaterniond(Eigen::Matrix3d(reference * body.transpose())).normalized();
}

TableAttitude::TableAttitude(std::string name, std::vector<double> times,
                             std::vector<Eigen::Quaterniond> rotations)
    : Name_(std::move(name)), Times_(std::move(times)), Rotations_(std::move(rotations)) {
  if (this->Times_.empty() || this->Times_.size() != this->Rotations_.size()) {
    Reject(this->Name_, "it has " + std::to_string(this->Times_.size()) + " times and " +
                            std::to_string(this->Rotations_.size()) +
                            " quaternions; accepted: as many of each, one and more");
  }
  for (std::size_t i = 0; i < this->Times_.size(); ++i) {
    RequireFinite(this->Name_, "a time", this->Times_[i]);
    if (i > 0 && this->Times_[i] <= this->Times_[i - 1]) {
      Reject(this->Name_, "time " + std::to_string(i + 1) + " is " + NumberText(this->Times_[i]) +
                              " s; accepted: ascending times");
    }
    const double norm = this->Rotations_[i].norm();
    Require(std::abs(norm - 1.0) <= 1e-6, this->Name_, "the length of a quaternion", norm,
            "1 within 1e-6");
    this->Rotations_[i].normalize();
  }
}

Eigen::Quaterniond TableAttitude::At(double time_s) const {
  RequireInSpan(this->Name_, time_s, this->Span());
  const auto after = std::upper_bound(this->Times_.begin(), this->Times_.end(), time_s);
  const auto i = std::size_t(after - this->Times_.begin()) - 1;
  if (after == this->Times_.end()) {
    return this->Rotations_.back();
  }
  const double share = (time_s - this->Times_[i]) / (this->Times_[i + 1] - this->Times_[i]);
  return this->Rotations_[i].slerp(share, this->Rotations_[i + 1]);
}

FramePlace CraftFrame::At(double time_s) const {
  const State state = this->Craft_->At(time_s);
  FramePlace place;
  place.position = state.position;
  place.velocity = state.velocity;
  place.rotation = this->Attitude_->At(time_s).toRotationMatrix();
  const TimeSpan span = this->Span();
  const double before = std::max(time_s - 0.5, span.begin);
  const double after = std::min(time_s + 0.5, span.end);
  if (after > before) {
    const Eigen::AngleAxisd turn(this->Attitude_->At(after) *
                                 this->Attitude_->At(before).conjugate());
    const double angle = std::remainder(turn.angle(), 2.0 * M_PI);
    place.angularVelocity = turn.axis() * (angle / (after - before));
  }
  return place;
}

} // namespace dspace
