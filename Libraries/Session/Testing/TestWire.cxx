// What other versions and other languages rely on: numbers and types that never change (wire.lock),
// a comment for everything, unknown fields that survive, unknown commands that are refused by
// number.
#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <google/protobuf/descriptor.pb.h>

#include <dspace/session/service.pb.h>

#include "CommandTestSupport.h"
#include "LinkTestSupport.h"

namespace dspace::testing {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::FileDescriptor;
using google::protobuf::Message;
using google::protobuf::SourceLocation;

// --- The wire
// ---------------------------------------------------------------------------------------

// One for each field and each value of an enumeration: what must stay.
void Describe(const EnumDescriptor& type, std::set<std::string>& lines) {
  for (int i = 0; i < type.value_count(); ++i) {
    lines.insert(type.full_name() + " " + std::to_string(type.value(i)->number()) + " " +
                 type.value(i)->name());
  }
}

void Describe(const Descriptor& message, std::set<std::string>& lines) {
  for (int i = 0; i < message.field_count(); ++i) {
    const FieldDescriptor& field = *message.field(i);
    std::string type = field.message_type() ? field.message_type()->full_name()
                       : field.enum_type()  ? field.enum_type()->full_name()
                                            : field.type_name();
    if (field.is_repeated()) {
      type = "repeated " + type;
    } else if (field.real_containing_oneof()) {
      type = "oneof " + type;
    } else if (field.has_optional_keyword()) {
      type = "optional " + type;
    }
    lines.insert(message.full_name() + " " + std::to_string(field.number()) + " " + field.name() +
                 " " + type);
  }
  for (int i = 0; i < message.nested_type_count(); ++i) {
    Describe(*message.nested_type(i), lines);
  }
  for (int i = 0; i < message.enum_type_count(); ++i) {
    Describe(*message.enum_type(i), lines);
  }
}

// service.proto and all that it imports, which is all there is.
void Files(const FileDescriptor& file, std::map<std::string, const FileDescriptor*>& files) {
  if (files.emplace(file.name(), &file).second) {
    for (int i = 0; i < file.dependency_count(); ++i) {
      Files(*file.dependency(i), files);
    }
  }
}

TEST(Wire, NothingHasChangedOrGone) {
  std::map<std::string, const FileDescriptor*> files;
  Files(*v1::WatchReply::descriptor()->file(), files);
  std::set<std::string> present;
  for (const auto& [name, file] : files) {
    for (int i = 0; i < file->message_type_count(); ++i) {
      Describe(*file->message_type(i), present);
    }
    for (int i = 0; i < file->enum_type_count(); ++i) {
      Describe(*file->enum_type(i), present);
    }
  }
  std::ifstream lock(WIRE_LOCK);
  ASSERT_TRUE(lock) << "wire.lock is not there";
  std::set<std::string> locked;
  for (std::string line; std::getline(lock, line);) {
    if (!line.empty() && line[0] != '#') {
      EXPECT_TRUE(locked.insert(line).second) << "wire.lock has this line twice: " << line;
    }
  }
  EXPECT_GT(locked.size(), 1000u);
  for (const std::string& line : locked) {
    // Other programs were compiled with it. A field that is of no use any more stays.
    EXPECT_TRUE(present.count(line)) << "changed or removed, which must not be: " << line;
  }
  std::string added;
  for (const std::string& line : present) {
    added += locked.count(line) ? "" : line + "\n";
  }
  EXPECT_EQ(added, "") << "new: once it is to stay as it is, add these lines to "
                          "Libraries/Session/dspace/session/wire.lock (in any order) and raise "
                          "COMMAND_SET_VERSION (service.proto) for the next release:\n"
                       << added;
}

// --- Comments
// ---------------------------------------------------------------------------------------

// A message has a comment of its own, unless it stands in another one. A field has one of its own;
// or follows one of the same type that has; or stands in backquotes in the comment of its message
// or at the head of its file; or is of a message or enumeration, which says what it is.
class Comments {
public:
  explicit Comments(const FileDescriptor& file) : File_(file) {
    SourceLocation location;
    if (file.GetSourceLocation({12}, &location)) { // `syntax`
      for (const std::string& each : location.leading_detached_comments) {
        this->Head_ += each;
      }
      this->Head_ += location.leading_comments;
    }
  }
  void Check(const Descriptor& message) {
    SourceLocation location;
    ASSERT_TRUE(message.GetSourceLocation(&location));
    const std::string own = location.leading_comments;
    if (own.empty() && !message.containing_type()) {
      ADD_FAILURE() << this->File_.name() << ": message " << message.full_name()
                    << " has no comment";
    }
    ++this->Messages;
    const FieldDescriptor* before = nullptr;
    bool said = false;
    for (int i = 0; i < message.field_count(); ++i) {
      const FieldDescriptor& field = *message.field(i);
      ASSERT_TRUE(field.GetSourceLocation(&location));
      const std::string quoted = "`" + field.name() + "`";
      const bool follows =
          said && before->type() == field.type() && before->is_repeated() == field.is_repeated();
      said = !location.leading_comments.empty() || !location.trailing_comments.empty() || follows ||
             own.find(quoted) != std::string::npos ||
             this->Head_.find(quoted) != std::string::npos || field.message_type() ||
             field.enum_type();
      EXPECT_TRUE(said) << this->File_.name() << ": field " << field.full_name()
                        << " has no comment";
      before = &field;
      ++this->Fields;
    }
    for (int i = 0; i < message.nested_type_count(); ++i) {
      this->Check(*message.nested_type(i));
    }
  }
  int Messages = 0;
  int Fields = 0;

private:
  const FileDescriptor& File_;
  std::string Head_;
};

TEST(Wire, EverythingHasAComment) {
  // The .proto files as protoc reads them, with their comments, imported ones first.
  google::protobuf::FileDescriptorSet set;
  std::ifstream file(WIRE_COMMENTS, std::ios::binary);
  ASSERT_TRUE(set.ParseFromIstream(&file)) << WIRE_COMMENTS;
  google::protobuf::DescriptorPool pool;
  for (const google::protobuf::FileDescriptorProto& each : set.file()) {
    ASSERT_TRUE(pool.BuildFile(each)) << each.name();
  }
  const FileDescriptor* service = pool.FindFileByName("dspace/session/service.proto");
  ASSERT_TRUE(service);
  std::map<std::string, const FileDescriptor*> files;
  Files(*service, files);
  int messages = 0;
  int fields = 0;
  for (const auto& [name, each] : files) {
    Comments comments(*each);
    for (int i = 0; i < each->message_type_count(); ++i) {
      comments.Check(*each->message_type(i));
    }
    messages += comments.Messages;
    fields += comments.Fields;
  }
  EXPECT_GT(messages, 200);
  EXPECT_GT(fields, 1000);
}

// --- Unknown fields
// ---------------------------------------------------------------------------------

constexpr int Unknown = 1999; // a field number that no message has

// Fields of a later version, in the message and in all that it holds.
void AddUnknown(Message& message) {
  const auto* reflection = message.GetReflection();
  reflection->MutableUnknownFields(&message)->AddLengthDelimited(Unknown, "of a later version");
  std::vector<const FieldDescriptor*> fields;
  reflection->ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    if (!field->message_type()) {
      continue;
    }
    for (int i = 0; field->is_repeated() && i < reflection->FieldSize(message, field); ++i) {
      AddUnknown(*reflection->MutableRepeatedMessage(&message, field, i));
    }
    if (!field->is_repeated()) {
      AddUnknown(*reflection->MutableMessage(&message, field));
    }
  }
}

int CountUnknown(const Message& message) {
  const auto* reflection = message.GetReflection();
  int count = reflection->GetUnknownFields(message).field_count();
  std::vector<const FieldDescriptor*> fields;
  reflection->ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    if (!field->message_type()) {
      continue;
    }
    for (int i = 0; field->is_repeated() && i < reflection->FieldSize(message, field); ++i) {
      count += CountUnknown(reflection->GetRepeatedMessage(message, field, i));
    }
    if (!field->is_repeated()) {
      count += CountUnknown(reflection->GetMessage(message, field));
    }
  }
  return count;
}

// Commands of several kinds, each with as many unknown fields as messages.
std::vector<v1::Command> FromALaterVersion() {
  std::vector<v1::Command> commands;
  const auto add = [&commands]() -> v1::Command& { return commands.emplace_back(); };
  add().mutable_create_scene();
  v1::CreateFrame* frame = add().mutable_create_frame();
  frame->set_name("rover");
  frame->mutable_pose()->mutable_position()->set_x(1);
  v1::Command step = MakeStep({2}, 3.0);
  commands.push_back(step);
  v1::CreatePrimitive* box = add().mutable_create_primitive();
  box->mutable_object()->set_name("box");
  box->mutable_box()->mutable_size()->set_x(1);
  box->mutable_box()->mutable_size()->set_y(1);
  box->mutable_box()->mutable_size()->set_z(1);
  add().mutable_set_light()->set_name("lamp");
  v1::CreateTelemetry* channel = add().mutable_create_telemetry();
  channel->set_name("power");
  channel->mutable_limits()->set_alarm_high(1);
  add().mutable_set_telemetry()->add_id(1);
  commands.back().mutable_set_telemetry()->add_value(0.5);
  add().mutable_log_event()->set_kind("note");
  commands.back().mutable_log_event()->add_datum()->set_name("mass");
  add().mutable_ask_operator()->set_name("go");
  commands.back().mutable_ask_operator()->set_text("Go?");
  add().mutable_set_time()->set_time_s(7);
  for (v1::Command& command : commands) {
    AddUnknown(command);
  }
  return commands;
}

TEST(Wire, CommandsOfALaterVersionAreAppliedWithTheirUnknownFields) {
  session::Interpreter interpreter;
  session::Ledger ledger;
  std::vector<v1::Command> heard;
  interpreter.AddListener([&](const v1::Command& command, const v1::Reply& reply) {
    heard.push_back(command);
    ledger.Add(command, reply);
  });
  const std::vector<v1::Command> commands = FromALaterVersion();
  for (v1::Command command : commands) {
    const v1::Reply reply = interpreter.Execute(command);
    ASSERT_FALSE(reply.has_error()) << reply.error().message();
  }
  ASSERT_EQ(heard.size(), commands.size());
  for (std::size_t i = 0; i < commands.size(); ++i) {
    EXPECT_GE(CountUnknown(commands[i]), 2);
    EXPECT_EQ(CountUnknown(heard[i]), CountUnknown(commands[i])) << heard[i].DebugString();
  }
  const std::shared_ptr<Scene> scene = interpreter.FindScene("scene");
  EXPECT_EQ(scene->Frames().LocalPose(2).position.x(), 3.0);
  EXPECT_EQ(scene->Time(), 7.0);

  // Snapshots keep them where they keep a message whole: objects, lights, text tables, terrains,
  // telemetry's channels, events, questions. Frames, poses, values and times are numbers there.
  std::map<int, int> kept;
  for (const v1::Command& command : ledger.Commands()) {
    kept[command.command_case()] += CountUnknown(command);
  }
  using C = v1::Command;
  EXPECT_EQ(kept[C::kCreatePrimitive], 5); // the command, it, its settings, the box, the size
  EXPECT_EQ(kept[C::kSetLight], 1);
  EXPECT_EQ(kept[C::kCreateTelemetry], 2);
  EXPECT_EQ(kept[C::kLogEvent], 2);
  EXPECT_EQ(kept[C::kAskOperator], 1);
}

class WireLink : public LinkTest {};

TEST_F(WireLink, UnknownFieldsReachViewers) {
  this->StartServer();
  session::WatcherOptions options;
  options.address = this->Server->Address();
  session::Watcher watcher(options);
  v1::WatchReply message;
  ASSERT_TRUE(watcher.Take(message, 20.0) && message.has_snapshot()); // of nothing yet
  session::RemoteClient client(this->ClientOptions());
  const std::vector<v1::Command> commands = FromALaterVersion();
  for (const v1::Command& command : commands) {
    Accept(client.Execute(command));
  }
  std::vector<v1::Command> heard;
  while (heard.size() < commands.size() && watcher.Take(message, 20.0)) {
    if (message.has_command()) {
      heard.push_back(message.command());
    }
  }
  ASSERT_EQ(heard.size(), commands.size());
  for (std::size_t i = 0; i < commands.size(); ++i) {
    EXPECT_EQ(CountUnknown(heard[i]), CountUnknown(commands[i])) << heard[i].DebugString();
  }

  // What would be left out, since the server has it, is sent for what is unknown in it.
  v1::Command step = MakeStep({2}, 3.0);
  Accept(client.Execute(step));
  step.GetReflection()->MutableUnknownFields(&step)->AddVarint(Unknown, 1);
  Accept(client.Execute(step));
  v1::Command last;
  while (watcher.Take(message, 5.0)) {
    last = message.command();
    if (CountUnknown(last) == 1) {
      break;
    }
  }
  EXPECT_EQ(CountUnknown(last), 1);
}

// --- Unknown and later commands
// ---------------------------------------------------------------------

class WireCommands : public CommandTest {};

TEST_F(WireCommands, UnknownOnesAreRefusedByNumber) {
  v1::Command command;
  command.GetReflection()->MutableUnknownFields(&command)->AddLengthDelimited(4321, "");
  this->Refuse(command, Kind::UNSUPPORTED, "command number 4321");
  this->Refuse(v1::Command(), Kind::UNSUPPORTED, "command none");
}

TEST_F(WireCommands, LaterOnesAreTypedAndSayThatTheyAreNotCarriedOut) {
  int told = 0;
  this->Interpreter_.AddListener([&told](const v1::Command&, const v1::Reply&) { ++told; });
  const Descriptor* commands = v1::Command::descriptor();
  int later = 0;
  for (int i = 0; i < commands->field_count(); ++i) {
    const FieldDescriptor* field = commands->field(i);
    if (!field->message_type() ||
        field->message_type()->file()->name() != "dspace/session/measurements.proto") {
      continue;
    }
    v1::Command command;
    command.GetReflection()->MutableMessage(&command, field);
    this->Refuse(command, Kind::UNIMPLEMENTED, "command " + field->name() + ": it is typed");
    command.set_scene("no such scene");
    const v1::Reply reply = this->Interpreter_.Execute(command);
    EXPECT_EQ(reply.error().kind(), Kind::UNIMPLEMENTED) << field->name();
    EXPECT_EQ(reply.error().object(), "command " + field->name());
    ++later;
  }
  EXPECT_EQ(later, 11);
  EXPECT_EQ(told, 0); // nothing to record, nothing for viewers
}

} // namespace
} // namespace dspace::testing
