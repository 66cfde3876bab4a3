// A widget that shows the clock of a simulation, and moves through a recording.
#ifndef DSPACE_WIDGETS_TIMELINE_WIDGET_H
#define DSPACE_WIDGETS_TIMELINE_WIDGET_H

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <QWidget>

#include <dspace/widgets/timeline/TimeSource.h>
#include <dspace/widgets/timeline/TimelineMarks.h>

namespace dspace::widgets {

class KeyTrack;
class ScrubBar;

// Buttons, the clock (UTC, time since the beginning of the range, seconds past J2000), the
// real-time factor, and a bar with events and marks. Space plays and pauses, the arrows step, Home
// and End go to the ends, [ and ] set the ends of the loop, M sets a mark. It drives its time
// source up to 30 times a second, also while it is hidden. What a source throws is shown, and told
// by failed(). The side file of marks is read and written by a thread of its own.
class TimelineWidget : public QWidget {
  Q_OBJECT

public:
  explicit TimelineWidget(QWidget* parent = nullptr);
  // Waits until marks are written.
  ~TimelineWidget() override;

  void SetSource(std::shared_ptr<TimeSource> source); // null: none
  const std::shared_ptr<TimeSource>& Source() const;
  // Keeps the marks in a file (MarksPath); "": only in memory.
  void SetMarksFile(const std::string& path);
  const std::vector<TimelineMark>& Marks() const; // by time
  void PutMark(const TimelineMark& mark);         // adds it, or changes the one with its id
  void EraseMark(const std::string& id);
  // The real-time factor that is shown; none: not known yet.
  std::optional<double> Rate() const;
  // Drives the source and shows its state now. `wall_s`: the wall clock [s]; none: the system's.
  void Refresh(std::optional<double> wall_s = {});
  ScrubBar* Bar() const;
  // Camera keys below the bar, hidden at first; K asks it for a key at the present time.
  KeyTrack* Keys() const;
  // A button beside the others.
  void AddTool(QWidget* tool);

  // Where it is narrow, the clock has the elapsed time and the real-time factor alone.
  QSize minimumSizeHint() const override;

signals:
  void timeChanged(double time_s);
  void marksChanged(); // in memory, or as the file was read
  void failed(const QString& message);

protected:
  void resizeEvent(QResizeEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void changeEvent(QEvent* event) override;

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
