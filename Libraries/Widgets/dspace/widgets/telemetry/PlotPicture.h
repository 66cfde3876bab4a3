// The picture of a plot: where everything is, and how it is painted.
#ifndef DSPACE_WIDGETS_PLOT_PICTURE_H
#define DSPACE_WIDGETS_PLOT_PICTURE_H

#include <optional>
#include <vector>

#include <QFont>
#include <QPainter>
#include <QPalette>
#include <QRectF>

#include <dspace/widgets/telemetry/PlotCurve.h>
#include <dspace/widgets/telemetry/PlotReadouts.h>
#include <dspace/widgets/telemetry/PlotState.h>

namespace dspace::widgets {

// The colour of a series' number on a light or dark ground; 8 differ.
QColor ColorOf(int number, const QPalette& palette);

// From the ground's colour (0) to the text's (1).
QColor MixedColor(const QPalette& palette, double part);

// A number with its unit: 7 digits, or as many as given.
QString WithUnit(double value, const QString& unit, int digits = 7);

class PlotPicture {
public:
  // A size in units of the painter; `ratio`: device pixels in one.
  PlotPicture(const PlotState& state, const QSizeF& size, const QFont& font,
              const QPalette& palette, double ratio);

  // Everything but what moves often.
  void PaintGround(QPainter& painter) const;
  // The current time, cursors and their read-outs.
  void PaintMarks(QPainter& painter) const;

  struct Axis {
    QRectF area;
    bool left = true;
    PlotTicks ticks;
    double textWidth = 0.0; // of the widest tick
  };
  struct LegendEntry {
    QRectF area;
    int series = 0;
    QString text; // elided
  };

  const QRectF& Area() const { return this->Area_; }
  const QRectF& XArea() const { return this->XArea_; }
  QRectF ReadoutArea() const { return this->Readouts_->Area(); } // empty: there is none
  const std::vector<Axis>& Axes() const { return this->Axes_; }  // as PlotState::axes
  const PlotTicks& XTicks() const { return this->XTicks_; }
  const std::vector<LegendEntry>& Legend() const { return this->Legend_; }
  QString XTitle() const;
  PlotMap MapOf(int axis) const;
  // Where a series is at a time; none: it has no value then, or is not within the area.
  std::optional<QPointF> PlaceOf(const PlotSeries& series, double time_s) const;
  // The nearest sample that is drawn within a distance [painter units]; series -1: none.
  struct Hit {
    int series = -1;
    std::size_t sample = 0;
  };
  Hit Nearest(const QPointF& place, double distance) const;

private:
  void PaintAxis(QPainter& painter, int number) const;
  void PaintXTitle(QPainter& painter) const;
  QString TitleOf(int axis) const;
  QColor Mixed(double part) const; // of the text's colour in the ground's
  bool IsPairs() const { return this->State_.XSeries() != nullptr; }

  const PlotState& State_;
  QSizeF Size_;
  QFont Font_;
  QPalette Palette_;
  double Ratio_;
  double Line_; // height of a line of text
  QRectF Area_;
  QRectF XArea_;
  bool Low_ = false;                     // a low picture saves height: titles and legend are short
  std::optional<PlotReadouts> Readouts_; // always there, after the layout
  PlotTicks XTicks_;
  std::vector<Axis> Axes_;
  std::vector<LegendEntry> Legend_;
  int LegendHidden_ = 0;
  QRectF LegendMore_;
};

} // namespace dspace::widgets

#endif
