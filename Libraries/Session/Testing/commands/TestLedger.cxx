// The ledger's commands bring a new interpreter to the state of the one that it listened to.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include <dspace/ledger/Ledger.h>

#include "CommandTestSupport.h"
#include "RandomCommands.h"

namespace dspace::testing {
namespace {

// Limits, a joint that follows another, one that stays; a link's name that its base may take.
const char* const Arm = R"(<robot name="arm">
  <link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="upper"><visual><geometry><sphere radius="1"/></geometry></visual>
    <visual><geometry><box size="1 2 1"/></geometry></visual></link>
  <link name="lower"/><link name="tip"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 1"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="2 0 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/>
    <mimic joint="shoulder" multiplier="0" offset="0"/>
  </joint>
  <joint name="wrist" type="floating"><parent link="lower"/><child link="tip"/></joint>
</robot>)";

class LedgerTest : public CommandTest {
protected:
  LedgerTest() : File_("ledger_arm.urdf", Arm) {
    v1::Command scene;
    scene.mutable_create_scene();
    this->Ledger_.Add(scene, {}); // that of the fixture
    this->Interpreter_.AddListener([this](const v1::Command& command, const v1::Reply& reply) {
      this->Ledger_.Add(command, reply);
      this->Kinds_[command.command_case()]++;
    });
  }

  // PictureOf, without the order of objects in a fragment, with joints, and where cameras stand.
  static std::string StateOf(session::Interpreter& interpreter) {
    std::string text;
    std::istringstream lines(PictureOf(interpreter));
    std::vector<std::string> objects;
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("    object: ", 0) == 0) {
        objects.push_back(line);
        continue;
      }
      std::sort(objects.begin(), objects.end());
      for (const std::string& object : objects) {
        text += object + "\n";
      }
      objects.clear();
      text += line + "\n";
    }
    v1::Command list;
    list.mutable_list_robots();
    const v1::Reply robots = interpreter.Execute(list);
    for (const std::string& name : robots.robots().name()) {
      v1::Command describe;
      describe.mutable_describe_robot()->set_robot(name);
      text += interpreter.Execute(describe).DebugString();
    }
    const std::shared_ptr<Scene> scene = interpreter.FindScene("scene");
    for (const std::string& vantage : scene->VantageNames()) {
      for (const std::string& camera : scene->Vantage(vantage).CameraNames()) {
        const CameraPose pose = scene->PlaceCamera(vantage, camera);
        v1::Vector3 p;
        p.set_x(pose.X_FC.position.x());
        p.set_y(pose.X_FC.position.y());
        p.set_z(pose.X_FC.position.z());
        text += vantage + "/" + camera + std::to_string(pose.frame) + p.DebugString();
      }
    }
    for (const auto& [id, object] : scene->Objects()) { // trails
      text += std::to_string(id);
      for (const DetailLevel& level : object.levels) {
        for (const Part& part : level.parts) {
          for (const float x : part.mesh->positions) {
            text += " " + std::to_string(x);
          }
        }
      }
      text += object.visible ? "\n" : " hidden\n";
    }
    return text;
  }

  void ExpectRebuilt(const std::string& when) {
    session::Interpreter second;
    const std::vector<v1::Command> commands = this->Ledger_.Commands();
    for (v1::Command command : commands) {
      const v1::Reply reply = second.Execute(command);
      ASSERT_FALSE(reply.has_error())
          << when << ": " << command.DebugString() << reply.error().message();
    }
    ASSERT_EQ(StateOf(second), StateOf(this->Interpreter_)) << when;
  }

  TemporaryFile File_;
  session::Ledger Ledger_;
  std::map<int, int> Kinds_;
};

TEST_F(LedgerTest, RandomCommandsAreRebuilt) {
  std::map<int, int> kinds;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    this->Ledger_ = session::Ledger();
    v1::Command remove;
    remove.mutable_remove_scene();
    this->Accept(remove);
    v1::Command create;
    create.mutable_create_scene()->set_no_lights(seed % 5 == 0);
    this->Accept(create);
    RandomCommands random(seed, this->File_.Path());
    for (int i = 0; i < 400; ++i) {
      v1::Command command = random.Next();
      const v1::Reply reply = this->Interpreter_.Execute(command);
      if (!reply.has_error()) {
        random.Note(command, reply);
      }
      if (i % 133 == 0 || i == 399) {
        this->ExpectRebuilt("seed " + std::to_string(seed) + ", command " + std::to_string(i));
        if (HasFatalFailure()) {
          return;
        }
      }
    }
  }
  // Of every kind there were some that were accepted.
  using C = v1::Command;
  for (const int kind :
       {C::kCreateFrame,     C::kRemoveFrame,      C::kReparentFrame,      C::kRenameFrame,
        C::kSetPoses,        C::kLoadRobot,        C::kRemoveRobot,        C::kSetJoints,
        C::kCreatePrimitive, C::kCreateTrail,      C::kAppendTrail,        C::kClearTrail,
        C::kRemoveObject,    C::kSetObjectVisible, C::kSetMaterial,        C::kSetTilt,
        C::kSetPrimitive,    C::kSetObjectOffset,  C::kAttachObject,       C::kMoveToFragment,
        C::kCreateFragment,  C::kRemoveFragment,   C::kSetFragmentVisible, C::kSetLight,
        C::kRemoveLight,     C::kSetTime,          C::kCreateVantage,      C::kRemoveVantage,
        C::kSetCamera,       C::kRemoveCamera,     C::kSetActiveCamera,    C::kCreateTelemetry,
        C::kRemoveTelemetry, C::kSetTelemetry,     C::kSetTelemetryTexts,  C::kSetTelemetryLimits,
        C::kLogEvent,        C::kAskOperator,      C::kCloseQuestion,      C::kCreateMesh,
        C::kSetMesh,         C::kSetPart}) {
    EXPECT_GE(this->Kinds_[kind], 10) << "command " << kind;
  }
}

TEST_F(LedgerTest, WhatIsSupersededIsForgotten) {
  const FrameId frame = this->AddFrame("rover");
  for (int i = 0; i < 1000; ++i) {
    v1::Command step;
    step.mutable_set_poses()->add_frame(frame);
    for (const double value : {double(i), 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
      step.mutable_set_poses()->add_pose(value);
    }
    this->Accept(step);
    v1::Command time;
    time.mutable_set_time()->set_time_s(i);
    this->Accept(time);
    v1::Command material;
    material.mutable_set_material()->set_object(this->AddBox("box", frame));
    material.mutable_set_material()->mutable_material()->set_opacity(0.5);
    this->Accept(material);
    v1::Command gone;
    gone.mutable_remove_object()->set_object(material.set_material().object());
    this->Accept(gone);
  }
  const std::vector<v1::Command> commands = this->Ledger_.Commands();
  ASSERT_EQ(commands.size(), 5u); // the scene, its first time and its time, the frame, its pose
  EXPECT_EQ(commands[1].set_time().time_s(), 0.0);
  EXPECT_EQ(commands[2].set_time().time_s(), 999.0);
  EXPECT_EQ(commands[3].create_frame().id(), frame);
  EXPECT_EQ(commands[4].set_poses().pose(0), 999.0);
  this->ExpectRebuilt("after a thousand steps");
}

TEST_F(LedgerTest, UnknownCommandsStay) {
  v1::Command unknown; // none, as one of a later version looks
  this->Ledger_.Add(unknown, {});
  EXPECT_EQ(this->Ledger_.Commands().size(), 2u);
}

TEST_F(LedgerTest, TheBeginningOfTheSceneIsKept) {
  const auto begin = [](session::Interpreter& interpreter) {
    return interpreter.GetState().scenes.begin()->second.begin_s;
  };
  EXPECT_FALSE(begin(this->Interpreter_).has_value());
  for (const double time_s : {700.0, 702.0, 705.0}) {
    v1::Command time;
    time.mutable_set_time()->set_time_s(time_s);
    this->Accept(time);
  }
  session::Interpreter late; // of a viewer that comes now
  for (v1::Command command : this->Ledger_.Commands()) {
    ASSERT_FALSE(late.Execute(command).has_error());
  }
  EXPECT_EQ(begin(this->Interpreter_), 700.0);
  EXPECT_EQ(begin(late), 700.0);
  EXPECT_EQ(late.GetState().scenes.begin()->second.scene->Time(), 705.0);
}

TEST_F(LedgerTest, ASceneWithoutATimeDoesNotBeginAtItsLags) {
  v1::Command lags;
  lags.mutable_set_time()->set_put_lags(true);
  this->Accept(lags);
  v1::Command time;
  time.mutable_set_time()->set_time_s(700.0);
  this->Accept(time);
  time.mutable_set_time()->set_time_s(705.0);
  this->Accept(time);
  EXPECT_EQ(this->Interpreter_.GetState().scenes.begin()->second.begin_s, 700.0);
  EXPECT_EQ(this->Ledger_.Commands()[1].set_time().time_s(), 700.0);
}

} // namespace
} // namespace dspace::testing
