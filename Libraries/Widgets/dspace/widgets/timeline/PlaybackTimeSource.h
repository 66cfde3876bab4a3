// The clock of a playback.
#ifndef DSPACE_WIDGETS_PLAYBACK_TIME_SOURCE_H
#define DSPACE_WIDGETS_PLAYBACK_TIME_SOURCE_H

#include <optional>
#include <vector>

#include <dspace/recording/Playback.h>
#include <dspace/recording/RecordingReader.h>
#include <dspace/recording/StepTimes.h>
#include <dspace/widgets/timeline/PlayClock.h>
#include <dspace/widgets/timeline/TimeSource.h>

namespace dspace::widgets {

// Plays a recording by a PlayClock. Seek(), SetSpeed(), ... only take a note; Advance() moves the
// playback, at most once a call, so that a hundred movements of the mouse are one, and for about
// LongestSlice: a long way takes several calls, and the time that is told is that of the last
// complete step. A playback that something else has moved goes on from there. Playing skips gaps.
// The range begins with the first time that was set. Where times go back, the time of the latest
// run is shown, as Playback::Seek does. Advance() reads the file and executes commands in the
// calling thread, that of the interpreter.
class PlaybackTimeSource : public TimeSource {
public:
  static constexpr double UpdateEvery = 0.5;    // wall time between looks for new steps [s]
  static constexpr double LongestSlice = 0.012; // of Advance() [s], where no command takes longer

  // Both must outlive it, and `reader` is that of the playback. `grows`: the recording is being
  // written. Throws as RecordingReader.
  PlaybackTimeSource(session::Playback& playback, session::RecordingReader& reader,
                     bool grows = false, bool j2000 = true);

  // The recording may be one that is being written: it grows from the first time that it does.
  void LookForGrowth() { this->Looks_ = true; }

  State GetState() const override;
  const std::vector<TimelineEvent>& Events() const override { return this->Events_; }
  std::uint64_t EventsRevision() const override { return this->Revision_; }
  const std::vector<TimeRange>& Gaps() const override { return this->Gaps_; }
  // Throws as Playback; then it stands still at the last good step.
  void Advance(double wall_s) override;
  void Play(bool playing) override { this->Clock_.Play(playing); }
  void Seek(double time_s) override;
  void Step(int steps) override;
  void SetSpeed(double speed) override { this->Clock_.SetSpeed(speed); }
  void SetLoop(const std::optional<TimeRange>& loop) override { this->Clock_.SetLoop(loop); }
  void Follow(bool following) override { this->Clock_.Follow(following); }

private:
  void ReadSteps();
  void ReadEvents();
  void SkipGap();
  void Update(double wall_s);
  void Aim(std::size_t index, bool foreign); // `foreign`: away from where a script goes

  session::Playback& Playback_;
  session::RecordingReader& Reader_;
  bool Grows_;
  bool Looks_ = false;
  bool J2000_;
  PlayClock Clock_;
  session::StepTimes Times_;
  TimeRange Range_;
  std::size_t First_ = 0; // the first step with a time
  std::vector<TimelineEvent> Events_;
  std::vector<TimeRange> Gaps_;
  std::uint64_t Revision_ = 0;
  std::uint64_t EventsUntil_ = 0; // the last command that was read for events
  double Updated_s_ = 0.0;
  std::uint64_t Last_ = 0;            // the last command at the last look
  std::size_t Known_ = 0;             // the index after the last Advance()
  std::optional<std::size_t> Target_; // of the movement in progress
  bool Sought_ = false;
  int Steps_ = 0; // asked for
};

} // namespace dspace::widgets

#endif
