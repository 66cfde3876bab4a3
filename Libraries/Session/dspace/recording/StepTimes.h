// The times of a recording's steps, and the one rule for which step is at a time.
#ifndef DSPACE_SESSION_STEP_TIMES_H
#define DSPACE_SESSION_STEP_TIMES_H

#include <cstddef>
#include <optional>
#include <vector>

namespace dspace::session {

// Times may go back, where a simulation was reset: a run is a range of steps whose times do not.
class StepTimes {
public:
  StepTimes() = default;
  explicit StepTimes(std::vector<double> times_s); // of each step [s]

  const std::vector<double>& Times() const { return this->Times_; }

  // The last step that is not after a time [s], by no more than a rounding, of the latest run that
  // reaches the time, else of the latest that begins before it. None before all of them. A step at
  // the very time is before all others.
  std::optional<std::size_t> IndexAt(double time_s) const;

  // Whether a step counts as at a time [s]: it is late or early by no more than a rounding. At the
  // ends of a run its only neighbour counts; a step that is alone may be off by two spacings of
  // doubles.
  bool IsAt(std::size_t index, double time_s) const;

  // Whether a step is later than a time [s] by more than a rounding. Not-a-number is before all.
  bool IsAfter(std::size_t index, double time_s) const;

  // How far from its recorded time [s] a step may be asked for and still be meant: a simulation
  // that adds up its steps drifts the more the longer it runs. step_s: its distance from the
  // nearest step on the side of the time that is asked for. A thousandth of that, at most 0.1 ms;
  // at least two spacings of doubles at that time, up to half of step_s.
  static double Rounding(double time_s, double step_s);

private:
  std::optional<double> Distance(std::size_t index, int direction) const;

  std::vector<double> Times_;
  std::vector<std::size_t> Runs_; // where each begins
};

} // namespace dspace::session

#endif
