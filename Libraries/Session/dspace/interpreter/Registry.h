// The handlers of all commands.
#ifndef DSPACE_SESSION_REGISTRY_H
#define DSPACE_SESSION_REGISTRY_H

#include <functional>
#include <map>

#include <dspace/messages/CommandTraits.h>
#include <dspace/proto/commands.pb.h>
#include <dspace/state/State.h>

namespace dspace::session {

// The arguments of a handler. `scene` is null for commands that need no scene.
struct Context {
  State& state;
  SceneState* scene;
  const std::string& sceneName;
  v1::Reply& reply;

  Scene& GetScene() const { return *this->scene->scene; }
  FrameTree& Frames() const { return this->scene->scene->Frames(); }
};

enum class Needs { Scene, Nothing };

// The handlers by command. A handler checks all input before it changes anything and throws
// dspace::Error. It writes ids and names that it chooses into the command, so that the recorded
// command gives the same result.
class Registry {
public:
  struct Entry {
    Effect effect;
    Needs needs;
    std::function<void(const Context&, v1::Command&)> run;
  };

  // `get` is v1::Command::mutable_..., which selects the command. Throws Error(Internal) if the
  // command's .proto lacks an option (CommandTraits).
  template<class Message, class Handler>
  void Add(v1::Command::CommandCase kind, Message* (v1::Command::*get)(), Handler handler,
           Needs needs = Needs::Scene) {
    this->Entries_[kind] = {CommandTraits::Find(kind)->GetEffect(), needs,
                            [get, handler](const Context& context, v1::Command& command) {
                              handler(context, *(command.*get)());
                            }};
  }
  const Entry* Find(v1::Command::CommandCase kind) const {
    const auto found = this->Entries_.find(kind);
    return found == this->Entries_.end() ? nullptr : &found->second;
  }

private:
  std::map<v1::Command::CommandCase, Entry> Entries_;
};

// One function for each subject.
void AddSceneCommands(Registry& registry);
void AddFrameCommands(Registry& registry);
void AddObjectCommands(Registry& registry);
void AddObjectRequests(Registry& registry);
void AddPrimitiveCommands(Registry& registry);
void AddMeshCommands(Registry& registry);
void AddDrawnCommands(Registry& registry);
void AddBodyCommands(Registry& registry);
void AddStarCommands(Registry& registry);
void AddTrailCommands(Registry& registry);
void AddTrajectoryCommands(Registry& registry);
void AddRobotCommands(Registry& registry);
void AddNodeCommands(Registry& registry);
void AddFragmentCommands(Registry& registry);
void AddSunCommands(Registry& registry);
void AddSkyCommands(Registry& registry);
void AddCameraCommands(Registry& registry);
void AddLensRequests(Registry& registry);
void AddTerrainCommands(Registry& registry);
void AddSightRequests(Registry& registry);
void AddLitAreaRequest(Registry& registry);
void AddRangeRequests(Registry& registry);
void AddMapRequests(Registry& registry);
void AddWorkRequests(Registry& registry);
void AddExportCommands(Registry& registry);
void AddTelemetryCommands(Registry& registry);
void AddMessageCommands(Registry& registry);
void AddTextCommands(Registry& registry); // needs VTK: in the VTK module, not in the plain library

} // namespace dspace::session

#endif
