// Where a playback should be, by the wall clock.
#ifndef DSPACE_WIDGETS_PLAY_CLOCK_H
#define DSPACE_WIDGETS_PLAY_CLOCK_H

#include <optional>

#include <dspace/widgets/timeline/TimeSource.h>

namespace dspace::widgets {

// Times are simulation times [s]. Between the steps of a recording the clock goes on evenly, so
// that slow playing proceeds. The loop, cut to the range, is played in the direction of the speed;
// without one, playing ends at an end of the range, except at a live end, where it waits.
class PlayClock {
public:
  static constexpr double LongestTick = 0.5;   // wall time that counts between two calls [s]
  static constexpr double SlowestSpeed = 1e-3; // of the absolute value
  static constexpr double FastestSpeed = 1e6;

  void SetRange(const TimeRange& range, bool grows);
  double Time() const { return this->Time_; }
  bool Playing() const { return this->Playing_; }
  bool Following() const { return this->Following_; }
  double Speed() const { return this->Speed_; }
  const std::optional<TimeRange>& Loop() const { return this->Loop_; }

  // From an end of the range, playing towards it begins at the other end.
  void Play(bool playing);
  // Cut to the range. Ends following.
  void Seek(double time_s);
  // Throws Error(InvalidArgument) for 0 and values that are not finite; others are cut to the
  // slowest and the fastest speed.
  void SetSpeed(double speed);
  // Throws Error(InvalidArgument) unless begin < end are finite.
  void SetLoop(const std::optional<TimeRange>& loop);
  void Follow(bool following);
  // Returns the time at wall time `wall_s`.
  double Advance(double wall_s);
  // Goes on from another time, as where a gap is skipped.
  void JumpTo(double time_s) { this->Time_ = time_s; }

private:
  TimeRange Range_;
  bool Grows_ = false;
  double Time_ = 0.0;
  bool Playing_ = false;
  bool Following_ = false;
  double Speed_ = 1.0;
  std::optional<TimeRange> Loop_;
  std::optional<double> Wall_s_; // of the last Advance()
};

} // namespace dspace::widgets

#endif
