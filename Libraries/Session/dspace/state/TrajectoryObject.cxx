#include <dspace/state/TrajectoryObject.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/trajectories/Orbit.h>

namespace dspace::session {
namespace {

constexpr std::size_t OrbitPointCount = 721; // every half degree of a circle

} // namespace

double NearestTime(const std::vector<TimeSpan>& parts, double time_s) {
  double nearest = parts.empty() ? time_s : parts.front().begin;
  for (const TimeSpan& part : parts) {
    const double inside = std::clamp(time_s, part.begin, part.end);
    if (std::abs(inside - time_s) < std::abs(nearest - time_s)) {
      nearest = inside;
    }
  }
  return nearest;
}

TrajectoryObject::TrajectoryObject(std::string label, TrajectorySource source, MovingFramePtr axes,
                                   std::shared_ptr<TrajectoryLine> line, Osculating osculating)
    : Label_(std::move(label)), Source_(std::move(source)), Axes_(std::move(axes)),
      Shown_(this->Axes_ ? std::make_shared<RelativeTrajectory>(this->Source_.path, this->Axes_)
                         : this->Source_.path),
      Line_(std::move(line)), Osculating_(osculating) {}

std::vector<TrajectoryLine::Strip>
TrajectoryObject::ConicAt(const std::string& label, const Trajectory& path, const MovingFrame* axes,
                          const Osculating& look, double time_s) {
  const dspace::State state = path.At(time_s);
  const OrbitalElements elements = ElementsOf(state, look.mu, label);
  const double farthest = look.farthest > 0.0 ? look.farthest : 10.0 * state.position.norm();
  TrajectoryLine::Strip strip;
  strip.points = OrbitPoints(elements, OrbitPointCount, farthest, label);
  if (axes) {
    const FramePlace place = axes->At(time_s);
    for (Eigen::Vector3d& p : strip.points) {
      p = place.FromReference({p, Eigen::Vector3d::Zero()}).position;
    }
  }
  for (std::size_t i = 0; i < strip.points.size(); ++i) {
    strip.times.push_back(double(i)); // in their order: the look does not follow the time
  }
  return {strip};
}

std::string TrajectoryObject::SetTime(double time_s) {
  if (!this->IsOsculating()) {
    try {
      this->Line_->SetTime(time_s);
    } catch (const Error& error) {
      return std::string(error.what()) + "; its line has only its own points";
    }
    return {};
  }
  const double at = NearestTime(this->Shown_->Parts(), time_s);
  try {
    this->Line_->SetStrips(this->Label_, ConicAt(this->Label_, *this->Source_.path,
                                                 this->Axes_.get(), this->Osculating_, at));
  } catch (const Error& error) {
    return std::string(error.what()) + "; its orbit is drawn as it was";
  }
  return at == time_s ? std::string()
                      : this->Label_ + ": no state is known at " + NumberText(time_s) +
                            " s; its orbit is that of " + NumberText(at) + " s";
}

void TrajectoryObject::Follow(FrameId frame, const Pose& before, AttitudePtr attitude) {
  this->Follower_ = frame;
  this->PoseBefore_ = before;
  this->Attitude_ = std::move(attitude);
}

Pose TrajectoryObject::FollowerPose(double time_s, std::string& warning) const {
  std::vector<TimeSpan> parts = this->Shown_->Parts();
  if (this->Attitude_) {
    for (TimeSpan& part : parts) {
      part = Common(part, this->Attitude_->Span());
    }
    parts.erase(std::remove_if(parts.begin(), parts.end(),
                               [](const TimeSpan& part) { return !(part.begin <= part.end); }),
                parts.end());
  }
  const double at = NearestTime(parts, time_s);
  if (at != time_s) {
    warning = this->Label_ + ": no state or attitude is known at " + NumberText(time_s) +
              " s; the frame that follows it is where it is at " + NumberText(at) + " s";
  }
  Pose X_OB;
  X_OB.position = this->Shown_->At(at).position;
  if (this->Attitude_) {
    const Eigen::Quaterniond q_FB = this->Attitude_->At(at);
    const Eigen::Matrix3d R_FO =
        this->Axes_ ? this->Axes_->At(at).rotation : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    X_OB.rotation = (Eigen::Quaterniond(Eigen::Matrix3d(R_FO.transpose())) * q_FB).normalized();
  }
  return X_OB;
}

} // namespace dspace::session
