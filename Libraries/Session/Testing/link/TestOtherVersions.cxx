// What comes from other versions: unknown fields survive, unknown commands are refused by number,
// and those of a version to come say that they are not carried out.
#include <map>
#include <vector>

#include <dspace/messages/CommandTraits.h>

#include "CommandTestSupport.h"
#include "LinkTestSupport.h"

namespace dspace::testing {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// --- Unknown fields ---------------------------------------------------------------------------

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

// --- Unknown and later commands ---------------------------------------------------------------

class WireCommands : public CommandTest {};

TEST_F(WireCommands, UnknownCommandsAreRejectedByNumber) {
  v1::Command command;
  command.GetReflection()->MutableUnknownFields(&command)->AddLengthDelimited(4321, "");
  this->Reject(command, Kind::UNSUPPORTED, "command number 4321");
  this->Reject(v1::Command(), Kind::UNSUPPORTED, "command none");
}

} // namespace
} // namespace dspace::testing
