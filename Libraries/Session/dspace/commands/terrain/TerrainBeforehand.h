// A terrain that is opened before its command is executed.
#ifndef DSPACE_SESSION_TERRAIN_BEFOREHAND_H
#define DSPACE_SESSION_TERRAIN_BEFOREHAND_H

#include <functional>
#include <optional>
#include <string>

#include <Eigen/Core>

#include <dspace/proto/layers.pb.h>
#include <dspace/proto/terrain.pb.h>
#include <dspace/state/ReadBeforehand.h>
#include <dspace/state/State.h>

namespace dspace::session {

// The name of a terrain that is given none.
std::string FreeTerrainName(const SceneState& state);

// Towards the scene's Sun in the terrain's frame, where a relief of triangles takes its light from
// there; none: it does not, or the Sun is off. In the session's thread. Throws Error(NotFound) for
// an unknown frame.
std::optional<Eigen::Vector3d> ReliefSun(const Scene& scene, const v1::OpenTerrain& command);

// Opens the terrain of a command that has a name; in any thread. `sun_S`: ReliefSun(). Throws what
// the command gives for its files.
void ReadTerrain(const v1::OpenTerrain& command, const std::optional<Eigen::Vector3d>& sun_S,
                 ReadBeforehand& into);

// In the session's thread: what opens the layer of a command, in any thread; null: nothing is to be
// read, or the command itself reads it or gives the error. It throws what the command gives for its
// file.
std::function<void(ReadBeforehand&)> LayerReader(SceneState& state,
                                                 const v1::AddTerrainLayer& command);

} // namespace dspace::session

#endif
