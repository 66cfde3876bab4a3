// The movie of a recording in a window: its key frames on the timeline, a menu, dialogs.
#ifndef DSPACE_WIDGETS_MOVIE_TRACK_H
#define DSPACE_WIDGETS_MOVIE_TRACK_H

#include <functional>
#include <map>

#include <QJsonObject>
#include <QObject>

class QAction;
class QMenu;
class QWidget;
class vtkObject;

namespace dspace::widgets {

class ShownScenes;
class TimelineWidget;

// Shows the keys of the recording in the docks (dspace.application.key_frames.KeyFrames tells them)
// and asks for changes by lines of Python on app.movie.
class MovieTrack : public QObject {
  Q_OBJECT

public:
  struct Host {
    std::function<bool(const QString& python)> run;    // as the user's own line
    std::function<void(const QString& python)> inform; // without a trace
    std::function<QString()> view;                     // the view that is used, as Python
    std::function<void(const QString& message)> report;
  };
  // All must outlive it.
  MovieTrack(QWidget* window, TimelineWidget* timeline, ShownScenes* scenes, Host host);
  ~MovieTrack() override;

  // {"do": "keys", "of": "Addr=0x...", "keys": [{"run", "time", "cut", "rest", "low", "high",
  //  "lens", "value", "frame", "position"}], "file", "size", "rate", "samples", "duration",
  //  "preview", "follows", "view", "path"}
  static bool Handles(const QJsonObject& request);
  void Handle(const QJsonObject& request);

  QMenu* Menu() const { return this->Menu_; }
  // A key at the present time, where the camera of the view is; false: there is no recording.
  bool AddKey();
  // Ends a preview; false: there is none.
  bool Stop();

private:
  void Show();
  bool HasKeys() const;
  QJsonObject State() const; // of the recording in the docks; empty: there is none
  void FillMenu();
  void FillKeyMenu(QMenu& menu, int key, double run_s);
  void Add(double run_s);
  void AddFrozen(int key);
  void Freeze(int key);
  void Edit(int key);
  void Export();
  void Load();
  void Save();

  QWidget* Window_;
  TimelineWidget* Timeline_;
  ShownScenes* Scenes_;
  Host Host_;
  QMenu* Menu_;
  std::map<QString, QJsonObject> States_; // by what they are of
};

} // namespace dspace::widgets

#endif
