// Where something is at each time.
#ifndef DSPACE_TRAJECTORIES_TRAJECTORY_H
#define DSPACE_TRAJECTORIES_TRAJECTORY_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/kernels/State.h>

namespace dspace {

// Inclusive. Times are TDB seconds past J2000, or those of any other clock that does not stop.
struct TimeSpan {
  double begin = 0.0; // [s]
  double end = 0.0;
};

// States [m, m/s] in some frame F about some centre. Immutable: several threads may use one.
class Trajectory {
public:
  virtual ~Trajectory() = default;
  // When its states are known, infinite at an open end.
  virtual TimeSpan Span() const = 0;
  // The parts of the span within which it is known and smooth, ascending: the blocks of a file. Two
  // that touch share a time, at which the velocity may jump.
  virtual std::vector<TimeSpan> Parts() const { return {this->Span()}; }
  // Throws Error(InvalidArgument) naming the trajectory, the time and what is accepted, outside the
  // span and within gaps of it.
  virtual State At(double time_s) const = 0;
};

using TrajectoryPtr = std::shared_ptr<const Trajectory>;

// Throws Error(InvalidArgument) naming `object`, for a time outside `span` or not finite.
void RequireInSpan(const std::string& object, double time_s, const TimeSpan& span);

} // namespace dspace

#endif
