// What a timeline shows and moves: the interface of a simulation's clock.
#ifndef DSPACE_WIDGETS_TIME_SOURCE_H
#define DSPACE_WIDGETS_TIME_SOURCE_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace dspace::widgets {

// From `begin` to `end` >= `begin` [s], both finite.
struct TimeRange {
  double begin = 0.0;
  double end = 0.0;

  double Length() const { return this->end - this->begin; }
  bool Contains(double time_s) const { return this->begin <= time_s && time_s <= this->end; }
  bool operator==(const TimeRange& o) const { return this->begin == o.begin && this->end == o.end; }
  bool operator!=(const TimeRange& o) const { return !(*this == o); }
};

// An event of the simulation.
struct TimelineEvent {
  enum class Severity { Info, Caution, Warning, Alarm }; // as v1::Severity
  double time_s = 0.0;
  Severity severity = Severity::Info;
  std::string kind; // "separation"
  std::string text; // for people
};

// All times are simulation times [s], of any epoch. Functions that ask for something throw
// dspace::Error where it fails; the timeline shows the message. Used in the thread of the GUI.
class TimeSource {
public:
  struct State {
    double time_s = 0.0;            // now
    std::optional<TimeRange> range; // known times; none: there is no time yet
    bool j2000 = true;              // times are TDB seconds past J2000; false: there is no UTC
    bool canPlay = false;
    bool canSeek = false; // and step, loop, and set the speed
    bool grows = false;   // the end of the range is live
    bool playing = false;
    bool following = false;        // the time stays at the live end
    double speed = 1.0;            // simulated seconds a second that are asked for; < 0: backwards
    std::optional<TimeRange> loop; // played again and again
  };

  virtual ~TimeSource() = default;
  virtual State GetState() const = 0;
  virtual const std::vector<TimelineEvent>& Events() const = 0; // by time
  // Changes when Events() or Gaps() do.
  virtual std::uint64_t EventsRevision() const { return 0; }
  // Times that cannot be shown, because they are lost.
  virtual const std::vector<TimeRange>& Gaps() const = 0;

  // The wall clock [s, any epoch] goes on: a timeline calls it up to 30 times a second.
  virtual void Advance(double wall_s) = 0;
  virtual void Play(bool playing) = 0;
  virtual void Seek(double time_s) = 0;
  virtual void Step(int steps) = 0;        // of the simulation; < 0: back
  virtual void SetSpeed(double speed) = 0; // not 0
  virtual void SetLoop(const std::optional<TimeRange>& loop) = 0;
  virtual void Follow(bool following) = 0;
};

} // namespace dspace::widgets

#endif
