// The scenes that a window shows, and which of them is in its docks.
#ifndef DSPACE_WIDGETS_SHOWN_SCENES_H
#define DSPACE_WIDGETS_SHOWN_SCENES_H

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include <QJsonObject>
#include <QObject>

class QWidget;
class vtkDspaceSession;
class vtkObject;

namespace dspace::session {
class MessageLog;
class Telemetry;
struct SceneState;
} // namespace dspace::session

namespace dspace::widgets {

class SceneTreeWidget;
class TimelineWidget;
class ViewportWidget;
class TimeSource;

// Scenes of the window's own session, of recordings and of servers (ShownSession.h). The scene
// whose view was used last is in the tree and on the timeline; a list above the tree, which is
// there where there are several, chooses another one. Recordings play and servers are followed
// whether they are in the docks or not.
class ShownScenes : public QObject {
  Q_OBJECT

public:
  // The tree below a list of scenes, for the constructor.
  static QWidget* WithChoice(SceneTreeWidget* tree);
  // `scene`: of the own session, shown first. All must outlive it.
  ShownScenes(vtkDspaceSession* own, const std::string& scene, SceneTreeWidget* tree,
              TimelineWidget* timeline, QObject* parent);
  ~ShownScenes() override;

  // `title` names it in the list. Nothing happens if it is known.
  void Add(vtkObject* of, const QString& title);
  void Forget(vtkObject* of);
  // Puts a scene into the docks. Nothing happens if it is not known.
  void Activate(vtkObject* of, const std::string& scene);
  // The scene of this view goes into the docks when the widget gets the focus.
  void Watch(ViewportWidget* widget, vtkObject* of, const std::string& viewport);
  // PythonHost::clock. Throws Error: NotFound, and those of the clock.
  void AskClock(vtkObject* of, const std::string& what, double a, double b);
  // The scene in the docks.
  std::pair<vtkObject*, std::string> ActiveScene() const;
  // The channels of a scene; null: there is no such scene now. They may be gone after any command.
  const session::Telemetry* TelemetryOf(vtkObject* of, const std::string& scene) const;
  // Likewise: its events and open questions.
  const session::MessageLog* MessagesOf(vtkObject* of, const std::string& scene) const;
  // Runs a line of Python that stands for what the tree asks for (TreeActions.h); false: it cannot
  // run now, and the request is carried out without it.
  using Runner = std::function<bool(const QString& line)>;
  void SetRunner(Runner runner);
  // Carries out such a line's request in the scene in the docks. Throws what RequestOf and the
  // command throw.
  void Act(const QJsonObject& request);
  // What is in the docks: the text of the list, and its clock.
  QString Active() const;
  TimeSource* Clock() const;

signals:
  void activated();
  void failed(const QString& message);

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  const session::SceneState* StateOf(vtkObject* of, const std::string& scene) const; // or null

  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
