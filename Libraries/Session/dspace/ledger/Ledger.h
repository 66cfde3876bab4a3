// The shortest list of commands that recreates the present state in a new interpreter.
#ifndef DSPACE_SESSION_LEDGER_H
#define DSPACE_SESSION_LEDGER_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

struct State;

// An observer of every accepted command (Interpreter::AddListener), starting with an empty
// interpreter. It stores what the present state consists of and drops what later commands supersede
// or remove. The snapshots of recordings and servers are its Commands().
//
// The recreated state gives the same replies to requests and the same pictures; poses are equal to
// the bit. It does not include the order of objects within a fragment, the ids of removed entities,
// and an unfinished drag in a viewport.
//
// Unknown fields are preserved in messages that are stored whole (objects, lights, tables,
// terrains, telemetry channels, events, questions), but not in frames, poses, values and times.
//
// A command whose option `kept` is LATEST (options.proto) needs no code here: the last one for its
// owner is stored unchanged. Add throws for any other change without code. Commands of a later
// version, with unknown numbers, are all stored and come last in their order. Wheel tracks are not
// stored: Commands() reads them from the terrain. Not thread-safe.
class Ledger {
public:
  // `state` is the interpreter's and must outlive the ledger. Without it, Commands() throws
  // Error(Internal) if a terrain has wheel tracks.
  explicit Ledger(const State* state = nullptr);
  ~Ledger();
  Ledger(Ledger&&) noexcept;
  Ledger& operator=(Ledger&&) noexcept;

  // If it throws, the ledger no longer knows the scene of the command (for a viewport command: the
  // whole session). Later commands of this scene are then ignored until the scene is removed.
  void Add(const v1::Command& accepted, const v1::Reply& reply);
  // Reports a command that the state lacks for the reason `why`. The effect is that of a failed
  // Add.
  void AddFailed(const v1::Command& accepted, const std::string& why);
  // Throws Error(Internal), naming the reason, while a scene is unknown.
  std::vector<v1::Command> Commands() const;

private:
  struct Impl;
  std::unique_ptr<Impl> Impl_;
};

// Converts an accepted command into a command with the same effect that does not depend on drawing:
// an event of a viewport becomes the resulting camera. False if an event had no effect.
bool ToRecorded(const v1::Command& accepted, const v1::Reply& reply, v1::Command& recorded);

} // namespace dspace::session

#endif
