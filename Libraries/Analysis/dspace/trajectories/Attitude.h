// How a craft is turned at each time.
#ifndef DSPACE_TRAJECTORIES_ATTITUDE_H
#define DSPACE_TRAJECTORIES_ATTITUDE_H

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/trajectories/MovingFrame.h>

namespace dspace {

// q_FB: takes components in the body's frame B to those in a reference frame F. Immutable.
class Attitude {
public:
  virtual ~Attitude() = default;
  virtual TimeSpan Span() const = 0;
  // Throws Error(InvalidArgument) outside the span, and where a rule has no direction.
  virtual Eigen::Quaterniond At(double time_s) const = 0;
};

using AttitudePtr = std::shared_ptr<const Attitude>;

// A rule of two directions: the primary axis of B points exactly along its direction, the secondary
// one as nearly along its own as the primary one lets it.
struct PointingRule {
  enum class Direction { Nadir, Velocity, OrbitNormal, Sun };
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ(); // of B; any length
  Direction direction = Direction::Nadir;
  Eigen::Vector3d secondaryAxis = Eigen::Vector3d::UnitX(); // not along `axis`
  Direction secondaryDirection = Direction::Velocity;
};

class RuleAttitude : public Attitude {
public:
  // From the craft to the Sun at a time, in F [any length].
  using SunDirection = std::function<Eigen::Vector3d(double time_s, const Eigen::Vector3d& p_F)>;
  // `craft`: in F about the centre that nadir is towards. Throws Error(InvalidArgument) naming
  // `name`: axes that are zero or parallel, equal directions, the Sun without `sun`.
  RuleAttitude(std::string name, TrajectoryPtr craft, const PointingRule& rule,
               SunDirection sun = {});
  TimeSpan Span() const override { return this->Craft_->Span(); }
  Eigen::Quaterniond At(double time_s) const override;

private:
  Eigen::Vector3d Towards(PointingRule::Direction direction, double time_s,
                          const State& state) const;
  std::string Name_;
  TrajectoryPtr Craft_;
  PointingRule Rule_;
  SunDirection Sun_;
};

// Quaternions at times; between two of them the turn about a fixed axis at constant rate, the
// shorter way (slerp).
class TableAttitude : public Attitude {
public:
  // Scalar first (w, x, y, z), unit within 1e-6. Throws Error(InvalidArgument) naming `name` and
  // the value: times that do not ascend, other numbers of quaternions than times, none.
  TableAttitude(std::string name, std::vector<double> times,
                std::vector<Eigen::Quaterniond> rotations);
  TimeSpan Span() const override { return {this->Times_.front(), this->Times_.back()}; }
  Eigen::Quaterniond At(double time_s) const override;

private:
  std::string Name_;
  std::vector<double> Times_;
  std::vector<Eigen::Quaterniond> Rotations_;
};

// The frame of a craft: where its trajectory is, turned as its attitude says.
class CraftFrame : public MovingFrame {
public:
  CraftFrame(TrajectoryPtr craft, AttitudePtr attitude)
      : Craft_(std::move(craft)), Attitude_(std::move(attitude)) {}
  TimeSpan Span() const override { return Common(this->Craft_->Span(), this->Attitude_->Span()); }
  FramePlace At(double time_s) const override;

private:
  TrajectoryPtr Craft_;
  AttitudePtr Attitude_;
};

} // namespace dspace

#endif
