// What a server does with commands from anywhere: they are confined, carried out, kept by the
// ledger, and what the ledger says makes the state again. A fuzz target: input is a
// WatchReply.Snapshot, a list of commands. Nothing in it may crash, hang, throw, or end in an error
// of Dspace's own (INTERNAL).
//
// With clang and -DDSPACE_LIBFUZZER=ON it is libFuzzer's program; else it has a driver of its own
// (FuzzDriver.h), which changes messages field by field and byte by byte.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <dspace/Error.h>
#include <dspace/FilesRead.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/ledger/Ledger.h>
#include <dspace/messages/Confinement.h>
#include <dspace/messages/ErrorReply.h>
#include <dspace/proto/service.pb.h>

#include "FuzzDriver.h"

namespace {

using namespace dspace;
using namespace dspace::testing;

// A failure of Dspace's, not of the input's.
[[noreturn]] void Fail(const std::string& what, const v1::Command& command) {
  std::fprintf(stderr, "%s\n%s\n", what.c_str(), command.DebugString().substr(0, 4000).c_str());
  std::abort();
}

v1::Reply Execute(session::Interpreter& interpreter, const session::Confinement& confinement,
                  v1::Command& command) {
  return session::Catch([&] {
    confinement.Apply(command);
    const FilesGuard guard([&](const std::string& path) { confinement.RequireWithin(path); });
    return interpreter.Execute(command);
  });
}

void RunCommands(Commands& commands) {
  static const session::Confinement confinement({TheRoot().Path});
  session::Interpreter interpreter;
  session::Ledger ledger;
  interpreter.AddListener(
      [&](const v1::Command& command, const v1::Reply& reply) { ledger.Add(command, reply); });
  for (v1::Command& command : *commands.mutable_command()) {
    const v1::Command before = command;
    const v1::Reply reply = Execute(interpreter, confinement, command);
    if (reply.error().kind() == v1::Error::INTERNAL && reply.has_error()) {
      Fail(reply.error().message(), before);
    }
  }
  session::Interpreter copy;
  for (v1::Command& command : ledger.Commands()) {
    const v1::Reply reply = Execute(copy, confinement, command);
    if (reply.has_error()) {
      Fail("of the ledger: " + reply.error().message(), command);
    }
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Commands commands;
  v1::DriveRequest request;
  (void)request.ParseFromArray(data, int(size));  // as it comes over the wire
  (void)commands.ParseFromArray(data, int(size)); // what could be read of it counts
  RunCommands(commands);
  return 0;
}

#ifndef DSPACE_LIBFUZZER
int main(int argc, char** argv) {
  std::vector<Commands> corpus;
  FuzzDriver driver;
  driver.failure = "fuzz-link-failure";
  driver.corpus = [](Mutator& mutator) {
    std::vector<std::string> inputs;
    for (const Commands& commands : Corpus(mutator)) {
      inputs.push_back(commands.SerializeAsString());
    }
    return inputs;
  };
  driver.next = [&corpus](Mutator& mutator, long run) {
    if (corpus.empty()) {
      corpus = Corpus(mutator);
    }
    Commands commands = corpus[mutator.Below(unsigned(corpus.size()))];
    for (unsigned n = mutator.Below(4); n > 0; --n) { // what one kind makes, others meet
      const Commands& more = corpus[mutator.Below(unsigned(corpus.size()))];
      *commands.add_command() = more.command(more.command_size() - 1);
    }
    for (unsigned n = mutator.Below(6); n > 0; --n) {
      mutator.Change(
          *commands.mutable_command(int(mutator.Below(unsigned(commands.command_size())))));
    }
    std::string bytes = commands.SerializeAsString();
    if (run % 4 == 3) {
      bytes = mutator.Damage(std::move(bytes));
    }
    if (mutator.Below(20) == 0 && corpus.size() < 5000) {
      corpus.push_back(std::move(commands));
    }
    return bytes;
  };
  return driver.Main(argc, argv);
}
#endif
