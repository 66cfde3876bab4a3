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
  this->Last_ = reader.Last();
  this->Known_ = playback.Index();
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
  if (!this->Playback_.IsMoving()) { // where a script moved it to no longer counts
    this->Known_ = this->Playback_.Index();
  }
  this->Steps_ = 0;
  this->Sought_ = true;
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

void PlaybackTimeSource::Update(double wall_s) {
  if (!(this->Grows_ || this->Looks_) ||
      (wall_s - this->Updated_s_ < UpdateEvery && wall_s >= this->Updated_s_)) {
    return;
  }
  const bool first = this->Updated_s_ == 0.0;
  this->Updated_s_ = wall_s;
  const std::uint64_t last = this->Reader_.Last();
  if (last == this->Last_ && !(first && this->Grows_)) {
    return;
  }
  this->Last_ = last;
  this->Grows_ = true;
  if (this->Playback_.Update() > 0) {
    this->ReadSteps();
    this->ReadEvents();
  }
}

void PlaybackTimeSource::Aim(std::size_t index, bool foreign) {
  if (foreign || index != this->Target_.value_or(this->Playback_.Index())) {
    this->Playback_.Aim(index);
    this->Target_ = index;
  }
}

void PlaybackTimeSource::Advance(double wall_s) {
  this->Update(wall_s);
  // Of a script, which waits for its end; the user's own movements take over.
  const bool foreign = this->Playback_.IsMoving() && this->Playback_.Aimed() != this->Target_;
  if (foreign) {
    this->Target_.reset();
  }
  if (!this->Playback_.IsMoving()) {
    this->Target_.reset();
    if (this->Playback_.Index() != this->Known_) { // moved by a script
      this->Known_ = this->Playback_.Index();
      this->Clock_.Seek(this->Playback_.Time());
    }
  }
  try {
    if (this->Steps_ != 0) {
      const auto at = std::int64_t(this->Target_.value_or(this->Playback_.Index()));
      const std::int64_t to = std::clamp(at + this->Steps_, std::int64_t(this->First_),
                                         std::int64_t(this->Times_.Times().size()) - 1);
      this->Steps_ = 0;
      this->Aim(std::size_t(to), foreign);
      this->Clock_.Seek(this->Times_.Times()[std::size_t(to)]);
      this->Clock_.Advance(wall_s);
    } else if (!foreign || this->Sought_) {
      this->Clock_.Advance(wall_s);
      this->SkipGap();
      // A movement is completed before playing goes on, so that something is seen.
      if (std::exchange(this->Sought_, false) || !this->Target_) {
        if (const auto index = this->Times_.IndexAt(this->Clock_.Time())) {
          this->Aim(*index, foreign);
        }
      }
    }
    if (this->Target_ && this->Playback_.Continue(LongestSlice)) {
      this->Target_.reset();
    }
    this->Known_ = this->Playback_.Index();
  } catch (...) {
    const bool returning = this->Target_ == this->Playback_.Index();
    this->Target_.reset();
    this->Clock_.Play(false);
    this->Clock_.Seek(this->Playback_.Time());
    if (!returning) { // half of the way may be there: the next calls show the last good step
      this->Playback_.Aim(this->Playback_.Index());
      this->Target_ = this->Playback_.Index();
    }
    throw;
  }
}

} // namespace dspace::widgets
