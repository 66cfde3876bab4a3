// The files of a command, read in another thread.
#ifndef DSPACE_SESSION_READ_FILES_H
#define DSPACE_SESSION_READ_FILES_H

#include <functional>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include <dspace/proto/commands.pb.h>
#include <dspace/state/ReadBeforehand.h>
#include <dspace/state/State.h>

namespace dspace::session {

// Whether the command reads files that may take long: ImportObject, ImportNodes, LoadRobot,
// OpenTerrain, AddTerrainLayer.
bool ReadsFiles(const v1::Command& command);

// Whether the session holds all models of an ImportObject or ImportNodes, so that reading takes no
// time.
bool HasFiles(State& state, const v1::Command& command);

// What reading takes from the state.
struct StateBeforehand {
  std::optional<Eigen::Vector3d> sun_S;       // ReliefSun() of a terrain
  std::function<void(ReadBeforehand&)> layer; // LayerReader(); null: there is none
};

// In the session's thread, before ReadFiles(): gives a command names that depend on the state (of
// a terrain that has none), so that what is read fits, and returns what else it takes.
StateBeforehand NameBeforehand(State& state, v1::Command& command);

// In any thread: uses nothing of a session. Execute the same command then with
// ReadBeforehand::Scope. Throws the Error that the command would give for its files; files of a
// robot's visuals that cannot be read are left to the command, which may replace them.
std::shared_ptr<ReadBeforehand> ReadFiles(const v1::Command& command,
                                          const StateBeforehand& state = {});

} // namespace dspace::session

#endif
