#include <dspace/widgets/timeline/PlaybackTimeSource.h>

#include <algorithm>
#include <utility>

#include <dspace/recording/RecordingFile.h>
#include <dspace/widgets/timeline/LoggedEvents.h>

namespace dspace::widgets {

PlaybackTimeSource::PlaybackTimeSource(session::Playback& playback,
                                       session::RecordingReader& reader, bool grows, bool j2000)
    : Playback_(playback), Reader_(reader), Grows_(grows), J2000_(j2000) {
  this->ReadSteps();
  this->ReadEvents();
  this->Clock_.Seek(playback.Time());
}

void PlaybackTimeSource::ReadSteps() {
  std::vector<double> times;
  for (const session::PlaybackStep& step : this->Playback_.Steps()) {
    times.push_back(step.time_s);
  }
  // What was built before the time was first set has no time of its own.
  const std::vector<std::pair<std::uint64_t, double>> set = this->Reader_.Steps();
  this->First_ = times.size() > 1 && !set.empty() && times.front() == 0.0 &&
                         this->Playback_.Steps().front().end < set.front().first
                     ? 1
                     : 0;
  const auto [least, greatest] =
      std::minmax_element(times.begin() + std::ptrdiff_t(this->First_), times.end());
  this->Range_ = {*least, *greatest};
  this->Clock_.SetRange(this->Range_, this->Grows_);
  this->Gaps_.clear();
  for (const session::PlaybackGap& gap : this->Playback_.Gaps()) {
    const TimeRange lost{gap.begin_s.value_or(this->Range_.begin),
                         gap.end_s.value_or(this->Range_.end)};
    if (lost.Length() > 0.0) {
      this->Gaps_.push_back(lost);
    }
  }
  this->Times_ = session::StepTimes(std::move(times));
  ++this->Revision_;
}

void PlaybackTimeSource::ReadEvents() {
  for (const session::PlaybackBlock& block : session::BlocksOf(this->Reader_)) {
    const std::uint64_t first = std::max(block.first, this->EventsUntil_ + 1);
    if (first > block.last) {
      continue;
    }
    this->Reader_.ReadOnly({v1::Command::kLogEvent}, first, block.last,
                           [this](session::RecordingRow&& row) {
                             v1::Command command;
                             if (command.ParseFromString(row.payload)) {
                               this->Events_.push_back(ToTimelineEvent(command.log_event()));
                             }
                             return true;
                           });
    this->EventsUntil_ = block.last;
  }
  SortByTime(this->Events_);
  ++this->Revision_;
}

TimeSource::State PlaybackTimeSource::GetState() const {
  State state;
  state.time_s = this->Playback_.Time();
  state.range = this->Range_;
  state.j2000 = this->J2000_;
  state.canPlay = state.canSeek = true;
  state.grows = this->Grows_;
  state.playing = this->Clock_.Playing();
  state.following = this->Clock_.Following();
  state.speed = this->Clock_.Speed();
  state.loop = this->Clock_.Loop();
  return state;
}

void PlaybackTimeSource::Seek(double time_s) {
  this->Steps_ = 0;
  this->Clock_.Seek(time_s);
}

void PlaybackTimeSource::Step(int steps) {
  this->Clock_.Play(false);
  this->Steps_ += steps;
}

// Playing goes on behind a gap.
void PlaybackTimeSource::SkipGap() {
  if (!this->Clock_.Playing() || this->Clock_.Following()) {
    return;
  }
  const double time_s = this->Clock_.Time();
  for (const TimeRange& gap : this->Gaps_) {
    if (gap.begin <= time_s && time_s < gap.end) {
      this->Clock_.JumpTo(this->Clock_.Speed() > 0.0 ? gap.end : gap.begin);
    }
  }
}

void PlaybackTimeSource::Advance(double wall_s) {
  if (this->Grows_ && !(wall_s - this->Updated_s_ < UpdateEvery && wall_s >= this->Updated_s_)) {
    this->Updated_s_ = wall_s;
    if (this->Playback_.Update() > 0) {
      this->ReadSteps();
      this->ReadEvents();
    }
  }
  try {
    if (this->Steps_ != 0) {
      const auto at = std::int64_t(this->Playback_.Index());
      const std::int64_t to = std::max(at + this->Steps_, std::int64_t(this->First_));
      this->Steps_ = 0;
      this->Playback_.Step(to - at);
      this->Clock_.Seek(this->Playback_.Time());
      this->Clock_.Advance(wall_s);
      return;
    }
    this->Clock_.Advance(wall_s);
    this->SkipGap();
    const auto index = this->Times_.IndexAt(this->Clock_.Time());
    if (index && *index != this->Playback_.Index()) {
      this->Playback_.Step(std::int64_t(*index) - std::int64_t(this->Playback_.Index()));
    }
  } catch (...) {
    this->Clock_.Play(false);
    this->Clock_.Seek(this->Playback_.Time());
    throw;
  }
}

} // namespace dspace::widgets
