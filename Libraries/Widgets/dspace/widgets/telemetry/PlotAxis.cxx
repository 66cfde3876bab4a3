#include <dspace/widgets/telemetry/PlotAxis.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <dspace/overlay/RoundNumbers.h>

namespace dspace::widgets {
namespace {

constexpr double Most = 1e300;
constexpr double LeastLength = 1e-250;
constexpr double LeastPart = 1e-12;  // of the greatest value: some thousand doubles
constexpr double CommonDigits = 1e4; // values over the range's length, where an offset begins

} // namespace

PlotRange Shown(PlotRange range) {
  if (!std::isfinite(range.low) || !std::isfinite(range.high)) {
    return {};
  }
  if (range.high < range.low) {
    std::swap(range.low, range.high);
  }
  range.low = std::clamp(range.low, -Most, Most);
  range.high = std::clamp(range.high, -Most, Most);
  const double size = std::max(std::abs(range.low), std::abs(range.high));
  const double least = std::max(LeastPart * size, LeastLength);
  if (range.Length() < least) {
    const double middle = range.low + 0.5 * range.Length();
    range.low = middle - 0.5 * least;
    range.high = middle + 0.5 * least;
  }
  return range;
}

PlotRange Around(const SampleExtent& extent, double margin) {
  if (std::isnan(extent.min)) {
    return {};
  }
  const double low = std::clamp(extent.min, -Most, Most);
  const double high = std::clamp(extent.max, -Most, Most);
  // A value that does not change, but for rounding errors, has room on both sides.
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low <= LeastPart * size || high - low < LeastLength) {
    const double room = size > 0.0 ? 0.1 * size : 1.0;
    return Shown({low - room, high + room});
  }
  return Shown({low - margin * (high - low), high + margin * (high - low)});
}

PlotRange Zoomed(const PlotRange& range, double about, double factor) {
  return Shown({about + (range.low - about) * factor, about + (range.high - about) * factor});
}

PlotRange Moved(const PlotRange& range, double by) {
  const PlotRange moved{range.low + by, range.high + by};
  return std::max(std::abs(moved.low), std::abs(moved.high)) <= Most ? Shown(moved) : range;
}

PlotTicks MakeTicks(const PlotRange& range, int count) {
  PlotTicks ticks;
  const double size = std::max(std::abs(range.low), std::abs(range.high));
  if (size > CommonDigits * range.Length()) {
    const double unit = std::pow(10.0, std::ceil(std::log10(range.Length())) + 1.0);
    ticks.offset = std::floor(range.low / unit) * unit;
    if (std::abs(ticks.offset) < 1e15 && unit >= 1.0) {
      ticks.offsetText = RoundText(ticks.offset, 1e3);
    }
    if (ticks.offsetText.empty() || std::abs(ticks.offset) >= 1e12) {
      char text[32];
      std::snprintf(text, sizeof(text), "%.15g", ticks.offset);
      ticks.offsetText = text;
    }
  }
  const double low = range.low - ticks.offset;
  const double high = range.high - ticks.offset;
  const double step = RoundStep(low, high, std::max(count, 1), false);
  for (const double value : Multiples(step, low, high)) {
    ticks.ticks.push_back({ticks.offset + value, RoundText(value, step)});
  }
  return ticks;
}

} // namespace dspace::widgets
