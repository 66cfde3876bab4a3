#include <dspace/widgets/viewport/ShownSession.h>

#include "vtkDspacePlayer.h"
#include "vtkDspaceSession.h"
#include "vtkDspaceViewport.h"
#include "vtkDspaceWatcher.h"

#include <dspace/Error.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/state/State.h>

namespace dspace::widgets {

ShownSession::ShownSession(vtkObject* of) : Of_(of) {
  if (!this->Player() && !this->Watcher() && !vtkDspaceSession::SafeDownCast(of)) {
    throw Error(Error::Kind::InvalidArgument, "view",
                std::string("it is of a ") + (of ? of->GetClassName() : "null") +
                    "; accepted: a vtkDspaceSession, vtkDspacePlayer or vtkDspaceWatcher");
  }
}

vtkDspacePlayer* ShownSession::Player() const {
  return vtkDspacePlayer::SafeDownCast(this->Of_);
}

vtkDspaceWatcher* ShownSession::Watcher() const {
  return vtkDspaceWatcher::SafeDownCast(this->Of_);
}

vtkDspaceSession* ShownSession::Session() const {
  if (vtkDspacePlayer* player = this->Player()) {
    return player->GetSession();
  }
  if (vtkDspaceWatcher* watcher = this->Watcher()) {
    return watcher->GetSession();
  }
  return vtkDspaceSession::SafeDownCast(this->Of_);
}

std::string ShownSession::Execute(const std::string& command) const {
  if (vtkDspacePlayer* player = this->Player()) {
    return player->Execute(command);
  }
  if (vtkDspaceWatcher* watcher = this->Watcher()) {
    return watcher->Execute(command);
  }
  return this->Session()->Execute(command);
}

vtkDspaceViewport* ShownSession::Viewport(const std::string& name) const {
  vtkDspacePlayer* player = this->Player();
  return player && player->IsMoving() ? nullptr : this->Session()->GetViewport(name);
}

std::string ShownSession::SceneOf(const std::string& viewport) const {
  const auto& viewports = this->Session()->GetInterpreter().GetState().viewports;
  const auto found = viewports.find(viewport);
  return found == viewports.end() ? std::string() : found->second.scene;
}

} // namespace dspace::widgets
