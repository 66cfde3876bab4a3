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

// The one interpreter: local sessions, servers and playback all feed it. It draws nothing itself;
// whoever does adds the viewport commands to Commands(). Used from one thread at a time.
class Interpreter {
public:
  Interpreter();
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  // Carries out one command, whole or not at all, and never throws for what is in it: the reply
  // holds the error. Ids and names that the interpreter chose, and paths made absolute, are written
  // into `command`, so that executing it again on a copy of the earlier state gives the same state.
  v1::Reply Execute(v1::Command& command);

  // Hears every accepted command that changes something, in order, with its reply. A listener that
  // throws becomes a warning in the reply; the change stays made.
  using Listener = std::function<void(const v1::Command&, const v1::Reply&)>;
  using Token = std::uint64_t;
  Token AddListener(Listener listener);
  bool RemoveListener(Token token);

  // Where further commands are added.
  Registry& Commands() { return this->Registry_; }
  State& GetState() { return this->State_; }
  // Null when there is none of that name.
  std::shared_ptr<Scene> FindScene(const std::string& name) const;

private:
  void Run(v1::Command& command, v1::Reply& reply);
  void NotifyListeners(const v1::Command& command, v1::Reply& reply);
  State State_;
  Registry Registry_;
  std::vector<std::pair<Token, Listener>> Listeners_;
  Token LastToken_ = 0;
  int Depth_ = 0; // commands under way: listeners may give some too
};

// "create_frame": the name of the command in the .proto, or "number 999" for one that is unknown.
std::string CommandName(const v1::Command& command);

} // namespace dspace::session

#endif
