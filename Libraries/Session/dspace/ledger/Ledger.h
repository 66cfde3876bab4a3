// The shortest list of commands that brings a new interpreter to the present state.
#ifndef DSPACE_SESSION_LEDGER_H
#define DSPACE_SESSION_LEDGER_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

struct State;

// Hears every accepted command (Interpreter::AddListener) from an empty interpreter on, and keeps
// of it what the present state is made of: what is superseded or removed is forgotten. Snapshots of
// recordings and of servers are its Commands().
//
// The state is the same in everything that requests answer and pictures show, poses to the bit.
// Three things are not part of it: the order of the objects within a fragment; that ids of what was
// removed are taken; a drag that is under way in a viewport.
//
// Fields that are not known here are kept where a message is kept whole (objects, lights, tables,
// terrains, channels of telemetry, events, questions), not in frames, poses, values and times.
//
// A command whose option `kept` is LATEST (options.proto) needs no code here: the last one for its
// owner is kept as it is. Add throws for any other change that it has no code for. Commands of a
// later version, whose numbers no command here has, are kept all, in their order, at the end. Of
// wheel tracks it keeps nothing: Commands() asks the terrain for them. Not synchronised.
class Ledger {
public:
  // `state` is the interpreter's, which must outlive this; without one Commands() throws
  // Error(Internal) where wheels have rolled.
  explicit Ledger(const State* state = nullptr);
  ~Ledger();
  Ledger(Ledger&&) noexcept;
  Ledger& operator=(Ledger&&) noexcept;

  // What it throws leaves the scene of the command (or, of a viewport's command, everything) not to
  // be known any more. Nothing more of it is taken in, without a word, until it is removed.
  void Add(const v1::Command& accepted, const v1::Reply& reply);
  // The same of a command that the state should have and has not, for the reason given.
  void AddFailed(const v1::Command& accepted, const std::string& why);
  // Throws Error(Internal) while anything is not known, naming it.
  std::vector<v1::Command> Commands() const;

private:
  struct Impl;
  std::unique_ptr<Impl> Impl_;
};

// The command that has the same effect, whatever was drawn and whoever drags: a viewport's event
// becomes the camera that it led to. False for an event that led to nothing: nothing is to be kept.
bool ToRecorded(const v1::Command& accepted, const v1::Reply& reply, v1::Command& recorded);

} // namespace dspace::session

#endif
