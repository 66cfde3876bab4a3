// What a plot shows.
#ifndef DSPACE_WIDGETS_PLOT_STATE_H
#define DSPACE_WIDGETS_PLOT_STATE_H

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include <QColor>
#include <QString>

#include <dspace/widgets/telemetry/PlotAxis.h>
#include <dspace/widgets/telemetry/SampleSeries.h>

namespace dspace::widgets {

struct PlotSeries {
  QString name;
  QString unit; // empty: none
  std::shared_ptr<SampleSeries> samples;
  bool holds = false; // values hold until they change: steps in place of slopes
  bool shown = true;
  int color = 0; // a number of ColorOf()

  QString Title() const {
    return this->unit.isEmpty() ? this->name : this->name + " [" + this->unit + "]";
  }
};

// An axis of values, for all series of its unit.
struct PlotValueAxis {
  QString unit;
  PlotRange range;
};

struct PlotState {
  std::vector<PlotSeries> series;
  std::vector<PlotValueAxis> axes; // the first, third, ... on the left, the others on the right
  PlotRange time;                  // [s]
  // X-Y: the series along X, which is not drawn itself, and its range. Empty, or the name of no
  // series: X is the time.
  QString xName;
  PlotRange xValues;
  PlotRange xTimes;                             // X-Y: samples of these times are shown
  std::optional<double> current;                // the timeline's time [s]
  std::array<std::optional<double>, 2> cursors; // times [s]

  const PlotSeries* XSeries() const {
    for (const PlotSeries& each : this->series) {
      if (!this->xName.isEmpty() && each.name == this->xName) {
        return &each;
      }
    }
    return nullptr;
  }
  const PlotRange& XRange() const { return this->XSeries() ? this->xValues : this->time; }
  bool IsDrawn(const PlotSeries& each) const { return each.shown && &each != this->XSeries(); }
  // Of the series' unit; -1: there is none.
  int AxisOf(const PlotSeries& each) const {
    for (std::size_t i = 0; i < this->axes.size(); ++i) {
      if (this->axes[i].unit == each.unit) {
        return int(i);
      }
    }
    return -1;
  }
};

} // namespace dspace::widgets

#endif
