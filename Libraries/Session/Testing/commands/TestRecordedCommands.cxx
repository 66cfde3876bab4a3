// Commands as recorded replay to the same scene, also after commands that were refused.
#include <vector>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

const char* const Arm = R"(<robot name="arm">
  <link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="upper"><visual><geometry><mesh filename="absent.stl"/></geometry></visual></link>
  <link name="lower"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 1"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="2 0 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/>
    <mimic joint="shoulder" multiplier="-2" offset="0"/>
  </joint>
</robot>)";

class RecordedCommands : public CommandTest {
protected:
  v1::RobotReply LoadArm(const std::string& path) {
    v1::Command command;
    command.mutable_load_robot()->set_path(path);
    const v1::Reply reply = this->Accept(command);
    EXPECT_EQ(reply.warning_size(), 1);
    EXPECT_NE(reply.warning(0).find("absent.stl"), std::string::npos);
    return reply.robot();
  }

  static v1::Command Joints(double position, bool clamp = false, std::uint32_t joint = 0) {
    v1::Command command;
    command.mutable_set_joints()->set_robot("arm");
    command.mutable_set_joints()->add_joint(joint);
    command.mutable_set_joints()->add_position(position);
    command.mutable_set_joints()->set_clamp(clamp);
    return command;
  }
};

TEST_F(RecordedCommands, JointsMoveFramesWithinTheirLimits) {
  const TemporaryFile file("arm.urdf", Arm);
  const v1::RobotReply robot = this->LoadArm(file.Path());
  ASSERT_EQ(robot.joint_size(), 2);
  EXPECT_EQ(robot.joint(1).mimic(), 0u);
  EXPECT_EQ(robot.link(1).object_size(), 1); // the stand-in
  v1::Command move = Joints(30);
  this->Accept(move);
  v1::Command get;
  get.mutable_get_poses()->add_frame(robot.link(2).frame());
  get.mutable_get_poses()->set_relative_to(robot.base());
  const v1::PosesReply lower = this->Accept(get).poses();
  // By hand: the elbow 2 m out at 30 degrees, the lower arm turned by 30 - 60 degrees.
  EXPECT_NEAR(lower.pose(0), 2 * std::cos(M_PI / 6), 1e-14);
  EXPECT_NEAR(lower.pose(1), 2 * std::sin(M_PI / 6), 1e-14);
  EXPECT_NEAR(lower.pose(2), 1, 1e-14);
  EXPECT_NEAR(lower.pose(6), std::sin(-M_PI / 12), 1e-14);

  this->Reject(Joints(60), v1::Error::INVALID_ARGUMENT, "shoulder");
  this->Reject(Joints(10, false, 1), v1::Error::INVALID_ARGUMENT, "follows");
  this->Reject(Joints(10, false, 9), v1::Error::NOT_FOUND, "9");
  this->Reject(Joints(NAN, true), v1::Error::INVALID_ARGUMENT, "shoulder");
  v1::Command clamped = Joints(60, true);
  this->Accept(clamped);
  v1::Command describe;
  describe.mutable_describe_robot()->set_robot("arm");
  EXPECT_NEAR(this->Accept(describe).robot().joint(0).position(), 180 / M_PI, 1e-12);
}

TEST_F(RecordedCommands, RobotsAreWholeOrNot) {
  const TemporaryFile file("arm.urdf", Arm);
  v1::Command load;
  load.mutable_load_robot()->set_path(file.Path());
  load.mutable_load_robot()->set_strict(true);
  this->Reject(load, v1::Error::NOT_FOUND, "absent.stl");
  this->AddFrame("arm");
  load.mutable_load_robot()->set_strict(false);
  this->Reject(load, v1::Error::ALREADY_EXISTS, "arm");
  load.mutable_load_robot()->set_name("arm 2");
  load.mutable_load_robot()->set_fragment("no such fragment");
  this->Reject(load, v1::Error::NOT_FOUND, "no such fragment"); // found out half way
  load.mutable_load_robot()->clear_fragment();
  load.mutable_load_robot()->set_base_id(50);
  this->Reject(load, v1::Error::INVALID_ARGUMENT, "base_id");
  load.mutable_load_robot()->set_base_id(0);
  const v1::RobotReply robot = this->Accept(load).robot();
  v1::Command remove;
  remove.mutable_remove_frame()->set_frame(robot.link(1).frame());
  this->Reject(remove, v1::Error::INVALID_ARGUMENT, "arm 2");
  v1::Command object;
  object.mutable_remove_object()->set_object(robot.link(0).object(0));
  this->Reject(object, v1::Error::INVALID_ARGUMENT, "arm 2");
  remove.mutable_remove_frame()->set_frame(robot.base());
  this->Accept(remove);
  v1::Command list;
  list.mutable_list_robots();
  EXPECT_EQ(this->Accept(list).robots().name_size(), 0);
}

TEST_F(RecordedCommands, ReplayGivesTheSameScene) {
  const TemporaryFile file("arm.urdf", Arm);
  std::vector<std::string> recorded;
  v1::Command scene;
  scene.mutable_create_scene();
  recorded.push_back(scene.SerializeAsString());
  const auto token =
      this->Interpreter_.AddListener([&](const v1::Command& command, const v1::Reply&) {
        recorded.push_back(command.SerializeAsString());
      });
  // Ids are used up by what fails or is removed again: the recording must carry those chosen.
  const FrameId gone = this->AddFrame("gone");
  v1::Command c;
  c.mutable_remove_frame()->set_frame(gone);
  this->Accept(c);
  c.Clear();
  c.mutable_load_robot()->set_path(file.Path());
  c.mutable_load_robot()->set_fragment("no such fragment");
  EXPECT_TRUE(this->Interpreter_.Execute(c).has_error());
  this->LoadArm(file.Path());
  v1::Command move = Joints(20);
  this->Accept(move);
  this->AddBox({}, this->AddFrame("rock"));
  v1::Command query;
  query.mutable_list_frames();
  this->Accept(query);
  EXPECT_EQ(recorded.size(), 7u); // neither the request nor what was refused

  session::Interpreter second;
  for (const std::string& bytes : recorded) {
    v1::Command command;
    ASSERT_TRUE(command.ParseFromString(bytes));
    const v1::Reply reply = second.Execute(command);
    EXPECT_FALSE(reply.has_error()) << reply.error().message();
    EXPECT_EQ(command.SerializeAsString(), bytes); // nothing was left to choose
  }
  EXPECT_EQ(PictureOf(second), this->Picture());
  EXPECT_TRUE(this->Interpreter_.RemoveListener(token));
  EXPECT_FALSE(this->Interpreter_.RemoveListener(token));
}

TEST_F(RecordedCommands, AListenerThatFailsIsReported) {
  this->Interpreter_.AddListener(
      [](const v1::Command&, const v1::Reply&) { throw std::runtime_error("disk full"); });
  v1::Command command;
  command.mutable_create_frame()->set_name("a");
  const v1::Reply reply = this->Accept(command);
  EXPECT_NE(reply.frame().frame(), 0u);
  ASSERT_EQ(reply.warning_size(), 1);
  EXPECT_NE(reply.warning(0).find("disk full"), std::string::npos);
}

} // namespace
} // namespace dspace::testing
