// The complete steps of a recording, and the gaps between them.
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

// A step: a time that the simulation set, and all commands until the next one. `end` is its last
// command.
struct PlaybackStep {
  double time_s = 0.0;
  std::uint64_t end = 0;
};

// A time span that cannot be played: commands first..last are lost or unusable.
struct PlaybackGap {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  std::optional<double> begin_s; // of the first step that may lack a command; none: the start
  std::optional<double> end_s;   // of the next complete step; none: the end
  std::size_t before = 0;        // number of complete steps before it
};

struct PlaybackSteps {
  std::vector<PlaybackStep> steps;
  std::vector<PlaybackGap> gaps;
};

// Commands first..last without a gap.
struct PlaybackBlock {
  std::uint64_t first = 0;
  std::uint64_t last = 0;                // first - 1: a state and nothing after it
  std::optional<std::uint64_t> snapshot; // the first state from which it can be played; none: it
                                         // cannot be
};

// All blocks of a recording; never empty.
std::vector<PlaybackBlock> BlocksOf(RecordingReader& reader);

// The steps of one scene, or of all scenes without a name. After lost commands, playback continues
// at the next snapshot. A recording that is being written is read in one consistent view.
PlaybackSteps StepsOf(RecordingReader& reader,
                      const std::optional<std::string>& scene = std::nullopt);

// Throws Error for a recording whose steps are none: NotFound if it has no command and no state,
// because its process ended, or is, in its first moments, else Corrupt.
[[noreturn]] void RejectNoSteps(RecordingReader& reader);

// The number of the first command and the time [s] of every step of any scene after the first
// snapshot. The first entry is for the state before time was first set.
std::vector<std::pair<std::uint64_t, double>> StepBegins(RecordingReader& reader);

} // namespace dspace::session

#endif
