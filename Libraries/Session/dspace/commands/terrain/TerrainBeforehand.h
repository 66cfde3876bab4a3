// A terrain that is opened before its command is executed.
#ifndef DSPACE_SESSION_TERRAIN_BEFOREHAND_H
#define DSPACE_SESSION_TERRAIN_BEFOREHAND_H

#include <string>

#include <dspace/proto/terrain.pb.h>
#include <dspace/state/ReadBeforehand.h>
#include <dspace/state/State.h>

namespace dspace::session {

// The name of a terrain that is given none.
std::string FreeTerrainName(const SceneState& state);

// Opens the terrain of a command that has a name, where it is drawn as a clipmap; in any thread.
// Throws what the command gives for its files.
void ReadTerrain(const v1::OpenTerrain& command, ReadBeforehand& into);

} // namespace dspace::session

#endif
