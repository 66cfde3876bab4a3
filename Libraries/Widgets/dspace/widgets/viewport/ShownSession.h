// What a view is of: a session of this process, a recording, or a server's session.
#ifndef DSPACE_WIDGETS_SHOWN_SESSION_H
#define DSPACE_WIDGETS_SHOWN_SESSION_H

#include <string>

#include "vtkObject.h"
#include "vtkSmartPointer.h"

class vtkDspacePlayer;
class vtkDspaceSession;
class vtkDspaceViewport;
class vtkDspaceWatcher;

namespace dspace::widgets {

// A vtkDspaceSession, vtkDspacePlayer or vtkDspaceWatcher, which it keeps.
class ShownSession {
public:
  // Throws Error(WrongType) for any other object.
  explicit ShownSession(vtkObject* of);

  vtkObject* Of() const { return this->Of_; }
  vtkDspacePlayer* Player() const;   // null: it is none
  vtkDspaceWatcher* Watcher() const; // null: it is none
  // The session that draws at present; never null.
  vtkDspaceSession* Session() const;
  // Carries out a serialized command; returns the reply.
  std::string Execute(const std::string& command) const;
  // Null: it is not there at present, also while a playback is between two steps.
  vtkDspaceViewport* Viewport(const std::string& name) const;
  // The scene of a viewport; "": there is no such viewport.
  std::string SceneOf(const std::string& viewport) const;

private:
  vtkSmartPointer<vtkObject> Of_;
};

} // namespace dspace::widgets

#endif
