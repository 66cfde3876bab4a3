// The bar of a timeline.
#ifndef DSPACE_WIDGETS_SCRUB_BAR_H
#define DSPACE_WIDGETS_SCRUB_BAR_H

#include <memory>
#include <vector>

#include <QWidget>

#include <dspace/widgets/timeline/TimeSource.h>
#include <dspace/widgets/timeline/TimelineMarks.h>

namespace dspace::widgets {

// Shows a range of times with ticks at round times since its beginning, events and marks with tool
// tips, gaps, the loop, and the present time. The left button scrubs; at a mark or an event it goes
// to its time; with Shift it selects the loop, whose ends can be dragged. The wheel zooms about the
// pointer, the middle button and the horizontal wheel move the view.
// It only asks: what it shows is what Set...() told it.
class ScrubBar : public QWidget {
  Q_OBJECT

public:
  explicit ScrubBar(QWidget* parent = nullptr);
  ~ScrubBar() override;

  void SetState(const TimeSource::State& state);
  void SetEvents(std::vector<TimelineEvent> events, std::vector<TimeRange> gaps);
  void SetMarks(std::vector<TimelineMark> marks);

  TimeRange View() const; // the times from the left to the right end of the bar
  void ShowAll();
  double TimeAt(double x) const; // of a pixel, cut to the range
  double PlaceOf(double time_s) const;
  // What the tool tip says at a place.
  QString TextAt(const QPoint& place) const;
  // Drawings of ticks, events and marks so far; the present time is drawn over them.
  int Drawings() const;
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

signals:
  void viewChanged(); // other times, or at other places
  void scrubbed(double time_s);
  void loopChosen(double begin_s, double end_s);
  void markAsked(double time_s);      // a new one
  void markOpened(const QString& id); // to edit its note
  void markErased(const QString& id);

protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;
  bool event(QEvent* event) override;

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
