// A widget that plots channels against time or against each other.
#ifndef DSPACE_WIDGETS_TELEMETRY_PLOT_WIDGET_H
#define DSPACE_WIDGETS_TELEMETRY_PLOT_WIDGET_H

#include <memory>
#include <optional>

#include <QStringList>
#include <QWidget>

#include <dspace/widgets/telemetry/PlotAxis.h>
#include <dspace/widgets/telemetry/SampleSeries.h>
#include <dspace/widgets/telemetry/TelemetrySource.h>

namespace dspace::widgets {

// Series of samples as curves, with an axis of values for each unit. It follows its series up to 30
// times a second.
//
// Wheel: zooms at the pointer; over an axis only along it, with Ctrl only along X, with Shift only
// along the values. Left drag: moves; of a cursor or of the current time: moves it. Right drag:
// zooms to the rectangle. Double click: shows all, and follows what is new. Left click: chooses the
// time. A click on a legend entry hides and shows its series. Right click: menu. Keys: A and B put
// a cursor at the pointer, Escape removes both, Home shows all, + and - zoom, arrows move. Channels
// dropped on it are added (ChannelMime.h); one that is dropped below the plot becomes X.
//
// Times are seconds. What fails is shown, and told by failed().
class TelemetryPlotWidget : public QWidget {
  Q_OBJECT

public:
  explicit TelemetryPlotWidget(QWidget* parent = nullptr);
  // Cancels tables that are being written, and waits for other files.
  ~TelemetryPlotWidget() override;

  // Where channels take their samples from: their values when the widget looks, also while it is
  // hidden. Where the source's time goes back, later samples are removed.
  void SetSource(TelemetrySource source); // empty: none
  // Adds a channel of the source. Its values hold until they change. Throws Error: NotFound without
  // such a channel, InvalidArgument for texts. A channel that is plotted already is shown.
  void AddChannel(const QString& name);
  // Looks at the source now, and shows what is new. Who wants each step of a simulation calls it
  // after each.
  void Refresh();

  // Adds the caller's samples, which the caller may append to, in the widget's thread. Names are
  // unique; one that is plotted already is replaced.
  void AddSeries(const QString& name, const QString& unit, std::shared_ptr<SampleSeries> samples,
                 bool holds = false);
  void RemoveSeries(const QString& name); // none: nothing
  void RemoveAll();
  QStringList Series() const;
  std::shared_ptr<SampleSeries> Samples(const QString& name) const; // null: there is none
  void SetShown(const QString& name, bool shown);
  bool IsShown(const QString& name) const;

  // X-Y mode: one series along X, the others against it at equal times. "": X is the time. Throws
  // Error(NotFound) if no series has the name.
  void SetXSeries(const QString& name);
  QString XSeries() const;

  // While it follows: only the last seconds are shown. 0: all. Throws Error(InvalidArgument) below
  // 0 and for what is not finite.
  void SetWindow(double seconds);
  double Window() const;
  // Shows all, or the window, and follows what is new, until ranges are set or the user zooms.
  void ShowAll();
  bool IsFollowing() const;

  // Along X; times, but for X-Y mode. Ranges become what can be shown (PlotAxis.h).
  PlotRange XRange() const;
  void SetXRange(const PlotRange& range);
  // Of an axis of values: 0 to 1 for a unit that none has.
  QStringList Units() const;
  PlotRange ValueRange(const QString& unit) const;
  void SetValueRange(const QString& unit, const PlotRange& range);

  // A line at a time; none: no line.
  void SetCurrentTime(std::optional<double> time_s);
  std::optional<double> CurrentTime() const;
  // Cursors 0 (A) and 1 (B), with read-outs of times, values and their differences.
  void SetCursor(int cursor, std::optional<double> time_s);
  std::optional<double> Cursor(int cursor) const;
  // The value of a series at a time; NaN: none.
  double ValueAt(const QString& name, double time_s) const;

  // Write a file in a thread of their own; exported() or failed() tells the end. A file that is
  // there is replaced as a whole or stays. Pictures are of this size of this widget.
  // The table has all samples of the shown series, or those in view (SampleCsv.h).
  void ExportCsv(const QString& path, bool inView = false);
  void ExportPng(const QString& path,
                 double scale = 1.0); // pixels per unit of the widget, 0.1 to 8
  void ExportSvg(const QString& path);

  // Where the curves are, in the widget.
  QRectF PlotArea() const;
  QRectF XAxisArea() const;
  QRectF ValueAxisArea(const QString& unit) const; // empty: there is none
  QRectF LegendArea(const QString& name) const;    // empty: there is none
  // Of the cursors: below the curves, or beside them where these would have too little height.
  QRectF ReadoutArea() const; // empty: no cursor is set, or there is no room
  // Where a series is at a time; none: out of view.
  std::optional<QPointF> PlaceOf(const QString& name, double time_s) const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

signals:
  // By the user; 0.4 s after a click, because a second one would make it a double click.
  void timeChosen(double time_s);
  void channelDropped(const QString& name); // it is no channel of the source
  void seriesChanged();
  void exported(const QString& path);
  void failed(const QString& message);

protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dragMoveEvent(QDragMoveEvent* event) override;
  void dragLeaveEvent(QDragLeaveEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  bool event(QEvent* event) override;

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
