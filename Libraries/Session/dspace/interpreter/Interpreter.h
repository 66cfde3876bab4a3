// Applies commands to the scenes that it owns.
#ifndef DSPACE_SESSION_INTERPRETER_H
#define DSPACE_SESSION_INTERPRETER_H

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <dspace/interpreter/Registry.h>
#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Executes commands for local sessions, servers and playback. It does not draw: a session that
// draws adds the viewport commands to Commands(). Use it from one thread at a time.
class Interpreter {
public:
  Interpreter();
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  // Executes one command as a whole or not at all. It never throws because of the command's
  // content: the reply contains the error. It writes chosen ids and names, and absolute paths, into
  // `command`, so that executing it again on a copy of the earlier state gives the same state.
  v1::Reply Execute(v1::Command& command);

  // An observer of every accepted command that changes the state, in order, with its reply. An
  // exception of a listener becomes a warning in the reply; the change stays.
  using Listener = std::function<void(const v1::Command&, const v1::Reply&)>;
  using Token = std::uint64_t;
  Token AddListener(Listener listener);
  bool RemoveListener(Token token);

  // Surrounds the execution of every command: calls `run`, which never throws, and may add warnings
  // to the reply. Empty: nothing surrounds it.
  using Around = std::function<void(v1::Reply& reply, const std::function<void()>& run)>;
  void SetAround(Around around) { this->Around_ = std::move(around); }

  // The registry, to which a session may add commands.
  Registry& Commands() { return this->Registry_; }
  State& GetState() { return this->State_; }
  // Null if there is no scene of this name.
  std::shared_ptr<Scene> FindScene(const std::string& name) const;

private:
  void Run(v1::Command& command, v1::Reply& reply);
  v1::Reply Attempt(v1::Command& command);
  void NotifyListeners(const v1::Command& command, v1::Reply& reply);
  State State_;
  Registry Registry_;
  std::vector<std::pair<Token, Listener>> Listeners_;
  Token LastToken_ = 0;
  Around Around_;
  int Depth_ = 0; // number of nested calls of Execute: listeners may execute commands
};

// "create_frame": the name of the command in the .proto, or "number 999" for one that is unknown.
std::string CommandName(const v1::Command& command);

} // namespace dspace::session

#endif
