// What the user asks for in a scene tree as commands of a session.
#ifndef DSPACE_WIDGETS_SCENE_COMMANDS_H
#define DSPACE_WIDGETS_SCENE_COMMANDS_H

#include <functional>
#include <string>

#include <QString>

#include <dspace/widgets/scene/SceneTreeWidget.h>

class vtkDspaceSession;

namespace dspace::widgets {

// The widget shows the session's scene of this name, also after a playback has replaced it, and its
// requests become commands, which are recorded:
//   show, hide  SetObjectVisible of the object, or of all objects on the frame and below
//   chase       SetCamera of the vantage's active camera (where there is none, of a new one
//               "main"): behind the frame at three and a half times the size of what is on it and
//               below, or 5 m away
//   focus       FitCamera and SetCamera: the camera keeps its direction
//   trail       CreateTrail of an ornamental "trail of PATH" in the root frame, which from then on
//               gets a point after every command that moves the frame; RemoveObject, if it is there
//   axes        CreatePrimitive of ornamental "axes of PATH", as long as the frame's origin is from
//               the end of what is on it and below, or 1 m; RemoveObject, if they are there
// An error of a reply is thrown as dspace::Error, which the widget shows; of several objects those
// before it are changed. The widget keeps the session.
void ConnectToSession(SceneTreeWidget& widget, vtkDspaceSession* session, const std::string& scene,
                      const std::string& vantage = "main");

// The same in two steps, for a widget that shows one scene and then another: the trails of a scene
// go on for as long as its actions are kept.
struct SceneActions {
  SceneTreeWidget::Source source;
  SceneTreeWidget::Handler handler;
  std::function<QString(ObjectId)> kinds;
};
// `execute` takes a serialized command and returns the reply; empty: vtkDspaceSession::Execute.
SceneActions ActionsOf(vtkDspaceSession* session, const std::string& scene,
                       const std::string& vantage = "main",
                       std::function<std::string(const std::string&)> execute = {});
void Connect(SceneTreeWidget& widget, const SceneActions& actions);

} // namespace dspace::widgets

#endif
