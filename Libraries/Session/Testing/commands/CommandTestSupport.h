// Runs commands in tests.
#ifndef DSPACE_COMMAND_TEST_SUPPORT_H
#define DSPACE_COMMAND_TEST_SUPPORT_H

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include <dspace/interpreter/Interpreter.h>

#include "TemporaryFolder.h"

namespace dspace::testing {

using Kind = v1::Error;

// An interpreter with one scene, "scene".
class CommandTest : public ::testing::Test {
protected:
  CommandTest() {
    v1::Command command;
    command.mutable_create_scene();
    this->Accept(command);
  }

  v1::Reply Accept(v1::Command& command) {
    v1::Reply reply = this->Interpreter_.Execute(command);
    EXPECT_FALSE(reply.has_error()) << reply.error().message();
    return reply;
  }

  // The command is refused with this kind, its message holds `text`, and every answer about the
  // scene stays what it was.
  void Reject(v1::Command command, v1::Error::Kind kind, const std::string& text) {
    const std::string before = this->Picture();
    const v1::Reply reply = this->Interpreter_.Execute(command);
    EXPECT_EQ(reply.error().kind(), kind) << command.ShortDebugString() << reply.ShortDebugString();
    EXPECT_NE(reply.error().message().find(text), std::string::npos) << reply.error().message();
    EXPECT_EQ(reply.result_case(), v1::Reply::RESULT_NOT_SET);
    EXPECT_EQ(this->Picture(), before) << command.ShortDebugString();
  }

  // All that can be asked about the scene, as text.
  std::string Picture() { return PictureOf(this->Interpreter_); }

  static std::string PictureOf(session::Interpreter& interpreter) {
    std::string text;
    v1::FrameList frames;
    const auto ask = [&](auto fill) {
      v1::Command command;
      fill(command);
      const v1::Reply reply = interpreter.Execute(command);
      text += reply.DebugString();
      return reply;
    };
    frames = ask([](v1::Command& c) { c.mutable_list_frames(); }).frames();
    ask([&frames](v1::Command& c) {
      c.mutable_get_poses()->set_local(true);
      for (const v1::FrameInfo& frame : frames.frame()) {
        c.mutable_get_poses()->add_frame(frame.id());
      }
    });
    ask([](v1::Command& c) { c.mutable_list_objects(); });
    ask([](v1::Command& c) { c.mutable_list_fragments(); });
    ask([](v1::Command& c) { c.mutable_list_lights(); });
    ask([](v1::Command& c) { c.mutable_list_robots(); });
    ask([](v1::Command& c) { c.mutable_list_terrains(); });
    ask([](v1::Command& c) { c.mutable_get_time(); });
    ask([](v1::Command& c) { c.mutable_list_telemetry(); });
    ask([](v1::Command& c) { c.mutable_list_events(); });
    ask([](v1::Command& c) { c.mutable_list_questions(); });
    const v1::VantageList vantages =
        ask([](v1::Command& c) { c.mutable_list_vantages(); }).vantages();
    for (const v1::VantageInfo& vantage : vantages.vantage()) {
      for (const std::string& camera : vantage.camera()) {
        ask([&](v1::Command& c) {
          c.mutable_describe_camera()->set_vantage(vantage.name());
          c.mutable_describe_camera()->set_name(camera);
        });
      }
    }
    return text;
  }

  FrameId AddFrame(const std::string& name, FrameId parent = 0) {
    v1::Command command;
    command.mutable_create_frame()->set_name(name);
    command.mutable_create_frame()->set_parent(parent);
    return this->Accept(command).frame().frame();
  }

  ObjectId AddBox(const std::string& name = {}, FrameId frame = 0) {
    v1::Command command;
    v1::CreatePrimitive* create = command.mutable_create_primitive();
    create->mutable_object()->set_name(name);
    create->mutable_object()->set_frame(frame);
    v1::Vector3* size = create->mutable_box()->mutable_size();
    size->set_x(1);
    size->set_y(2);
    size->set_z(3);
    return this->Accept(command).object().object();
  }

  session::Interpreter Interpreter_;
};

// A file that goes with the test. All of a process lie in one folder of its own.
class TemporaryFile {
public:
  TemporaryFile(const std::string& name, const std::string& content) : Path_(Folder() / name) {
    std::ofstream(this->Path_, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::remove(this->Path_.c_str()); }
  const std::string& Path() const { return this->Path_; }

private:
  static const TemporaryFolder& Folder() {
    static const TemporaryFolder folder;
    return folder;
  }
  std::string Path_;
};

} // namespace dspace::testing

#endif
