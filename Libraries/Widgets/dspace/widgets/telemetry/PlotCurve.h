// The lines of a series in pixels.
#ifndef DSPACE_WIDGETS_PLOT_CURVE_H
#define DSPACE_WIDGETS_PLOT_CURVE_H

#include <vector>

#include <QPointF>
#include <QPolygonF>
#include <QRectF>

#include <dspace/widgets/telemetry/PlotAxis.h>
#include <dspace/widgets/telemetry/SampleSeries.h>

namespace dspace::widgets {

// Where a plot's rectangle shows two ranges.
struct PlotMap {
  QRectF area; // the low ends are left and at the bottom
  PlotRange x;
  PlotRange y;

  QPointF At(double valueX, double valueY) const {
    return {this->area.left() + this->area.width() * ((valueX - this->x.low) / this->x.Length()),
            this->area.bottom() -
                this->area.height() * ((valueY - this->y.low) / this->y.Length())};
  }
  double XAt(double place) const {
    return this->x.low + this->x.Length() * ((place - this->area.left()) / this->area.width());
  }
  double YAt(double place) const {
    return this->y.low + this->y.Length() * ((this->area.bottom() - place) / this->area.height());
  }
};

struct PlotCurve {
  std::vector<QPolygonF> lines; // within the area
  std::vector<QPointF> dots;    // samples that no line shows, or samples that are few
  double travel = 0.0;          // vertical, of all lines [pixels]
};

// Against time. Of more than two samples a column it draws the least, greatest, first and last
// value of each column: the same pixels. `columns`: of the device. The last value that holds is
// drawn up to the time `now`.
PlotCurve TimeCurve(const SampleSeries& samples, bool holds, const PlotMap& map, int columns,
                    double now);

// One series against another, at the samples of `y` in an interval of time. Runs of samples that
// are all in one half pixel are drawn as their last one; else it takes time proportional to their
// number.
PlotCurve PairCurve(const SampleSeries& x, bool xHolds, const SampleSeries& y, const PlotMap& map,
                    const PlotRange& times);

} // namespace dspace::widgets

#endif
