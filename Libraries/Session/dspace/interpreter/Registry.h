// Which function carries out which command.
#ifndef DSPACE_SESSION_REGISTRY_H
#define DSPACE_SESSION_REGISTRY_H

#include <functional>
#include <map>

#include <dspace/messages/CommandTraits.h>
#include <dspace/proto/commands.pb.h>
#include <dspace/state/State.h>

namespace dspace::session {

// What a handler works on. `scene` is null for the commands that need none.
struct Context {
  State& state;
  SceneState* scene;
  const std::string& sceneName;
  v1::Reply& reply;

  Scene& GetScene() const { return *this->scene->scene; }
  FrameTree& Frames() const { return this->scene->scene->Frames(); }
};

enum class Needs { Scene, Nothing };

// A handler checks all that it is given before it changes anything, throws dspace::Error, and
// writes ids and names that it chose into the command, so that the command as recorded replays.
class Registry {
public:
  struct Entry {
    Effect effect;
    Needs needs;
    std::function<void(const Context&, v1::Command&)> run;
  };

  // `get` is v1::Command::mutable_..., which names the command. Throws Error(Internal) where the
  // command's .proto lacks an option (CommandTraits).
  template<class Message, class Handler>
  void Add(v1::Command::CommandCase kind, Message* (v1::Command::*get)(), Handler handler,
           Needs needs = Needs::Scene) {
    this->Entries_[kind] = {CommandTraits::Find(kind)->GetEffect(), needs,
                            [get, handler](const Context& context, v1::Command& command) {
                              handler(context, *(command.*get)());
                            }};
  }
  // The commands that are typed only: they are answered with Error.UNIMPLEMENTED, which names them.
  void AddUnimplemented();
  const Entry* Find(v1::Command::CommandCase kind) const {
    const auto found = this->Entries_.find(kind);
    return found == this->Entries_.end() ? nullptr : &found->second;
  }

private:
  std::map<v1::Command::CommandCase, Entry> Entries_;
};

// One for each subject.
void AddSceneCommands(Registry& registry);
void AddFrameCommands(Registry& registry);
void AddObjectCommands(Registry& registry);
void AddObjectRequests(Registry& registry);
void AddPrimitiveCommands(Registry& registry);
void AddTrailCommands(Registry& registry);
void AddRobotCommands(Registry& registry);
void AddFragmentCommands(Registry& registry);
void AddCameraCommands(Registry& registry);
void AddTerrainCommands(Registry& registry);
void AddTelemetryCommands(Registry& registry);
void AddMessageCommands(Registry& registry);
void AddTextCommands(Registry& registry); // needs VTK: in the module, not in the plain library

} // namespace dspace::session

#endif
