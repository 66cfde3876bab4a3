// The camera key frames of a movie, below the bar of a timeline.
#ifndef DSPACE_WIDGETS_KEY_TRACK_H
#define DSPACE_WIDGETS_KEY_TRACK_H

#include <memory>
#include <vector>

#include <QWidget>

class QMenu;

namespace dspace::widgets {

class ScrubBar;

// A key frame on the timeline.
struct TimelineKey {
  double run_s = 0.0;   // time of the run, where it is shown
  double movie_s = 0.0; // time of the movie
  double low_s = 0.0;   // run times, both excluded, between which it can be moved
  double high_s = 0.0;
  bool cut = false;  // a new shot begins
  bool rest = false; // the camera stops
  QString text;      // of the tool tip

  bool operator==(const TimelineKey& o) const {
    return this->run_s == o.run_s && this->movie_s == o.movie_s && this->low_s == o.low_s &&
           this->high_s == o.high_s && this->cut == o.cut && this->rest == o.rest &&
           this->text == o.text;
  }
};

// Shows keys at the times of the bar above it: neighbours with equal run times are one mark with
// the seconds for which the run stands still, cuts are bars. A click selects a key and goes to its
// time, a drag moves it, a double click or Return edits it, Delete removes it, a double click
// beside keys adds one. It only asks: what it shows is what SetKeys() told it.
class KeyTrack : public QWidget {
  Q_OBJECT

public:
  explicit KeyTrack(ScrubBar* bar, QWidget* parent = nullptr);
  ~KeyTrack() override;

  void SetKeys(std::vector<TimelineKey> keys); // in the order of the movie
  const std::vector<TimelineKey>& Keys() const;
  int Selected() const; // -1: none
  void Select(int key);
  // Shown in place of keys where there are none.
  void SetHint(const QString& hint);
  // A word on the state at the right end, such as "preview".
  void SetNote(const QString& note);
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

signals:
  void goAsked(double run_s);
  void addAsked(double run_s);
  void moveAsked(int key, double run_s);
  void editAsked(int key);
  void eraseAsked(int key);
  void menuWanted(QMenu* menu, int key, double run_s); // key -1: beside keys; fill the menu

protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;
  bool event(QEvent* event) override;

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
