// What the user asks for in a scene tree as commands of a session.
#ifndef DSPACE_WIDGETS_SCENE_COMMANDS_H
#define DSPACE_WIDGETS_SCENE_COMMANDS_H

#include <string>

class vtkDspaceSession;

namespace dspace::widgets {

class SceneTreeWidget;

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

} // namespace dspace::widgets

#endif
