// The last command of each kind for one owner. Snapshots contain it for commands whose option
// `kept` is LATEST.
#ifndef DSPACE_SESSION_LATEST_COMMANDS_H
#define DSPACE_SESSION_LATEST_COMMANDS_H

#include <map>
#include <string>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Not a public header.
class LatestCommands {
public:
  void Set(const v1::Command& command) { this->ByNumber_[command.command_case()] = command; }
  // Appends the commands, ordered by number, for the scene of this name.
  void Put(const std::string& scene, std::vector<v1::Command>& out) const {
    for (const auto& [number, command] : this->ByNumber_) {
      out.push_back(command);
      out.back().set_scene(scene);
    }
  }

private:
  std::map<int, v1::Command> ByNumber_;
};

} // namespace dspace::session

#endif
