#include <dspace/widgets/telemetry/PlotCurve.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace dspace::widgets {
namespace {

constexpr double FewSamples = 12.0; // pixels between samples that are marked as dots
constexpr std::size_t Leaf = 16;    // samples that PairCurve does not split
constexpr double OnePlace = 0.5;    // pixels

// Makes lines of points, clipped to the area.
class Pen {
public:
  Pen(const QRectF& area, PlotCurve& curve) : Area_(area), Curve_(curve) {}
  ~Pen() { this->Lift(); }
  Pen(const Pen&) = delete;
  Pen& operator=(const Pen&) = delete;

  void To(const QPointF& point) {
    if (!std::isfinite(point.x()) || !std::isfinite(point.y())) {
      this->Lift();
      return;
    }
    if (this->Down_) {
      this->Segment(this->Last_, point);
      this->Alone_ = false;
    } else {
      this->Alone_ = true;
    }
    this->Down_ = true;
    this->Last_ = point;
  }
  // Ends the line.
  void Lift() {
    if (this->Down_ && this->Alone_ && this->Area_.contains(this->Last_)) {
      this->Curve_.dots.push_back(this->Last_); // a sample between gaps
    }
    this->Flush();
    this->Down_ = false;
  }

private:
  // Liang and Barsky's algorithm.
  void Segment(const QPointF& a, const QPointF& b) {
    double first = 0.0;
    double last = 1.0;
    const QPointF d = b - a;
    const double p[] = {-d.x(), d.x(), -d.y(), d.y()};
    const double q[] = {a.x() - this->Area_.left(), this->Area_.right() - a.x(),
                        a.y() - this->Area_.top(), this->Area_.bottom() - a.y()};
    for (int i = 0; i < 4; ++i) {
      if (p[i] == 0.0) {
        if (q[i] < 0.0) {
          this->Flush();
          return;
        }
      } else if (p[i] < 0.0) {
        first = std::max(first, q[i] / p[i]);
      } else {
        last = std::min(last, q[i] / p[i]);
      }
    }
    if (!(first <= last)) {
      this->Flush();
      return;
    }
    if (this->Line_.isEmpty() || first > 0.0) {
      this->Flush();
      this->Line_ += a + first * d;
    }
    const QPointF end = last < 1.0 ? a + last * d : b;
    this->Curve_.travel += std::abs(end.y() - this->Line_.last().y());
    if (end != this->Line_.last() || this->Line_.size() == 1) {
      this->Line_ += end;
    }
    if (last < 1.0) {
      this->Flush();
    }
  }
  void Flush() {
    if (this->Line_.size() > 1) {
      this->Curve_.lines.push_back(std::move(this->Line_));
    }
    this->Line_ = {};
  }

  QRectF Area_;
  PlotCurve& Curve_;
  QPolygonF Line_;
  QPointF Last_;
  bool Down_ = false;
  bool Alone_ = false;
};

void AddSample(Pen& pen, const SampleSeries& samples, bool holds, const PlotMap& map,
               std::size_t i) {
  if (holds && i > 0 && !std::isnan(samples.Value(i))) {
    pen.To(map.At(samples.Time(i), samples.Value(i - 1)));
  }
  pen.To(map.At(samples.Time(i), samples.Value(i)));
}

} // namespace

PlotCurve TimeCurve(const SampleSeries& samples, bool holds, const PlotMap& map, int columns,
                    double now) {
  PlotCurve curve;
  const std::size_t begin = samples.Lower(map.x.low);
  const std::size_t end = samples.Upper(map.x.high);
  const std::size_t from = begin > 0 ? begin - 1 : 0; // lines lead out of the area
  const std::size_t to = std::min(end + 1, samples.Size());
  {
    Pen pen(map.area, curve);
    if (end - begin <= 2 * std::size_t(std::max(columns, 1))) {
      for (std::size_t i = from; i < to; ++i) {
        AddSample(pen, samples, holds && i > from, map, i);
      }
    } else {
      if (from < begin) {
        pen.To(map.At(samples.Time(from), samples.Value(from)));
      }
      double last = from < begin ? samples.Value(from) : std::nan("");
      const std::vector<SampleColumn> all = samples.Decimate(map.x.low, map.x.high, columns);
      for (std::size_t c = 0; c < all.size(); ++c) {
        const SampleColumn& column = all[c];
        if (column.begin == column.end) {
          continue;
        }
        const double x = map.area.left() + map.area.width() * ((double(c) + 0.5) / columns);
        const auto put = [&](double value) { pen.To({x, map.At(map.x.low, value).y()}); };
        if (std::isnan(column.first)) {
          pen.Lift();
        } else if (holds && !std::isnan(last)) {
          put(last);
        }
        if (!std::isnan(column.extent.min)) {
          if (!std::isnan(column.first)) {
            put(column.first);
          }
          // The nearer end first: a shorter way, the same pixels.
          const bool up = !(std::abs(column.first - column.extent.max) <
                            std::abs(column.first - column.extent.min));
          put(up ? column.extent.min : column.extent.max);
          put(up ? column.extent.max : column.extent.min);
          if (!std::isnan(column.last)) {
            put(column.last);
          }
        }
        if (std::isnan(column.last)) {
          pen.Lift();
        }
        last = column.last;
      }
      if (end < to) {
        AddSample(pen, samples, holds, map, end);
      }
    }
    if (holds && to == samples.Size() && to > 0 && samples.Time(to - 1) < now) {
      pen.To(map.At(now, samples.Value(to - 1))); // still that value
    }
  }
  if (end > begin && FewSamples * double(end - begin) <= map.area.width()) {
    curve.dots.clear(); // they are among these
    for (std::size_t i = begin; i < end; ++i) {
      const QPointF point = map.At(samples.Time(i), samples.Value(i));
      if (!std::isnan(point.y()) && map.area.contains(point)) {
        curve.dots.push_back(point);
      }
    }
  }
  return curve;
}

PlotCurve PairCurve(const SampleSeries& x, bool xHolds, const SampleSeries& y, const PlotMap& map,
                    const PlotRange& times) {
  PlotCurve curve;
  Pen pen(map.area, curve);
  std::vector<std::pair<std::size_t, std::size_t>> todo = {
      {y.Lower(times.low), y.Upper(times.high)}};
  const auto put = [&](std::size_t i) { pen.To(map.At(x.At(y.Time(i), xHolds), y.Value(i))); };
  const double perX = map.area.width() / map.x.Length();
  const double perY = map.area.height() / map.y.Length();
  while (!todo.empty()) {
    const auto [begin, end] = todo.back();
    todo.pop_back();
    if (end - begin <= Leaf) {
      for (std::size_t i = begin; i < end; ++i) {
        put(i);
      }
      continue;
    }
    const SampleExtent high = y.Extent(begin, end);
    if ((high.max - high.min) * perY < OnePlace) {
      // With the samples of X around the interval: values between them are on their lines.
      const std::size_t first = x.Lower(y.Time(begin));
      const std::size_t last = x.Upper(y.Time(end - 1));
      const SampleExtent wide = x.Extent(first > 0 ? first - 1 : 0, std::min(last + 1, x.Size()));
      if ((wide.max - wide.min) * perX < OnePlace) {
        put(begin);
        put(end - 1);
        continue;
      }
    }
    const std::size_t middle = begin + (end - begin) / 2;
    todo.emplace_back(middle, end);
    todo.emplace_back(begin, middle);
  }
  return curve;
}

} // namespace dspace::widgets
