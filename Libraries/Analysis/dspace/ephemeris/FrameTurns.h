// Turns between the reference frames that states are given in.
#ifndef DSPACE_ANALYSIS_FRAME_TURNS_H
#define DSPACE_ANALYSIS_FRAME_TURNS_H

#include <string>

#include <Eigen/Core>

#include <dspace/kernels/State.h>

namespace dspace {

constexpr int FrameJ2000 = 1; // NAIF's ids
constexpr int FrameEclipJ2000 = 17;

// From one frame's components to another's: position' = rotation position,
// velocity' = rotation velocity + rate position.
struct StateTurn {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d rate = Eigen::Matrix3d::Zero(); // d(rotation)/dt [1/s]

  State operator*(const State& state) const {
    return {this->rotation * state.position,
            this->rotation * state.velocity + this->rate * state.position};
  }
  // The turn back.
  StateTurn Inverse() const { return {this->rotation.transpose(), this->rate.transpose()}; }
  // First `other`, then this.
  StateTurn operator*(const StateTurn& other) const {
    return {this->rotation * other.rotation,
            this->rate * other.rotation + this->rotation * other.rate};
  }
};

// Implemented by the room `orientation` for all frames. Ids are NAIF's frame ids: 1 J2000,
// 17 ECLIPJ2000. Immutable, and called by several threads.
class FrameTurns {
public:
  virtual ~FrameTurns() = default;
  // The id of a frame: "J2000", "IAU_MOON". Throws Error(NotFound) with names that are accepted.
  virtual int FrameId(const std::string& name) const = 0;
  // "frame 13" where it has no name.
  virtual std::string FrameName(int frame) const = 0;
  // Whether the frame does not turn with time against J2000.
  virtual bool IsInertial(int frame) const = 0;
  // The body at the frame's origin (NAIF id); its light time delays the frame's orientation.
  virtual int Center(int frame) const = 0;
  // Throws Error(NotFound) for an unknown frame, Error(InvalidArgument) for a time without data.
  virtual StateTurn Turn(int from, int to, double tdb) const = 0;
};

// J2000 and ECLIPJ2000 alone.
class InertialTurns final : public FrameTurns {
public:
  int FrameId(const std::string& name) const override;
  std::string FrameName(int frame) const override;
  bool IsInertial(int frame) const override;
  int Center(int frame) const override;
  StateTurn Turn(int from, int to, double tdb) const override;
};

} // namespace dspace

#endif
