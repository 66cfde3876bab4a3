// How fast simulation time passes.
#ifndef DSPACE_WIDGETS_RATE_METER_H
#define DSPACE_WIDGETS_RATE_METER_H

#include <cmath>
#include <deque>
#include <optional>
#include <utility>

namespace dspace::widgets {

// The real-time factor: simulated seconds a second of the wall clock, over the last second.
class RateMeter {
public:
  static constexpr double Span = 1.0; // of wall time [s]

  void Add(double wall_s, double time_s) {
    this->Samples_.emplace_back(wall_s, time_s);
    // One sample stays before the span, so that it is covered whole.
    while (this->Samples_.size() > 2 && this->Samples_[1].first <= wall_s - Span) {
      this->Samples_.pop_front();
    }
  }
  // After a jump.
  void Reset() { this->Samples_.clear(); }
  // None for the first quarter of a span.
  std::optional<double> Rate() const {
    if (this->Samples_.size() < 2) {
      return {};
    }
    const double wall_s = this->Samples_.back().first - this->Samples_.front().first;
    if (wall_s < 0.25 * Span) {
      return {};
    }
    return (this->Samples_.back().second - this->Samples_.front().second) / wall_s;
  }

private:
  std::deque<std::pair<double, double>> Samples_; // wall and simulation time [s]
};

} // namespace dspace::widgets

#endif
