// Playback of a recording without a simulation.
#ifndef DSPACE_SESSION_PLAYBACK_H
#define DSPACE_SESSION_PLAYBACK_H

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <dspace/FilesRead.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/recording/CancelCheck.h>
#include <dspace/recording/PlaybackSteps.h>
#include <dspace/recording/RecordedFiles.h>
#include <dspace/recording/RecordingReader.h>
#include <dspace/recording/StepTimes.h>

namespace dspace::session {

// A command whose files another thread reads.
struct CommandAhead {
  std::function<bool(double seconds)> isRead; // waits for it up to this time
  std::function<v1::Reply()> execute;         // once it is read
};

// What others have in the interpreter of a playback, such as views of their own. Each may be empty.
struct PlaybackGuests {
  std::function<void()> beforeSnapshot; // all scenes and viewports are about to go
  std::function<void()> afterSnapshot;  // the scenes of the snapshot are there
  std::function<void()> arrived;        // a movement is complete
  // Makes room for a command that removes a scene, or that was rejected; true: try it again.
  std::function<bool(const v1::Command&)> makeRoom;
  // Begins to read the files of a command, as it will be executed, in another thread, under a
  // FilesGuard with `look`; none: it reads none. Continue() returns false until they are read.
  std::function<std::optional<CommandAhead>(const v1::Command&, const FilesGuard::Check& look)>
      readAhead;
};

// What a playback reads first of a recording. Any thread may read it; one at a time uses it.
struct PlaybackSources {
  PlaybackSteps steps; // before the files, which are recorded before their commands
  std::unique_ptr<RecordedFiles> files;

  // Unpacks or checks the files, as RecordedFiles does. Throws what a Playback's constructor does.
  static PlaybackSources Read(RecordingReader& reader, bool checkFiles = true,
                              CancelCheck checkCancel = {});
};

// Executes the commands under a FilesGuard (RecordedFiles::Look): rasters and shapes are opened
// only in self-contained formats, and a packed recording reads nothing but its packed files. The
// guard applies to this recording's commands only, including their background threads
// (ConfinedDrivers.h).
//
// Executes a recording's commands in an interpreter. The interpreter's scenes and viewports then
// belong to the recording: a seek that starts from a snapshot removes all others. Throws Error:
// those of RecordingReader and RecordedFiles; Corrupt if a command is rejected, if there is no
// complete step, and in a gap.
class Playback {
public:
  // Starts at the first step. The reader and the interpreter must outlive it. Packed files are
  // unpacked, and removed by the destructor; the interpreter keeps what it has loaded, but terrains
  // can read no more tiles. Files that are not packed must be unchanged, unless checkFiles is
  // false.
  Playback(RecordingReader& reader, Interpreter& interpreter, bool checkFiles = true);
  // The same with what PlaybackSources::Read() has read by this reader. Aims at the first step;
  // Continue() moves there. Until then Index() is 0.
  Playback(RecordingReader& reader, Interpreter& interpreter, PlaybackSources sources,
           PlaybackGuests guests);

  const std::vector<PlaybackStep>& Steps() const { return this->Steps_.steps; }
  const std::vector<PlaybackGap>& Gaps() const { return this->Steps_.gaps; }
  std::size_t Index() const { return this->Index_; }
  double Time() const { return this->Steps_.steps[this->Index_].time_s; }

  // Moves to a time [s] by the rule of StepTimes::IndexAt; InvalidArgument before the first step.
  // Returns the recorded time of the step.
  double Seek(double time_s);
  // Moves n steps forward, or back if n is negative; stops at the ends. Returns the number of steps
  // moved.
  std::int64_t Step(std::int64_t n);
  // A movement in slices, so that the caller's thread is not held: Aim() takes a note of the step
  // to move to, and each Continue() executes commands for about this time [s]: at least one, unless
  // its files are being read (PlaybackGuests::readAhead) or overviews are being built. It returns
  // true when there is nothing left to do. Until then Index() and Time() return those of the
  // previous step, and the state is between the two. A new aim takes over at once; Seek() and
  // Step() complete theirs. InvalidArgument: there is no such step.
  void Aim(std::size_t index);
  bool Continue(double seconds);
  bool IsMoving() const { return this->Aim_.has_value(); }
  std::optional<std::size_t> Aimed() const { return this->Aim_; } // of a movement
  void SetGuests(PlaybackGuests guests) { this->Guests_ = std::move(guests); }
  // The packed files and their present paths.
  const RecordedFiles& Files() const { return *this->Files_; }
  // What the caller should hear since the last call: commands whose text was not UTF-8
  // (ForeignRows), which were executed with their text as UTF-8.
  std::vector<std::string> TakeNotes();
  // Reads what has been recorded since; returns the number of new steps. The last step may have
  // grown.
  std::size_t Update();

private:
  void SetSteps();
  void MoveTo(std::size_t index);
  // The number of the snapshot from which the way to a command is shortest; none: from here.
  std::optional<std::uint64_t> SnapshotOnTheWay(std::uint64_t target);
  void Begin(std::uint64_t target);
  bool Proceed(std::uint64_t target, double seconds);
  void CheckStep(std::size_t index, std::optional<double> reached_s);
  // False: its files, or overviews of a terrain before it, are not there yet; nothing has happened.
  // Waits for them up to this time [s].
  bool Execute(v1::Command command, const char* table, std::uint64_t seq, double seconds);
  bool IsReady(const v1::Command& command, double seconds);
  void NoteForeign(bool foreign, const char* table, std::uint64_t seq);
  bool HasOverviews(double seconds); // waits for them up to this time

  RecordingReader& Reader_;
  Interpreter& Interpreter_;
  PlaybackSteps Steps_;
  StepTimes Times_;
  std::unique_ptr<RecordedFiles> Files_;
  std::size_t Index_ = 0;
  std::optional<std::uint64_t> At_; // the last executed command; none: unknown
  PlaybackGuests Guests_;
  std::optional<std::size_t> Aim_;
  std::optional<double> Reached_s_;      // the time of the last command since Aim()
  std::optional<RecordedSnapshot> Base_; // that is being executed
  std::size_t BaseDone_ = 0;             // commands of it
  std::string AheadOf_;                  // the command whose files are being read, serialized
  std::optional<CommandAhead> Ahead_;
  std::optional<CommandAhead> Left_;    // of an earlier aim, no longer needed
  std::optional<v1::Command> Building_; // asks for the overviews of a terrain
  std::set<std::string> Foreign_;       // rows that were noted
  std::vector<std::string> Notes_;
};

} // namespace dspace::session

#endif
