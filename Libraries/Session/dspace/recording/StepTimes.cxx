#include <dspace/recording/StepTimes.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace dspace::session {
namespace {

constexpr double LargestRounding = 1e-4; // s, but for the spacing of doubles

// Of doubles at a time [s], on the side away from 0.
double Spacing(double time_s) {
  const double size = std::abs(time_s);
  const double next = std::nextafter(size, std::numeric_limits<double>::infinity());
  return std::isfinite(next) ? next - size : size - std::nextafter(size, 0.0);
}

} // namespace

StepTimes::StepTimes(std::vector<double> times_s) : Times_(std::move(times_s)) {
  for (std::size_t i = 0; i < this->Times_.size(); ++i) {
    if (i == 0 || this->Times_[i] < this->Times_[i - 1]) {
      this->Runs_.push_back(i);
    }
  }
}

double StepTimes::Rounding(double time_s, double step_s) {
  return std::max(std::min(1e-3 * step_s, LargestRounding),
                  std::min(2.0 * Spacing(time_s), 0.5 * step_s));
}

// How far the next step of another time in the same run is, on (1) or back (-1).
std::optional<double> StepTimes::Distance(std::size_t index, int direction) const {
  const double time_s = this->Times_[index];
  auto other = std::ptrdiff_t(index);
  do {
    other += direction;
    if (other < 0 || std::size_t(other) >= this->Times_.size()) {
      return {};
    }
  } while (this->Times_[std::size_t(other)] == time_s);
  const double distance = (this->Times_[std::size_t(other)] - time_s) * direction;
  return distance > 0.0 ? std::optional<double>(distance) : std::nullopt;
}

bool StepTimes::IsAt(std::size_t index, double time_s) const {
  const double own = this->Times_[index];
  if (!(std::abs(own - time_s) <= std::max(LargestRounding, 2.0 * Spacing(own)))) {
    return false; // no rounding is larger
  }
  const int side = own > time_s ? -1 : 1;
  std::optional<double> step = this->Distance(index, side);
  step = step ? step : this->Distance(index, -side);
  return std::abs(own - time_s) <= (step ? Rounding(own, *step) : 2.0 * Spacing(own));
}

bool StepTimes::IsAfter(std::size_t index, double time_s) const {
  return !(this->Times_[index] <= time_s || this->IsAt(index, time_s));
}

std::optional<std::size_t> StepTimes::IndexAt(double time_s) const {
  std::optional<std::size_t> begun;
  std::size_t end = this->Times_.size();
  for (auto run = this->Runs_.rbegin(); run != this->Runs_.rend(); ++run) {
    const std::size_t begin = *run;
    if (!this->IsAfter(begin, time_s)) {
      if (time_s <= this->Times_[end - 1] || this->IsAt(end - 1, time_s)) {
        const auto after = [&](double at_s) {
          const auto found = std::upper_bound(this->Times_.begin() + std::ptrdiff_t(begin),
                                              this->Times_.begin() + std::ptrdiff_t(end), at_s);
          return std::size_t(found - this->Times_.begin());
        };
        std::size_t following = after(time_s);
        if (following < end && this->IsAt(following, time_s)) {
          following = after(this->Times_[following]);
        }
        return following - 1;
      }
      begun = begun ? begun : end - 1;
    }
    end = begin;
  }
  return begun;
}

} // namespace dspace::session
