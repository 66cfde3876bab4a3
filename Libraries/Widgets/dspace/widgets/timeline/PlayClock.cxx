#include <dspace/widgets/timeline/PlayClock.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>

namespace dspace::widgets {

void PlayClock::SetRange(const TimeRange& range, bool grows) {
  this->Range_ = range;
  this->Grows_ = grows;
  this->Following_ = this->Following_ && grows;
  this->Time_ = this->Following_ ? range.end : std::clamp(this->Time_, range.begin, range.end);
}

void PlayClock::Play(bool playing) {
  const bool starts = playing && !this->Playing_;
  this->Playing_ = playing;
  if (!playing) {
    this->Following_ = false;
  }
  if (!starts || this->Loop_ || this->Following_) {
    return;
  }
  if (this->Speed_ > 0.0 && this->Time_ >= this->Range_.end && !this->Grows_) {
    this->Time_ = this->Range_.begin;
  } else if (this->Speed_ < 0.0 && this->Time_ <= this->Range_.begin) {
    this->Time_ = this->Range_.end;
  }
}

void PlayClock::Seek(double time_s) {
  if (std::isnan(time_s)) {
    throw Error(Error::Kind::InvalidArgument, "timeline", "the time is NaN; accepted: a number");
  }
  this->Time_ = std::clamp(time_s, this->Range_.begin, this->Range_.end);
  this->Following_ = false;
}

void PlayClock::SetSpeed(double speed) {
  if (!std::isfinite(speed) || speed == 0.0) {
    throw Error(Error::Kind::InvalidArgument, "timeline",
                "the speed is " + std::to_string(speed) + "; accepted: a number that is not 0");
  }
  this->Speed_ = std::copysign(std::clamp(std::abs(speed), SlowestSpeed, FastestSpeed), speed);
  this->Following_ = this->Following_ && speed > 0.0;
}

void PlayClock::SetLoop(const std::optional<TimeRange>& loop) {
  if (loop && !(std::isfinite(loop->begin) && std::isfinite(loop->end) && loop->Length() > 0.0)) {
    throw Error(Error::Kind::InvalidArgument, "timeline",
                "the loop is from " + std::to_string(loop->begin) + " to " +
                    std::to_string(loop->end) + "; accepted: two times, the first one earlier");
  }
  this->Loop_ = loop;
  this->Following_ = this->Following_ && !loop;
}

void PlayClock::Follow(bool following) {
  this->Following_ = following && this->Grows_;
  if (this->Following_) {
    this->Time_ = this->Range_.end;
    this->Playing_ = true;
    this->Loop_.reset();
    this->Speed_ = std::abs(this->Speed_);
  }
}

double PlayClock::Advance(double wall_s) {
  const double passed = this->Wall_s_ ? std::clamp(wall_s - *this->Wall_s_, 0.0, LongestTick) : 0.0;
  this->Wall_s_ = wall_s;
  if (this->Following_) {
    this->Time_ = this->Range_.end;
    return this->Time_;
  }
  if (!this->Playing_) {
    return this->Time_;
  }
  const double moved = this->Time_ + passed * this->Speed_;
  TimeRange played = this->Range_;
  bool loops = false;
  if (this->Loop_) {
    const TimeRange cut{std::max(this->Loop_->begin, played.begin),
                        std::min(this->Loop_->end, played.end)};
    loops = cut.Length() > 0.0;
    played = loops ? cut : played;
  }
  if (loops) {
    const bool left = this->Speed_ > 0.0 ? moved >= played.end : moved <= played.begin;
    if (left || (this->Speed_ > 0.0 ? moved < played.begin : moved > played.end)) {
      // Over the end by this much, in the direction of playing; from outside the loop it begins.
      const double over =
          left ? std::fmod(std::abs(moved - (this->Speed_ > 0.0 ? played.end : played.begin)),
                           played.Length())
               : 0.0;
      this->Time_ = this->Speed_ > 0.0 ? played.begin + over : played.end - over;
    } else {
      this->Time_ = moved;
    }
    return this->Time_;
  }
  this->Time_ = std::clamp(moved, played.begin, played.end);
  const bool ended =
      this->Speed_ > 0.0 ? moved >= played.end && !this->Grows_ : moved <= played.begin;
  this->Playing_ = !ended;
  return this->Time_;
}

} // namespace dspace::widgets
