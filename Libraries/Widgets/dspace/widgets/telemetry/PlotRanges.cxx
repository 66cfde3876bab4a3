#include <dspace/widgets/telemetry/PlotRanges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace dspace::widgets {
namespace {

constexpr double ValueMargin = 0.05; // above and below the values
constexpr double LeastRectangle = 6.0;

} // namespace

void PlotRanges::FollowAll() {
  this->FollowsX_ = this->FollowsValues_ = true;
}

// Of the times of all series.
SampleExtent PlotRanges::Times() const {
  SampleExtent times;
  for (const PlotSeries& each : this->State_.series) {
    if (!each.samples->IsEmpty()) {
      times.Add(each.samples->Time(0));
      times.Add(each.samples->Time(each.samples->Size() - 1));
    }
  }
  return times;
}

SampleExtent PlotRanges::InTimes(const PlotSeries& series, const PlotRange& times) const {
  std::size_t begin = series.samples->Lower(times.low);
  const std::size_t end = series.samples->Upper(times.high);
  if (series.holds && begin > 0 &&
      (begin == series.samples->Size() || series.samples->Time(begin) > times.low)) {
    --begin; // still holds
  }
  return series.samples->Extent(begin, end);
}

void PlotRanges::FitValues(PlotValueAxis& axis) const {
  SampleExtent extent;
  for (const PlotSeries& each : this->State_.series) {
    if (this->State_.IsDrawn(each) && each.unit == axis.unit) {
      const SampleExtent own =
          this->InTimes(each, this->State_.XSeries() ? this->State_.xTimes : this->State_.time);
      extent.Add(own.min);
      extent.Add(own.max);
    }
  }
  axis.range = Around(extent, ValueMargin);
}

void PlotRanges::Follow() {
  if (this->FollowsX_) {
    SampleExtent times = this->Times();
    if (!std::isnan(times.max) && this->Window_ > 0.0) {
      times.min = times.max - this->Window_;
    }
    this->State_.time = Around(times, 0.0);
    this->State_.xTimes = this->State_.time;
    if (const PlotSeries* x = this->State_.XSeries()) {
      this->State_.xValues = Around(this->InTimes(*x, this->State_.xTimes), ValueMargin);
    }
  }
  if (this->FollowsValues_) {
    for (PlotValueAxis& each : this->State_.axes) {
      this->FitValues(each);
    }
  }
}

void PlotRanges::SeriesChanged() {
  if (!this->State_.XSeries()) {
    this->State_.xName.clear();
  }
  std::vector<PlotValueAxis> axes;
  std::vector<std::size_t> fresh;
  const auto of = [](std::vector<PlotValueAxis>& all, const QString& unit) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const PlotValueAxis& axis) { return axis.unit == unit; });
    return found == all.end() ? nullptr : &*found;
  };
  for (const PlotSeries& each : this->State_.series) {
    if (!this->State_.IsDrawn(each) || of(axes, each.unit)) {
      continue;
    }
    const PlotValueAxis* before = of(this->State_.axes, each.unit);
    if (!before) {
      fresh.push_back(axes.size());
    }
    axes.push_back(before ? *before : PlotValueAxis{each.unit, {}});
  }
  this->State_.axes = std::move(axes);
  this->Follow();
  if (!this->FollowsValues_) {
    for (const std::size_t axis : fresh) {
      this->FitValues(this->State_.axes[axis]);
    }
  }
}

void PlotRanges::SetX(const PlotRange& range) {
  this->FollowsX_ = false;
  (this->State_.XSeries() ? this->State_.xValues : this->State_.time) = Shown(range);
  if (this->FollowsValues_ && !this->State_.XSeries()) {
    this->Follow();
  }
}

void PlotRanges::SetValues(PlotValueAxis& axis, const PlotRange& range) {
  this->FollowsValues_ = false;
  axis.range = Shown(range);
}

void PlotRanges::Zoom(const PlotPicture& shown, const QPointF& place, double factor, bool alongX,
                      int axis) {
  std::vector<PlotRange> ranges;
  for (int i = 0; i < int(this->State_.axes.size()); ++i) {
    const PlotMap map = shown.MapOf(i);
    ranges.push_back(axis == AllAxes || axis == i ? Zoomed(map.y, map.YAt(place.y()), factor)
                                                  : map.y);
  }
  const PlotMap map = shown.MapOf(NoAxis);
  if (alongX) {
    this->SetX(Zoomed(map.x, map.XAt(place.x()), factor));
  }
  if (axis != NoAxis) {
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      this->SetValues(this->State_.axes[i], ranges[i]);
    }
  }
}

void PlotRanges::Pan(const PlotPicture& shown, const QPointF& by, bool alongX, int axis) {
  const QRectF area = shown.Area();
  const PlotRange x = this->State_.XRange();
  if (axis != NoAxis) {
    for (int i = 0; i < int(this->State_.axes.size()); ++i) {
      if (axis == AllAxes || axis == i) {
        PlotValueAxis& each = this->State_.axes[std::size_t(i)];
        this->SetValues(each, Moved(each.range, each.range.Length() * by.y() / area.height()));
      }
    }
  }
  if (alongX && by.x() != 0.0) {
    this->SetX(Moved(x, -x.Length() * by.x() / area.width()));
  }
}

bool PlotRanges::ZoomTo(const PlotPicture& shown, const QRectF& rectangle) {
  const QRectF part = rectangle & shown.Area();
  if (part.width() < LeastRectangle || part.height() < LeastRectangle) {
    return false;
  }
  std::vector<PlotRange> ranges;
  for (int i = 0; i < int(this->State_.axes.size()); ++i) {
    const PlotMap map = shown.MapOf(i);
    ranges.push_back({map.YAt(part.bottom()), map.YAt(part.top())});
  }
  const PlotMap map = shown.MapOf(NoAxis);
  const PlotRange x{map.XAt(part.left()), map.XAt(part.right())};
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    this->SetValues(this->State_.axes[i], ranges[i]);
  }
  this->SetX(x);
  return true;
}

} // namespace dspace::widgets
