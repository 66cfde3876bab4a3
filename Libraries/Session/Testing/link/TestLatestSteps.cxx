// Superseded steps: without them the state is the same, to the bit.
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/interpreter/Interpreter.h>
#include <dspace/link/watching/LatestSteps.h>

namespace {

using namespace dspace;
using dspace::session::Interpreter;

constexpr int FrameCount = 5;

v1::WatchReply Message(const v1::Command& command) {
  v1::WatchReply message;
  *message.mutable_command() = command;
  return message;
}

v1::WatchReply Time(double time_s, const std::string& scene = "scene") {
  v1::Command command;
  command.set_scene(scene);
  command.mutable_set_time()->set_time_s(time_s);
  return Message(command);
}

v1::WatchReply Poses(const std::vector<std::uint64_t>& frames, double x,
                     const std::string& scene = "scene") {
  v1::Command command;
  command.set_scene(scene);
  command.mutable_set_poses();
  for (const std::uint64_t frame : frames) {
    command.mutable_set_poses()->add_frame(frame);
    for (const double value : {x + double(frame), 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
      command.mutable_set_poses()->add_pose(value);
    }
  }
  return Message(command);
}

v1::WatchReply Rename(std::uint64_t frame, const std::string& name) {
  v1::Command command;
  command.set_scene("scene");
  command.mutable_rename_frame()->set_frame(frame);
  command.mutable_rename_frame()->set_name(name);
  return Message(command);
}

// Two scenes of frames 2 to 6, each on the one before.
void Build(Interpreter& interpreter) {
  for (const char* scene : {"scene", "other"}) {
    v1::Command create;
    create.set_scene(scene);
    create.mutable_create_scene();
    ASSERT_FALSE(interpreter.Execute(create).has_error());
    for (int i = 0; i < FrameCount; ++i) {
      v1::Command frame;
      frame.set_scene(scene);
      frame.mutable_create_frame()->set_id(std::uint64_t(i + 2));
      frame.mutable_create_frame()->set_name("f" + std::to_string(i));
      frame.mutable_create_frame()->set_parent(std::uint64_t(i + 1));
      ASSERT_FALSE(interpreter.Execute(frame).has_error());
    }
  }
}

std::string StateOf(Interpreter& interpreter) {
  std::string text;
  for (const char* scene : {"scene", "other"}) {
    v1::Command poses;
    poses.set_scene(scene);
    for (int i = 0; i < FrameCount; ++i) {
      poses.mutable_get_poses()->add_frame(std::uint64_t(i + 2));
    }
    text += interpreter.Execute(poses).SerializeAsString();
    v1::Command time;
    time.set_scene(scene);
    time.mutable_get_time();
    text += interpreter.Execute(time).SerializeAsString();
    v1::Command list;
    list.set_scene(scene);
    list.mutable_list_frames();
    text += interpreter.Execute(list).SerializeAsString();
  }
  return text;
}

// Applies all of them; `latest`: without those that are superseded. Returns how many were applied.
int Apply(Interpreter& interpreter, std::vector<v1::WatchReply> messages, bool latest) {
  int applied = 0;
  std::size_t at = 0;
  while (at < messages.size()) {
    std::vector<bool> superseded(1, false);
    if (latest && session::IsStep(messages[at])) {
      superseded = session::SupersededSteps(messages, at);
    }
    for (const bool one : superseded) {
      if (!one) {
        const v1::Reply reply = interpreter.Execute(*messages[at].mutable_command());
        EXPECT_FALSE(reply.has_error()) << reply.error().message();
        ++applied;
      }
      ++at;
    }
  }
  return applied;
}

} // namespace

TEST(LatestSteps, OfAPlainStreamTheLastStepIsLeft) {
  std::vector<v1::WatchReply> messages;
  for (int i = 0; i < 100; ++i) {
    messages.push_back(Time(0.001 * i));
    messages.push_back(Poses({2, 3, 4}, i));
  }
  const std::vector<bool> superseded = session::SupersededSteps(messages, 0);
  ASSERT_EQ(superseded.size(), 200u);
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_EQ(superseded[i], i < 198) << i;
  }
  EXPECT_EQ(session::SupersededSteps(messages, 199), std::vector<bool>{false});
}

TEST(LatestSteps, WhatIsNotTheSameStays) {
  const std::vector<v1::WatchReply> messages = {
      Poses({2, 3}, 1), Poses({3, 2}, 2),          Poses({2}, 3),   Poses({2, 3, 4}, 4),
      Time(1),          Poses({2, 3}, 5, "other"), Time(2, "other")};
  EXPECT_EQ(session::SupersededSteps(messages, 0), std::vector<bool>(7, false));
}

TEST(LatestSteps, ARunEndsWithAnythingElse) {
  const std::vector<v1::WatchReply> messages = {Poses({2}, 1), Rename(2, "a"), Poses({2}, 2)};
  EXPECT_EQ(session::SupersededSteps(messages, 0), std::vector<bool>{false});
  EXPECT_FALSE(session::IsStep(messages[1]));
  v1::WatchReply lags = Time(1);
  lags.mutable_command()->mutable_set_time()->set_put_lags(true);
  EXPECT_FALSE(session::IsStep(lags));
  v1::WatchReply writer;
  writer.mutable_writer()->set_name("w");
  EXPECT_FALSE(session::IsStep(writer));
}

TEST(LatestSteps, TheStateIsTheSameToTheBit) {
  std::mt19937 random(7);
  const auto up = [&](int n) { return int(random() % unsigned(n)); };
  int all = 0;
  int applied = 0;
  for (int round = 0; round < 100; ++round) {
    std::vector<v1::WatchReply> messages;
    for (int i = 0; i < 80; ++i) {
      const std::string scene = up(3) ? "scene" : "other";
      switch (up(12)) {
      case 0:
        messages.push_back(Rename(std::uint64_t(2 + up(FrameCount)), "r" + std::to_string(i)));
        break;
      case 1:
      case 2:
      case 3:
        messages.push_back(Time(up(20) - 10, scene));
        break;
      default: {
        std::vector<std::uint64_t> frames;
        for (std::uint64_t id = 2; id < 2 + FrameCount; ++id) {
          if (up(3)) {
            frames.push_back(id);
          }
        }
        messages.push_back(Poses(frames, up(1000), scene));
      }
      }
    }
    Interpreter one;
    Interpreter other;
    Build(one);
    Build(other);
    all += Apply(one, messages, false);
    applied += Apply(other, messages, true);
    ASSERT_EQ(StateOf(one), StateOf(other)) << "round " << round;
  }
  EXPECT_LT(applied, all * 9 / 10);
}

TEST(LatestSteps, ALaggingCameraIsSeen) {
  Interpreter interpreter;
  Build(interpreter);
  EXPECT_FALSE(session::HasLaggingCamera(interpreter.GetState()));
  for (const double smoothing_s : {0.0, 0.5}) {
    v1::Command command;
    command.set_scene("other");
    v1::SetCamera& camera = *command.mutable_set_camera();
    camera.set_name("behind");
    camera.mutable_mount()->set_frame(3);
    v1::Mount::Chase& chase = *camera.mutable_mount()->mutable_chase();
    chase.mutable_offset()->set_x(-5);
    chase.set_smoothing_s(smoothing_s);
    const v1::Reply reply = interpreter.Execute(command);
    ASSERT_FALSE(reply.has_error()) << reply.error().message();
    EXPECT_EQ(session::HasLaggingCamera(interpreter.GetState()), smoothing_s > 0);
  }
}
