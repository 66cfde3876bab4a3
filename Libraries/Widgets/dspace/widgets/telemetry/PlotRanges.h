// Which part of its series a plot shows.
#ifndef DSPACE_WIDGETS_PLOT_RANGES_H
#define DSPACE_WIDGETS_PLOT_RANGES_H

#include <QPointF>
#include <QRectF>

#include <dspace/widgets/telemetry/PlotPicture.h>
#include <dspace/widgets/telemetry/PlotState.h>

namespace dspace::widgets {

// Sets the ranges of a PlotState: they follow all samples, or the last seconds, until the user
// moves and zooms. Values follow on until they are moved themselves. It paints nothing.
class PlotRanges {
public:
  // Axes of values that Zoom() and Pan() move: one of PlotState::axes, or these.
  static constexpr int AllAxes = -1;
  static constexpr int NoAxis = -2;

  explicit PlotRanges(PlotState& state) : State_(state) {} // outlives this

  // Along X and along the values.
  void FollowAll();
  bool IsFollowing() const { return this->FollowsX_; } // along X
  // The last seconds that are shown while it follows; 0: all.
  double Window() const { return this->Window_; }
  void SetWindow(double seconds) { this->Window_ = seconds; }

  // Takes the ranges that follow from the samples, which have changed.
  void Follow();
  // Axes are those of the drawn series, in the order of these; ranges that are there stay.
  void SeriesChanged();

  void SetX(const PlotRange& range);
  void SetValues(PlotValueAxis& axis, const PlotRange& range);

  // By places and distances in the picture of the state. `factor` below 1 shows less.
  void Zoom(const PlotPicture& shown, const QPointF& place, double factor, bool alongX, int axis);
  void Pan(const PlotPicture& shown, const QPointF& by, bool alongX, int axis);
  // Nothing for a rectangle of less than 6 pixels a side. Returns whether it has changed ranges.
  bool ZoomTo(const PlotPicture& shown, const QRectF& rectangle);

private:
  SampleExtent Times() const;
  SampleExtent InTimes(const PlotSeries& series, const PlotRange& times) const;
  void FitValues(PlotValueAxis& axis) const;

  PlotState& State_;
  bool FollowsX_ = true;
  bool FollowsValues_ = true;
  double Window_ = 0.0;
};

} // namespace dspace::widgets

#endif
