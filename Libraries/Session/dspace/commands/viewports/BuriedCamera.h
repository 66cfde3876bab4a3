// Cameras inside the ground.
#ifndef DSPACE_SESSION_BURIED_CAMERA_H
#define DSPACE_SESSION_BURIED_CAMERA_H

#include <map>
#include <string>

#include <dspace/scene/Camera.h>
#include <dspace/state/State.h>

namespace dspace::session {

// The shown terrains below whose ground the camera's eye is, by name: how far along the local
// vertical [m], above 0. Under a hole of its data it is below nothing.
std::map<std::string, double> GroundsOver(const SceneState& state, const CameraPose& camera);

} // namespace dspace::session

#endif
