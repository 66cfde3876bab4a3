// Frames that move with what is in them: rotating with two bodies, turning with a body, or with the
// local vertical of a craft.
#ifndef DSPACE_TRAJECTORIES_MOVING_FRAME_H
#define DSPACE_TRAJECTORIES_MOVING_FRAME_H

#include <functional>
#include <string>

#include <Eigen/Geometry>

#include <dspace/trajectories/Trajectory.h>

namespace dspace {

// A frame M in the reference frame F of a trajectory, about its centre, at one time.
struct FramePlace {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();        // p_FM [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();        // of M's origin in F [m/s]
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();    // q_FM: takes components in M to F's
  Eigen::Vector3d angularVelocity = Eigen::Vector3d::Zero(); // of M in F, in F's axes [rad/s]

  // The state in M, with the velocity that an observer who turns with M sees.
  State FromReference(const State& state_F) const;
};

// Immutable: several threads may use one.
class MovingFrame {
public:
  virtual ~MovingFrame() = default;
  virtual TimeSpan Span() const = 0;
  // Throws Error(InvalidArgument) outside the span, and where an axis has no direction.
  virtual FramePlace At(double time_s) const = 0;
};

using MovingFramePtr = std::shared_ptr<const MovingFrame>;

// X points from the first body to the second, Z along the angular momentum of the second about the
// first. Its angular velocity includes the turning of the plane, from differences of velocities.
class TwoBodyFrame : public MovingFrame {
public:
  // `first` and `second` are trajectories in F about its centre; null: the centre itself. `share`
  // [0, 1]: the origin, from the first body (0) towards the second: the second's share of the mass
  // for the barycentre. Throws Error(InvalidArgument) for a share out of range, or no body at all.
  TwoBodyFrame(std::string name, TrajectoryPtr first, TrajectoryPtr second, double share);
  TimeSpan Span() const override;
  FramePlace At(double time_s) const override;

private:
  State Between(double time_s) const;
  std::string Name_;
  TrajectoryPtr First_;
  TrajectoryPtr Second_;
  double Share_;
};

// Of a craft about the centre of F.
class LocalFrame : public MovingFrame {
public:
  enum class Axes {
    Lvlh,     // Z down to the centre, Y against the angular momentum, X completes: forward
    Rtn,      // X up from the centre, Z along the angular momentum, Y completes: forward
    Velocity, // X along the velocity, Z along the angular momentum, Y completes: towards the centre
    Reference // those of F
  };
  LocalFrame(std::string name, TrajectoryPtr craft, Axes axes);
  TimeSpan Span() const override { return this->Craft_->Span(); }
  FramePlace At(double time_s) const override;

private:
  std::string Name_;
  TrajectoryPtr Craft_;
  Axes Axes_;
};

// Turns about the centre of F, or about a body that moves in F.
class TurningFrame : public MovingFrame {
public:
  // The rotation q_FM at a time; its span.
  using Turn = std::function<Eigen::Matrix3d(double time_s)>;
  // `body`: where the origin is; null: the centre of F.
  TurningFrame(std::string name, TrajectoryPtr body, Turn turn, TimeSpan span);
  TimeSpan Span() const override;
  FramePlace At(double time_s) const override;

private:
  std::string Name_;
  TrajectoryPtr Body_;
  Turn Turn_;
  TimeSpan Span_;
};

// A trajectory as seen in a moving frame.
class RelativeTrajectory : public Trajectory {
public:
  RelativeTrajectory(TrajectoryPtr trajectory, MovingFramePtr frame)
      : Trajectory_(std::move(trajectory)), Frame_(std::move(frame)) {}
  TimeSpan Span() const override;
  std::vector<TimeSpan> Parts() const override;
  State At(double time_s) const override;

private:
  TrajectoryPtr Trajectory_;
  MovingFramePtr Frame_;
};

TimeSpan Common(const TimeSpan& a, const TimeSpan& b);

} // namespace dspace

#endif
