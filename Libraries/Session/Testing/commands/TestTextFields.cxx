// The text in messages: what is not UTF-8 is rejected in commands, and never leaves in replies.
#include <dspace/messages/TextFields.h>

#include <stdexcept>

#include <dspace/messages/ErrorReply.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

class TextFields : public CommandTest {
protected:
  // What the wire does with it: a message of text that is not UTF-8 cannot be parsed.
  template<class Message> static bool Arrives(const Message& message) {
    Message copy;
    return copy.ParseFromString(message.SerializeAsString());
  }
};

TEST_F(TextFields, AreFoundAndMadeUtf8AtAnyDepth) {
  v1::Reply reply;
  reply.mutable_frames()->add_frame()->set_name("plain");
  reply.add_warning("M\xC3\xA4st");
  EXPECT_EQ(session::FindInvalidText(reply), nullptr);
  EXPECT_TRUE(Arrives(reply));
  reply.mutable_frames()->add_frame()->set_path("a/M\xE4st");
  reply.add_warning("F\xFC\xDF"
                    "e");
  ASSERT_NE(session::FindInvalidText(reply), nullptr);
  EXPECT_FALSE(Arrives(reply));
  session::MakeTextUtf8(reply);
  EXPECT_EQ(session::FindInvalidText(reply), nullptr);
  EXPECT_TRUE(Arrives(reply));
  EXPECT_EQ(reply.frames().frame(0).name(), "plain");
  EXPECT_EQ(reply.frames().frame(1).path(), "a/M\xC3\xA4st");
  EXPECT_EQ(reply.warning(0), "M\xC3\xA4st");
  EXPECT_EQ(reply.warning(1), "F\xC3\xBC\xC3\x9F"
                              "e");
  v1::Reply bytes; // no text
  bytes.mutable_capture()->add_plane()->set_data("\xE4\xFF");
  session::MakeTextUtf8(bytes);
  EXPECT_EQ(bytes.capture().plane(0).data(), "\xE4\xFF");
}

TEST_F(TextFields, OfErrorRepliesAreUtf8) {
  const v1::Reply reply =
      session::Catch([]() -> v1::Reply { throw std::runtime_error("a library says 'M\xE4st'"); });
  EXPECT_EQ(reply.error().message(), "a library says 'M\xC3\xA4st'");
  EXPECT_TRUE(Arrives(session::ErrorReply(v1::Error::IO, "file '\xE4'", "\xE4")));
}

TEST_F(TextFields, OfCommandsAreRejectedByName) {
  v1::Command command;
  command.mutable_create_frame()->set_name("M\xE4st");
  this->Refuse(command, v1::Error::INVALID_ARGUMENT,
               "command create_frame: its field 'name' is not UTF-8; accepted: text of UTF-8");
  v1::Command scene;
  scene.set_scene("\xE4");
  scene.mutable_list_frames();
  this->Refuse(scene, v1::Error::INVALID_ARGUMENT, "its field 'scene' is not UTF-8");
}

// A handler that lets a library's text through: who hears of the command can read it all the same.
TEST_F(TextFields, OfWhatListenersHearAreUtf8) {
  this->Interpreter_.Commands().Add(v1::Command::kSetTime, &v1::Command::mutable_set_time,
                                    [](const session::Context& context, v1::SetTime&) {
                                      context.reply.add_warning("driver M\xE4st");
                                      context.reply.mutable_robot()->set_name("\xE4");
                                    });
  this->Interpreter_.Commands().Add(v1::Command::kRemoveFrame, &v1::Command::mutable_remove_frame,
                                    [](const session::Context& context, v1::RemoveFrame&) {
                                      context.reply.mutable_robot()->set_name("\xE4");
                                      throw std::runtime_error("M\xE4st");
                                    });
  this->Interpreter_.Commands().Add(
      v1::Command::kCreateFrame, &v1::Command::mutable_create_frame,
      [](const session::Context&, v1::CreateFrame& create) { create.set_name("\xE4"); });
  int heard = 0;
  this->Interpreter_.AddListener([&](const v1::Command& command, const v1::Reply& reply) {
    ++heard;
    EXPECT_TRUE(Arrives(command));
    EXPECT_TRUE(Arrives(reply));
    throw std::runtime_error("no r\xE4um"); // becomes a warning
  });
  v1::Command time;
  time.mutable_set_time();
  const v1::Reply reply = this->Interpreter_.Execute(time);
  ASSERT_EQ(reply.warning_size(), 2);
  EXPECT_EQ(reply.warning(0), "driver M\xC3\xA4st");
  EXPECT_NE(reply.warning(1).find("no r\xC3\xA4um"), std::string::npos);
  EXPECT_EQ(reply.robot().name(), "\xC3\xA4");
  v1::Command create;
  create.mutable_create_frame()->set_name("plain");
  EXPECT_TRUE(Arrives(this->Interpreter_.Execute(create)));
  EXPECT_TRUE(Arrives(create)); // as it is recorded
  EXPECT_EQ(heard, 2);
  v1::Command remove;
  remove.mutable_remove_frame();
  const v1::Reply failed = this->Interpreter_.Execute(remove);
  EXPECT_TRUE(Arrives(failed));
  EXPECT_EQ(failed.error().message(), "M\xC3\xA4st");
}

} // namespace
} // namespace dspace::testing
