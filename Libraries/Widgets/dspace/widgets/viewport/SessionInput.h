// Mouse and keyboard of a viewport's widget as commands of its session.
#ifndef DSPACE_WIDGETS_SESSION_INPUT_H
#define DSPACE_WIDGETS_SESSION_INPUT_H

#include <functional>
#include <string>

class vtkDspaceSession;

namespace dspace::widgets {

class ViewportWidget;

// From now on the widget's events become ViewportEvent commands, and its size a ResizeViewport, so
// that they are recorded, and callbacks hear of them. `told` gets each event and its reply,
// serialized, where the reply says more than that the camera moved; empty: nobody. The session must
// outlive the widget's events. An error of a reply is thrown as dspace::Error, which the widget
// shows.
void ConnectToSession(ViewportWidget& widget, vtkDspaceSession* session,
                      const std::string& viewport,
                      std::function<void(const std::string&, const std::string&)> told = {});

// The same with what carries out serialized commands and returns their replies, in place of
// vtkDspaceSession::Execute.
using Executor = std::function<std::string(const std::string&)>;
void ConnectToExecutor(ViewportWidget& widget, const Executor& execute, const std::string& viewport,
                       std::function<void(const std::string&, const std::string&)> told = {});

} // namespace dspace::widgets

#endif
