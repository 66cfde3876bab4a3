// Keys of views that mean the window: time, selection, help.
#ifndef DSPACE_WIDGETS_VIEW_KEYS_H
#define DSPACE_WIDGETS_VIEW_KEYS_H

#include <functional>
#include <map>
#include <string>

#include <QObject>

namespace dspace::widgets {

class MeasureMarks;
class MovieTrack;
class TimelineWidget;
class ViewPanes;
class ViewSelection;
class ViewportWidget;

// Space plays and pauses where the time can be played, K adds a camera key of a recording, F shows
// the selection, H shows the keys, Escape ends the table of keys, a preview, a measurement or the
// selection, in this order, and then goes on to the view, which cancels a drag. All other keys are
// the view's.
class ViewKeys : public QObject {
  Q_OBJECT

public:
  // All must outlive it. `run`: runs a line of Python.
  ViewKeys(TimelineWidget* timeline, ViewSelection* selection, MovieTrack* movies,
           MeasureMarks* marks, std::function<bool(const QString& python)> run, QObject* parent);

  void Add(ViewportWidget* widget, const std::string& viewport);

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  bool Take(ViewportWidget* widget, const QString& view, int key);

  TimelineWidget* Timeline_;
  ViewSelection* Selection_;
  MovieTrack* Movies_;
  MeasureMarks* Marks_;
  std::function<bool(const QString&)> Run_;
  std::map<QObject*, QString> Views_; // as Python
};

} // namespace dspace::widgets

#endif
