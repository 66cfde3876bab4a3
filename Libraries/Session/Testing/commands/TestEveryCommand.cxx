// Every command of the protocol is what its options say: it changes the scene or not, a snapshot
// restores it, poses stay, limits and defaults hold.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/ledger/Ledger.h>
#include <dspace/messages/CommandTraits.h>

#include "EveryCommand.h"
#include "EveryFile.h"
#include "TemporaryFolder.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceSession.h"
#include "vtkNew.h"

namespace dspace::testing {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using session::CommandTraits;
using session::Effect;

// A command in two sessions of which one was made from the other's snapshot. All sessions draw in
// one context.
class EveryCommandTest : public ::testing::Test {
protected:
  struct Session {
    vtkNew<vtkDspaceSession> vtk;
    v1::Reply Execute(const v1::Command& command) {
      v1::Reply reply;
      EXPECT_TRUE(reply.ParseFromString(this->vtk->Execute(command.SerializeAsString())));
      return reply;
    }
    void Accept(const v1::Command& command) {
      const v1::Reply reply = this->Execute(command);
      ASSERT_FALSE(reply.has_error()) << command.ShortDebugString() << "\n"
                                      << reply.error().message();
    }
    // In any order: that of objects in a fragment is not part of the state.
    std::multiset<std::string> Snapshot() {
      std::multiset<std::string> commands;
      for (const v1::Command& command : this->vtk->GetLedger().Commands()) {
        commands.insert(command.SerializeAsString());
      }
      return commands;
    }
  };

  void SetUp() override { WriteEveryFile(this->Folder_.Path()); }

  v1::Command Parse(std::string text) const {
    for (std::size_t at; (at = text.find("FOLDER")) != std::string::npos;) {
      text.replace(at, 6, this->Folder_.Path().string());
    }
    v1::Command command;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &command)) << text;
    return command;
  }
  static const CommandTraits& TraitsOf(const v1::Command& command) {
    return *CommandTraits::Find(command.command_case());
  }

  std::unique_ptr<Session> Bare() const {
    auto session = std::make_unique<Session>();
    session->vtk->SetRenderContext(this->Context_);
    return session;
  }
  // With everything in it, and what the command needs.
  std::unique_ptr<Session> Make(const CommandInstance& instance) const {
    std::unique_ptr<Session> session = this->Bare();
    for (const char* text : Everything()) {
      session->Accept(this->Parse(text));
    }
    for (const char* text : instance.before) {
      session->Accept(this->Parse(text));
    }
    return session;
  }
  std::unique_ptr<Session> MadeFromSnapshot(Session& other) const {
    std::unique_ptr<Session> session = this->Bare();
    for (const v1::Command& command : other.vtk->GetLedger().Commands()) {
      session->Accept(command);
    }
    return session;
  }

  // The replies to all requests of the table, errors too, by the request.
  std::map<std::string, std::string> Answers(Session& session) const {
    std::map<std::string, std::string> answers;
    for (const CommandInstance& instance : EveryCommand()) {
      const v1::Command command = this->Parse(instance.command);
      const CommandTraits& traits = TraitsOf(command);
      if (traits.GetEffect() != Effect::Request || instance.replyVaries) {
        continue;
      }
      v1::Reply reply = session.Execute(command);
      reply.clear_frame_event();
      answers[traits.Name()] = reply.SerializeAsString();
    }
    return answers;
  }
  void ExpectTheSame(Session& one, Session& other, const std::string& what) const {
    const auto answers = this->Answers(other);
    for (const auto& [request, answer] : this->Answers(one)) {
      if (answer != answers.at(request)) {
        v1::Reply a, b;
        a.ParseFromString(answer);
        b.ParseFromString(answers.at(request));
        ADD_FAILURE() << what << ": " << request << " answers\n"
                      << a.DebugString().substr(0, 2000) << "and\n"
                      << b.DebugString().substr(0, 2000);
      }
    }
  }

  // Local poses of all frames and values of telemetry, by scene and id.
  static std::map<std::string, std::string> Steps(Session& session) {
    std::map<std::string, std::string> steps;
    v1::Command list;
    list.mutable_list_scenes();
    const v1::Reply scenes = session.Execute(list);
    for (const std::string& scene : scenes.scenes().name()) {
      v1::Command ask;
      ask.set_scene(scene);
      ask.mutable_list_frames();
      const v1::Reply frames = session.Execute(ask);
      for (const v1::FrameInfo& frame : frames.frames().frame()) {
        if (frame.parent() != 0) {
          ask.mutable_get_poses()->Clear();
          ask.mutable_get_poses()->set_local(true);
          ask.mutable_get_poses()->add_frame(frame.id());
          steps[scene + " frame " + std::to_string(frame.id())] =
              session.Execute(ask).SerializeAsString();
        }
      }
      ask.mutable_list_telemetry();
      const v1::Reply channels = session.Execute(ask);
      for (const v1::TelemetryInfo& channel : channels.telemetry().channel()) {
        if (channel.channel().kind() != v1::CreateTelemetry::TEXT) {
          steps[scene + " channel " + std::to_string(channel.channel().id())] =
              std::to_string(channel.value());
        }
      }
    }
    return steps;
  }

  TemporaryFolder Folder_;
  vtkNew<vtkDspaceRenderContext> Context_;
};

TEST_F(EveryCommandTest, EveryCommandHasItsOptionsAndAnInstance) {
  std::set<std::string> there;
  for (const CommandInstance& instance : EveryCommand()) {
    const std::string name = session::CommandName(this->Parse(instance.command));
    EXPECT_TRUE(there.insert(name).second) << "EveryCommand.h has two entries of command " << name;
  }
  std::vector<CommandTraits> all;
  ASSERT_NO_THROW(all = CommandTraits::All()); // else it says which option which command lacks
  for (const CommandTraits& traits : all) {
    EXPECT_TRUE(there.count(traits.Name()))
        << "EveryCommand.h has no entry of command " << traits.Name();
  }
  EXPECT_GT(all.size(), 100u);
}

TEST_F(EveryCommandTest, EveryCommandIsWhatItsOptionsSay) {
  for (const CommandInstance& instance : EveryCommand()) {
    const v1::Command command = this->Parse(instance.command);
    const CommandTraits& traits = TraitsOf(command);
    SCOPED_TRACE(traits.Name());
    const auto session = this->Make(instance);
    const auto before = session->Snapshot();
    const auto stepsBefore = Steps(*session);
    const v1::Reply reply = session->Execute(command);
    ASSERT_FALSE(reply.has_error()) << reply.error().message();
    const FieldDescriptor* result = v1::Reply::descriptor()->FindFieldByNumber(reply.result_case());
    const std::vector<std::string>& results = traits.Results();
    EXPECT_TRUE(result ? std::count(results.begin(), results.end(), result->name()) == 1
                       : results.empty())
        << "its result is " << (result ? result->name() : "none");
    if (traits.GetEffect() == Effect::Request) {
      EXPECT_EQ(session->Snapshot(), before) << "a request has changed the scene";
      continue;
    }
    EXPECT_NE(session->Snapshot(), before) << "a change is not in the snapshot";
    if (traits.KeepsPoses()) {
      const auto steps = Steps(*session);
      for (const auto& [thing, step] : stepsBefore) {
        EXPECT_TRUE(steps.count(thing) && steps.at(thing) == step) << thing;
      }
    }
    const auto restored = this->MadeFromSnapshot(*session);
    EXPECT_EQ(restored->Snapshot(), session->Snapshot());
    this->ExpectTheSame(*session, *restored, "after the snapshot of " + traits.Name());
  }
}

// --- Limits and defaults -------------------------------------------------------------------------

using Visit = std::function<void(Message& message, const FieldDescriptor& field)>;

// Calls `visit` for every field with the option `(accepts)` of the messages that there are.
void ForEachLimit(Message& message, const Visit& visit) {
  const google::protobuf::Descriptor& type = *message.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    const auto* reflection = message.GetReflection();
    if (!field.message_type()) {
      if (field.options().HasExtension(v1::accepts)) {
        visit(message, field);
      }
    } else if (field.is_repeated()) {
      for (int n = 0; n < reflection->FieldSize(message, &field); ++n) {
        ForEachLimit(*reflection->MutableRepeatedMessage(&message, &field, n), visit);
      }
    } else if (reflection->HasField(message, &field)) {
      ForEachLimit(*reflection->MutableMessage(&message, &field), visit);
    }
  }
}

void Put(Message& message, const FieldDescriptor& field, double value) {
  const auto* reflection = message.GetReflection();
  switch (field.cpp_type()) {
  case FieldDescriptor::CPPTYPE_UINT32:
    return reflection->SetUInt32(&message, &field, std::uint32_t(value));
  case FieldDescriptor::CPPTYPE_UINT64:
    return reflection->SetUInt64(&message, &field, std::uint64_t(value));
  default:
    return reflection->SetDouble(&message, &field, value);
  }
}

// False: the message has no such text.
bool PutText(Message& message, const FieldDescriptor& field, const std::string& text) {
  const auto* reflection = message.GetReflection();
  if (!field.is_repeated()) {
    reflection->SetString(&message, &field, text);
  } else if (reflection->FieldSize(message, &field) > 0) {
    reflection->SetRepeatedString(&message, &field, 0, text);
  } else {
    return false;
  }
  return true;
}

// The commands of the table with one of their limited fields changed; the field's name goes with
// each.
template<class Change>
std::vector<std::pair<std::string, v1::Command>> Changed(const v1::Command& command,
                                                         Change change) {
  std::vector<std::pair<std::string, v1::Command>> all;
  int fields = 0;
  v1::Command copy = command;
  ForEachLimit(copy, [&fields](Message&, const FieldDescriptor&) { ++fields; });
  for (int wanted = 0; wanted < fields; ++wanted) {
    v1::Command one = command;
    int at = 0;
    std::string name;
    ForEachLimit(one, [&](Message& message, const FieldDescriptor& field) {
      if (at++ == wanted && change(message, field)) {
        name = field.name();
      }
    });
    if (!name.empty()) {
      all.emplace_back(name, one);
    }
  }
  return all;
}

TEST_F(EveryCommandTest, NumbersBeyondTheirLimitsAreRejectedAndTheLimitsAccepted) {
  int tried = 0;
  for (const CommandInstance& instance : EveryCommand()) {
    const v1::Command command = this->Parse(instance.command);
    const auto beyond = Changed(command, [](Message& message, const FieldDescriptor& field) {
      const v1::LimitOptions& limits = field.options().GetExtension(v1::accepts);
      if (limits.has_most_bytes()) {
        return PutText(message, field, std::string(limits.most_bytes() + 1, 'x'));
      }
      const bool high = limits.has_maximum();
      if (!high && limits.minimum() < 2) {
        return false; // no whole number above 0 is beyond it
      }
      Put(message, field, high ? limits.maximum() + 1 : limits.minimum() - 1);
      return true;
    });
    const auto within = Changed(command, [](Message& message, const FieldDescriptor& field) {
      const v1::LimitOptions& limits = field.options().GetExtension(v1::accepts);
      if (limits.has_most_bytes()) {
        std::string text(limits.most_bytes(), 'x');
        if (!field.is_repeated()) { // JSON stays what it is
          const std::string present = message.GetReflection()->GetString(message, &field);
          const bool model =
              message.GetDescriptor()->name() == "CameraModel" ||
              field.full_name() == v1::SetViewport::descriptor()->full_name() + ".lens";
          if (model && present.empty()) {
            return false; // a model that the instance does without
          }
          if (present.substr(0, 1) == "{") {
            text = present + std::string(limits.most_bytes() - present.size(), ' ');
          }
        }
        return PutText(message, field, text);
      }
      if (!limits.has_maximum()) {
        return false;
      }
      Put(message, field, limits.maximum());
      return limits.has_maximum();
    });
    for (const auto& [field, wrong] : beyond) {
      SCOPED_TRACE(session::CommandName(wrong) + " " + field);
      const auto session = this->Make(instance);
      const auto before = session->Snapshot();
      const v1::Reply reply = session->Execute(wrong);
      EXPECT_EQ(reply.error().kind(), v1::Error::INVALID_ARGUMENT);
      const bool text =
          reply.error().message().find(" bytes; accepted: up to ") != std::string::npos;
      EXPECT_TRUE(text || reply.error().message().find(field) != std::string::npos)
          << reply.error().message();
      EXPECT_NE(reply.error().message().find("accepted: "), std::string::npos)
          << reply.error().message();
      EXPECT_EQ(session->Snapshot(), before);
      ++tried;
    }
    for (const auto& [field, good] : within) {
      SCOPED_TRACE(session::CommandName(good) + " " + field);
      const v1::Reply reply = this->Make(instance)->Execute(good);
      EXPECT_FALSE(reply.has_error()) << reply.error().message();
    }
  }
  EXPECT_GT(tried, 25);
}

TEST_F(EveryCommandTest, AnAbsentNumberIsTheDefaultThatItsOptionStates) {
  int tried = 0;
  for (const CommandInstance& instance : EveryCommand()) {
    const v1::Command command = this->Parse(instance.command);
    const auto stated = [](const FieldDescriptor& field) {
      return field.options().GetExtension(v1::accepts).has_standard();
    };
    const auto absent = Changed(command, [&](Message& message, const FieldDescriptor& field) {
      if (stated(field)) {
        message.GetReflection()->ClearField(&message, &field);
      }
      return stated(field);
    });
    const auto given = Changed(command, [&](Message& message, const FieldDescriptor& field) {
      if (stated(field)) {
        Put(message, field, field.options().GetExtension(v1::accepts).standard());
      }
      return stated(field);
    });
    for (std::size_t i = 0; i < absent.size(); ++i) {
      SCOPED_TRACE(session::CommandName(command) + " " + absent[i].first);
      const auto one = this->Make(instance);
      const auto other = this->Make(instance);
      one->Accept(absent[i].second);
      other->Accept(given[i].second);
      this->ExpectTheSame(*one, *other, absent[i].first);
      ++tried;
    }
  }
  EXPECT_GT(tried, 12);
}

} // namespace
} // namespace dspace::testing
