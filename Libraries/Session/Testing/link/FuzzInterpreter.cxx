// What the interpreter does with commands that each are valid, or nearly so, in an order and with
// values that nobody would give: sequences of the valid commands of EveryCommand.h, cut, repeated
// and put together anew, whose fields are given values of other fields (ids, names, numbers) or of
// their own kind. A fuzz target: input is a serialized list of commands (FuzzCommands.h).
//
// No command may crash, hang, throw or end in an error of Dspace's own (INTERNAL). A command that
// is rejected changes nothing that can be asked for. Every reply and every accepted command is a
// message that can be parsed again. What a snapshot makes, and what a recording of the commands
// shows at its end, has the same snapshot.
//
// With clang and -DDSPACE_LIBFUZZER=ON it is libFuzzer's program; else FuzzDriver.h runs it.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <google/protobuf/text_format.h>

#include <dspace/Error.h>
#include <dspace/FilesRead.h>
#include <dspace/ledger/Ledger.h>
#include <dspace/messages/CommandTexts.h>
#include <dspace/messages/Confinement.h>
#include <dspace/messages/ErrorReply.h>
#include <dspace/recording/Playback.h>
#include <dspace/recording/RecordingWriter.h>

#include "EveryCommand.h"
#include "EveryFile.h"
#include "FuzzDriver.h"

namespace {

using namespace dspace;
using namespace dspace::testing;

[[noreturn]] void Fail(const std::string& what, const Message& about) {
  std::fprintf(stderr, "%s\n%s\n", what.c_str(), about.DebugString().substr(0, 4000).c_str());
  std::abort();
}

// In any order: that of objects in a fragment is not part of the state. A time of 0 is as none.
std::multiset<std::string> SnapshotOf(const session::Ledger& ledger) {
  std::multiset<std::string> commands;
  for (const v1::Command& command : ledger.Commands()) {
    const bool none = command.has_set_time() && command.set_time().ByteSizeLong() == 0;
    if (!none) {
      commands.insert(command.SerializeAsString());
    }
  }
  return commands;
}

// Fails with the commands that are in one of the two only.
void RequireSame(const std::multiset<std::string>& one, const std::multiset<std::string>& other,
                 const std::string& what, const Message& about) {
  if (one == other) {
    return;
  }
  std::string text = what;
  const auto add = [&text](const char* mark, const auto& some, const auto& without) {
    for (const std::string& bytes : some) {
      v1::Command command;
      if (without.count(bytes) == 0 && command.ParseFromString(bytes)) {
        text += std::string("\n") + mark + command.ShortDebugString().substr(0, 1000);
      }
    }
  };
  add("- ", one, other);
  add("+ ", other, one);
  Fail(text, about);
}

// An interpreter that may read and write in one folder, with a ledger.
class Confined {
public:
  Confined() {
    this->Interpreter.AddListener([this](const v1::Command& command, const v1::Reply& reply) {
      this->Ledger.Add(command, reply);
    });
  }

  v1::Reply Execute(v1::Command& command) {
    static const session::Confinement confinement({TheRoot().Path});
    return session::Catch([&] {
      confinement.Apply(command);
      const FilesGuard guard([&](const std::string& path) { confinement.RequireWithin(path); });
      return this->Interpreter.Execute(command);
    });
  }

  // All that can be asked for about all scenes.
  std::string Picture() {
    std::string text;
    const auto ask = [&](const std::string& scene, auto fill) {
      v1::Command command;
      command.set_scene(scene);
      fill(command);
      const v1::Reply reply = this->Interpreter.Execute(command);
      text += reply.SerializeAsString();
      return reply;
    };
    const v1::Reply scenes = ask("", [](v1::Command& c) { c.mutable_list_scenes(); });
    for (const std::string& scene : scenes.scenes().name()) {
      const v1::Reply frames = ask(scene, [](v1::Command& c) { c.mutable_list_frames(); });
      ask(scene, [&](v1::Command& c) {
        c.mutable_get_poses()->set_local(true);
        for (const v1::FrameInfo& frame : frames.frames().frame()) {
          c.mutable_get_poses()->add_frame(frame.id());
        }
      });
      ask(scene, [](v1::Command& c) { c.mutable_list_objects(); });
      ask(scene, [](v1::Command& c) { c.mutable_list_fragments(); });
      ask(scene, [](v1::Command& c) { c.mutable_list_lights(); });
      ask(scene, [](v1::Command& c) { c.mutable_list_robots(); });
      ask(scene, [](v1::Command& c) { c.mutable_get_time(); });
      ask(scene, [](v1::Command& c) { c.mutable_list_telemetry(); });
      ask(scene, [](v1::Command& c) { c.mutable_list_events(); });
      ask(scene, [](v1::Command& c) { c.mutable_list_questions(); });
      ask(scene, [](v1::Command& c) { c.mutable_list_vantages(); });
    }
    return text;
  }

  session::Interpreter Interpreter;
  session::Ledger Ledger{&Interpreter.GetState()};
};

template<class Made> void RequireParsed(const Made& message, const v1::Command& about) {
  Made again;
  if (!again.ParseFromString(message.SerializeAsString())) {
    Fail("cannot be parsed again", about);
  }
}

// The end of a recording has the snapshot of the session that it is of.
void RequireSameInRecording(const std::vector<v1::Command>& commands,
                            const std::multiset<std::string>& snapshot, const Message& about) {
  const std::string path = TheRoot().Path + "/run.dspace";
  std::filesystem::remove(path);
  {
    Confined recorded;
    session::Ledger empty(&recorded.Interpreter.GetState());
    session::RecordingOptions options;
    options.snapshotCommands = 20;
    options.snapshotBytes = 1;
    session::RecordingWriter writer(path, empty, 0.0, options,
                                    &recorded.Interpreter.GetState().files);
    recorded.Interpreter.AddListener([&](const v1::Command& command, const v1::Reply& reply) {
      writer.Add(command, reply, recorded.Ledger);
    });
    for (v1::Command command : commands) {
      recorded.Execute(command);
    }
    RequireSame(snapshot, SnapshotOf(recorded.Ledger), "the same commands made another state",
                about);
  }
  session::RecordingReader reader(path);
  if (reader.Last() == 0) {
    return;
  }
  Confined shown;
  try {
    session::Playback playback(reader, shown.Interpreter, false);
    playback.Step(std::int64_t(playback.Steps().size()));
  } catch (const Error& error) {
    Fail(std::string("of the recording: ") + error.what(), about);
  }
  RequireSame(snapshot, SnapshotOf(shown.Ledger), "the recording shows another state", about);
}

// Whether the command would write over a file that others read: then a second run differs.
bool WritesOverInput(const v1::Command& command) {
  bool over = false;
  session::ForEachText(
      command, [&](const std::string& text, const FieldDescriptor&, session::TextKind kind) {
        const std::string name = std::filesystem::path(text).filename().string();
        over = over || (kind == session::TextKind::NewFile &&
                        (name.empty() || std::filesystem::exists(TheRoot().Path + "/" + name)));
      });
  return over;
}

void RunCommands(const Commands& commands, bool record) {
  Confined session;
  std::string picture = session.Picture();
  std::vector<v1::Command> accepted;
  for (v1::Command command : commands.command()) {
    if (WritesOverInput(command)) {
      continue;
    }
    const v1::Command before = command;
    const v1::Reply reply = session.Execute(command);
    if (reply.error().kind() == v1::Error::INTERNAL && reply.has_error()) {
      Fail(reply.error().message(), before);
    }
    RequireParsed(reply, before);
    const std::string now = session.Picture();
    if (reply.has_error() && now != picture) {
      Fail("it was rejected and changed something: " + reply.error().message(), before);
    }
    if (!reply.has_error()) {
      RequireParsed(command, before);
      accepted.push_back(command);
    }
    picture = now;
  }
  const std::multiset<std::string> snapshot = SnapshotOf(session.Ledger);
  Confined copy;
  for (v1::Command& command : session.Ledger.Commands()) {
    const v1::Reply reply = copy.Execute(command);
    if (reply.has_error()) {
      Fail("of the snapshot: " + reply.error().message(), command);
    }
  }
  RequireSame(snapshot, SnapshotOf(copy.Ledger), "a snapshot's snapshot differs", commands);
  if (record) {
    RequireSameInRecording(accepted, snapshot, commands);
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static unsigned run = 0;
  for (const auto& each : std::filesystem::directory_iterator(TheRoot().Path)) {
    std::filesystem::remove_all(each.path()); // what commands have written
  }
  WriteEveryFile(TheRoot().Path);
  Commands commands;
  (void)commands.ParseFromArray(data, int(size)); // what could be read of it counts
  RunCommands(commands, ++run % 4 == 0);
  return 0;
}

#ifndef DSPACE_LIBFUZZER
namespace {

using google::protobuf::Reflection;

// The values of all fields of a sequence, by their type, for other fields of that type.
class Values {
public:
  void Collect(const Message& message) {
    this->Walk(const_cast<Message&>(message), [this](Message& m, const FieldDescriptor& f, int i) {
      this->ByType_[f.cpp_type()].push_back({&m, &f, i});
    });
  }

  // Gives one field of a message the value of another field.
  void Splice(Message& message, Mutator& mutator) {
    std::vector<Leaf> leaves;
    this->Walk(message, [&](Message& m, const FieldDescriptor& f, int i) {
      leaves.push_back({&m, &f, i});
    });
    if (leaves.empty()) {
      return;
    }
    const Leaf& to = leaves[mutator.Below(unsigned(leaves.size()))];
    const std::vector<Leaf>& pool = this->ByType_[to.field->cpp_type()];
    if (!pool.empty()) {
      Copy(pool[mutator.Below(unsigned(pool.size()))], to);
    }
  }

private:
  struct Leaf {
    Message* message;
    const FieldDescriptor* field;
    int index; // -1: not repeated
  };
  template<class Take> static void Walk(Message& message, const Take& take) {
    const Reflection& r = *message.GetReflection();
    std::vector<const FieldDescriptor*> fields;
    r.ListFields(message, &fields);
    for (const FieldDescriptor* field : fields) {
      const int n = field->is_repeated() ? r.FieldSize(message, field) : 1;
      for (int i = 0; i < n; ++i) {
        if (field->message_type()) {
          Walk(field->is_repeated() ? *r.MutableRepeatedMessage(&message, field, i)
                                    : *r.MutableMessage(&message, field),
               take);
        } else {
          take(message, *field, field->is_repeated() ? i : -1);
        }
      }
    }
  }
  // Both of one type.
  static void Copy(const Leaf& from, const Leaf& to) {
    const Reflection& a = *from.message->GetReflection();
    const Reflection& b = *to.message->GetReflection();
    const auto copy = [&](auto get, auto getOf, auto set, auto setOf) {
      const auto value = from.index < 0 ? (a.*get)(*from.message, from.field)
                                        : (a.*getOf)(*from.message, from.field, from.index);
      to.index < 0 ? (b.*set)(to.message, to.field, value)
                   : (b.*setOf)(to.message, to.field, to.index, value);
    };
    using R = Reflection;
    switch (from.field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return copy(&R::GetDouble, &R::GetRepeatedDouble, &R::SetDouble, &R::SetRepeatedDouble);
    case FieldDescriptor::CPPTYPE_UINT32:
      return copy(&R::GetUInt32, &R::GetRepeatedUInt32, &R::SetUInt32, &R::SetRepeatedUInt32);
    case FieldDescriptor::CPPTYPE_UINT64:
      return copy(&R::GetUInt64, &R::GetRepeatedUInt64, &R::SetUInt64, &R::SetRepeatedUInt64);
    case FieldDescriptor::CPPTYPE_INT32:
      return copy(&R::GetInt32, &R::GetRepeatedInt32, &R::SetInt32, &R::SetRepeatedInt32);
    case FieldDescriptor::CPPTYPE_BOOL:
      return copy(&R::GetBool, &R::GetRepeatedBool, &R::SetBool, &R::SetRepeatedBool);
    case FieldDescriptor::CPPTYPE_ENUM:
      return copy(&R::GetEnumValue, &R::GetRepeatedEnumValue, &R::SetEnumValue,
                  &R::SetRepeatedEnumValue);
    case FieldDescriptor::CPPTYPE_STRING: {
      const std::string text = from.index < 0
                                   ? a.GetString(*from.message, from.field)
                                   : a.GetRepeatedString(*from.message, from.field, from.index);
      // Bytes are no text.
      if (from.field->type() == to.field->type()) {
        to.index < 0 ? b.SetString(to.message, to.field, text)
                     : b.SetRepeatedString(to.message, to.field, to.index, text);
      }
      return;
    }
    default:
      return;
    }
  }
  std::map<FieldDescriptor::CppType, std::vector<Leaf>> ByType_;
};

v1::Command Parse(std::string text) {
  for (std::size_t at; (at = text.find("FOLDER")) != std::string::npos;) {
    text.replace(at, 6, TheRoot().Path);
  }
  v1::Command command;
  if (!google::protobuf::TextFormat::ParseFromString(text, &command)) {
    std::abort();
  }
  return command;
}

// The commands that make a scene with something of every kind, and groups that go together.
struct Seeds {
  std::vector<v1::Command> first;
  std::vector<std::vector<v1::Command>> groups;

  static const Seeds& Get() {
    static const Seeds seeds = [] {
      Seeds made;
      for (const char* text : Everything()) {
        made.first.push_back(Parse(text));
      }
      for (const CommandInstance& each : EveryCommand()) {
        std::vector<v1::Command> group;
        for (const char* text : each.before) {
          group.push_back(Parse(text));
        }
        group.push_back(Parse(each.command));
        made.groups.push_back(std::move(group));
      }
      return made;
    }();
    return seeds;
  }
};

Commands Sequence(Mutator& mutator) {
  const Seeds& seeds = Seeds::Get();
  Commands commands;
  const unsigned kept = 1 + mutator.Below(4); // of four: how much of everything there is
  for (const v1::Command& command : seeds.first) {
    if (command.has_create_scene() || mutator.Below(4) < kept) {
      *commands.add_command() = command;
    }
  }
  for (unsigned n = 1 + mutator.Below(12); n > 0; --n) {
    for (const v1::Command& command : seeds.groups[mutator.Below(unsigned(seeds.groups.size()))]) {
      *commands.add_command() = command;
    }
  }
  const auto any = [&] { return int(mutator.Below(unsigned(commands.command_size()))); };
  for (unsigned n = mutator.Below(8); n > 0; --n) { // order
    const int at = any();
    switch (mutator.Below(3)) {
    case 0:
      commands.mutable_command()->SwapElements(at, any());
      break;
    case 1:
      *commands.add_command() = commands.command(at);
      break;
    default:
      commands.mutable_command()->DeleteSubrange(at, 1);
    }
  }
  for (unsigned n = mutator.Below(12); n > 0; --n) { // values
    Values values;
    values.Collect(commands);
    v1::Command& one = *commands.mutable_command(any());
    mutator.Below(3) == 0 ? mutator.Change(one) : values.Splice(one, mutator);
  }
  return commands;
}

} // namespace

int main(int argc, char** argv) {
  FuzzDriver driver;
  driver.failure = "fuzz-interpreter-failure";
  driver.corpus = [](Mutator& mutator) {
    std::vector<std::string> inputs;
    for (int i = 0; i < 200; ++i) {
      inputs.push_back(Sequence(mutator).SerializeAsString());
    }
    return inputs;
  };
  driver.next = [](Mutator& mutator, long run) {
    std::string bytes = Sequence(mutator).SerializeAsString();
    return run % 16 == 15 ? mutator.Damage(std::move(bytes)) : bytes;
  };
  return driver.Main(argc, argv);
}
#endif
