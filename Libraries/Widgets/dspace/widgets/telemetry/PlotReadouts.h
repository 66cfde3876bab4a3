// The values at the cursors of a plot, as a table.
#ifndef DSPACE_WIDGETS_PLOT_READOUTS_H
#define DSPACE_WIDGETS_PLOT_READOUTS_H

#include <QFont>
#include <QPainter>
#include <QPalette>
#include <QRectF>

#include <dspace/widgets/telemetry/PlotState.h>

namespace dspace::widgets {

// Times and values of the cursors A and B, and their differences: a row for the times and one for
// each shown series, of up to eight. It takes its room below the curves, as long as they keep
// enough of the height; else beside them; where that leaves too little width, nowhere.
class PlotReadouts {
public:
  // `room`: of curves, axes and table [painter units]. `below`: the height of what lies between the
  // curves and the table: ticks and titles.
  PlotReadouts(const PlotState& state, const QFont& font, const QPalette& palette,
               const QRectF& room, double below);

  const QRectF& Area() const { return this->Area_; } // empty: no cursor, or no room
  const QRectF& Rest() const { return this->Rest_; } // of the room, for curves and axes
  bool IsBeside() const { return this->Beside_; }
  // The state may have other times and values than it had, but no other series.
  void Paint(QPainter& painter) const;

private:
  const PlotState& State_;
  QFont Font_;
  QPalette Palette_;
  double Line_; // height of a line of text
  QRectF Area_;
  QRectF Rest_;
  bool Beside_ = false;
};

} // namespace dspace::widgets

#endif
