// The range of an axis, and its ticks.
#ifndef DSPACE_WIDGETS_PLOT_AXIS_H
#define DSPACE_WIDGETS_PLOT_AXIS_H

#include <string>
#include <vector>

#include <dspace/widgets/telemetry/SampleSeries.h>

namespace dspace::widgets {

struct PlotRange {
  double low = 0.0;
  double high = 1.0;

  double Length() const { return this->high - this->low; }
  bool operator==(const PlotRange& other) const {
    return this->low == other.low && this->high == other.high;
  }
  bool operator!=(const PlotRange& other) const { return !(*this == other); }
};

// The nearest range that an axis can show: low < high, within ±1e300, and long enough for doubles
// to tell its pixels apart. What is not finite becomes 0 to 1.
PlotRange Shown(PlotRange range);
// The range that shows all of an extent, with `margin` of its length on each side; 0 to 1 for NaN.
PlotRange Around(const SampleExtent& extent, double margin);
// Scaled about a value that keeps its place. `factor` below 1 shows less.
PlotRange Zoomed(const PlotRange& range, double about, double factor);
PlotRange Moved(const PlotRange& range, double by);

struct PlotTick {
  double value = 0.0;
  std::string text; // of value - offset
};
struct PlotTicks {
  std::vector<PlotTick> ticks;
  double offset = 0.0;
  std::string offsetText; // empty: the offset is 0
};

// Up to `count` (at least 1) ticks at round values in a range as of Shown(). Where all values have
// their first digits in common, texts are those of the difference from a round offset.
PlotTicks MakeTicks(const PlotRange& range, int count);

} // namespace dspace::widgets

#endif
