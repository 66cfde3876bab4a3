// Which steps of a recording can be shown whole, and what is lost between them.
#ifndef DSPACE_SESSION_PLAYBACK_STEPS_H
#define DSPACE_SESSION_PLAYBACK_STEPS_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <dspace/recording/RecordingReader.h>

namespace dspace::session {

// The state after command `end`: a time that the simulation set, and all that came until the next.
struct PlaybackStep {
  double time_s = 0.0;
  std::uint64_t end = 0;
};

// A span of which nothing can be shown, since commands first..last are lost or of no use.
struct PlaybackGap {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  std::optional<double> begin_s; // of the first step that may lack a command; none: from the start
  std::optional<double> end_s;   // of the next step that is whole; none: to the end
  std::size_t before = 0;        // whole steps before it
};

struct PlaybackSteps {
  std::vector<PlaybackStep> steps;
  std::vector<PlaybackGap> gaps;
};

// Commands first..last, none of which is missing.
struct PlaybackBlock {
  std::uint64_t first = 0;
  std::uint64_t last = 0;                // first - 1: a state and nothing after it
  std::optional<std::uint64_t> snapshot; // the first state from which it can be played; none: it
                                         // cannot be
};

// All of a recording; never empty.
std::vector<PlaybackBlock> BlocksOf(RecordingReader& reader);

// The steps of one scene, or of all where there is no name. After lost commands the next snapshot
// goes on. Of a recording that is being written all of it is as of one moment.
PlaybackSteps StepsOf(RecordingReader& reader,
                      const std::optional<std::string>& scene = std::nullopt);

// The number of the first command and the time [s] of every step, in whatever scene, that follows
// the first snapshot: first a step for what was there and done before time was first set.
std::vector<std::pair<std::uint64_t, double>> StepBegins(RecordingReader& reader);

} // namespace dspace::session

#endif
