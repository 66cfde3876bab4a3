// The times of a recording's steps, and the rule that selects the step for a time.
#ifndef DSPACE_SESSION_STEP_TIMES_H
#define DSPACE_SESSION_STEP_TIMES_H

#include <cstddef>
#include <optional>
#include <vector>

namespace dspace::session {

// Times may go back when a simulation is reset. A run is a range of steps whose times do not
// decrease.
class StepTimes {
public:
  StepTimes() = default;
  explicit StepTimes(std::vector<double> times_s); // of each step [s]

  const std::vector<double>& Times() const { return this->Times_; }

  // The step for a time [s]: the last one that is not later, within rounding, in the latest run
  // that reaches the time, else in the latest run that begins before it. A step at exactly this
  // time has priority. None before the first step.
  std::optional<std::size_t> IndexAt(double time_s) const;

  // Whether a step is at a time [s] within rounding. At the ends of a run, rounding depends on the
  // only neighbour. A single step may differ by two spacings of doubles.
  bool IsAt(std::size_t index, double time_s) const;

  // Whether a step is later than a time [s] by more than rounding. NaN is before all steps.
  bool IsAfter(std::size_t index, double time_s) const;

  // The largest difference between the recorded time [s] of a step and a requested time that
  // selects it: the times of a simulation that adds up its steps drift. step_s: distance to the
  // nearest step on the side of the requested time. The result is step_s / 1000, at most 0.1 ms, at
  // least two spacings of doubles at that time, and at most step_s / 2.
  static double Rounding(double time_s, double step_s);

private:
  std::optional<double> Distance(std::size_t index, int direction) const;

  std::vector<double> Times_;
  std::vector<std::size_t> Runs_; // index of the first step of each
};

} // namespace dspace::session

#endif
