// A recording carried out again, with no simulation.
#ifndef DSPACE_SESSION_PLAYBACK_H
#define DSPACE_SESSION_PLAYBACK_H

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <dspace/interpreter/Interpreter.h>
#include <dspace/recording/PlaybackSteps.h>
#include <dspace/recording/RecordedFiles.h>
#include <dspace/recording/RecordingReader.h>
#include <dspace/recording/StepTimes.h>

namespace dspace::session {

// Its commands are carried out under a FilesGuard (RecordedFiles::Look): rasters and shapes are
// opened in formats that read a file by itself only, and with packed files nothing else is read.
// The guard holds for this recording's commands alone, also in the threads that read on; what else
// the program does with rasters stays as it is (ConfinedDrivers.h).
//
// Gives a recording's commands to an interpreter, whose scenes and viewports are the recording's
// from then on: what else is in it is removed with the next seek that begins from a snapshot.
// Throws Error: those of RecordingReader and of RecordedFiles; Corrupt where a command is refused,
// where no step is whole, and in a gap.
class Playback {
public:
  // Both must outlive it. It is at the first step then. Packed files are unpacked, and gone with
  // it: what it has shown of them stays in the interpreter, but no terrain reads on. Of others each
  // must be what it was, unless checkFiles is false.
  Playback(RecordingReader& reader, Interpreter& interpreter, bool checkFiles = true);

  const std::vector<PlaybackStep>& Steps() const { return this->Steps_.steps; }
  const std::vector<PlaybackGap>& Gaps() const { return this->Steps_.gaps; }
  std::size_t Index() const { return this->Index_; }
  double Time() const { return this->Steps_.steps[this->Index_].time_s; }

  // To a time [s], as StepTimes::IndexAt says; InvalidArgument before the first step. Returns the
  // step's own recorded time.
  double Seek(double time_s);
  // So many steps on, or back; stops at the ends. Returns how many were made.
  std::int64_t Step(std::int64_t n);
  // Where packed files are, and their paths there.
  const RecordedFiles& Files() const { return this->Files_; }
  // Takes in what has been recorded since; returns how many steps came. The last may have grown.
  std::size_t Update();

private:
  void SetSteps();
  void Go(std::size_t index);
  void Begin(const RecordedSnapshot& snapshot);
  void CheckStep(std::size_t index, std::optional<double> reached_s);
  void CarryOut(v1::Command command, const char* table, std::uint64_t seq);
  void WaitForOverviews(const v1::Command& opened);

  RecordingReader& Reader_;
  Interpreter& Interpreter_;
  PlaybackSteps Steps_; // before the files: a command's are noted before it
  StepTimes Times_;
  RecordedFiles Files_;
  std::size_t Index_ = 0;
  std::optional<std::uint64_t> At_; // the command after which the state is; none: unknown
};

} // namespace dspace::session

#endif
