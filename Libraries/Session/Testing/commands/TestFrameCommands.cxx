#include <cmath>
#include <limits>

#include <dspace/messages/NearMatches.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

class FrameCommands : public CommandTest {};

void AddRow(v1::SetPoses* poses, FrameId frame, std::initializer_list<double> row) {
  poses->add_frame(frame);
  for (const double value : row) {
    poses->add_pose(value);
  }
}

TEST_F(FrameCommands, CreateFindAndListFrames) {
  const FrameId rover = this->AddFrame("rover");
  const FrameId mast = this->AddFrame("mast", rover);
  v1::Command find;
  find.mutable_find_frame()->set_path("rover/mast");
  EXPECT_EQ(this->Accept(find).frame().frame(), mast);
  v1::Command list;
  list.mutable_list_frames();
  const v1::FrameList frames = this->Accept(list).frames();
  ASSERT_EQ(frames.frame_size(), 3);
  EXPECT_EQ(frames.frame(0).id(), RootFrame);
  EXPECT_EQ(frames.frame(2).path(), "rover/mast");
  EXPECT_EQ(frames.frame(2).parent(), rover);
  EXPECT_EQ(frames.frame(1).child(0), mast);
}

TEST_F(FrameCommands, ManyFramesAreCreatedByOneCommand) {
  const FrameId rover = this->AddFrame("rover");
  v1::Command command;
  v1::CreateFrames* create = command.mutable_create_frames();
  for (const char* name : {"a", "b", "c"}) {
    create->add_name(name);
  }
  EXPECT_EQ(this->Accept(command).frame().frame(), rover + 1);
  EXPECT_EQ(create->id(), rover + 1); // as recorded
  for (const double value : {1., 2., 3., 1., 0., 0., 0., 1., 0., 0., 5., 0.,
                             1., 0., 0., 2., 7., 0., 0., 1., 0., 0., 0., 1.}) {
    create->add_pose(value);
  }
  create->set_id(100);
  create->add_parent(rover);
  create->add_parent(100);
  create->add_parent(0);
  create->set_name(2, "d");
  this->Accept(command);
  const FrameTree& frames = this->Interpreter_.FindScene("scene")->Frames();
  EXPECT_EQ(frames.Path(101), "rover/a/b");
  EXPECT_EQ(frames.Path(102), "d");
  EXPECT_EQ(frames.WorldPose(101).position, Eigen::Vector3d(1, 2, 8));
  EXPECT_EQ(frames.LocalPose(101).scale, 2.0);

  const auto rejected = [&](v1::Error::Kind kind, const std::string& text, auto spoil) {
    v1::Command bad = command;
    bad.mutable_create_frames()->set_id(0);
    for (int i = 0; i < 3; ++i) {
      bad.mutable_create_frames()->set_name(i, "n" + std::to_string(i));
    }
    spoil(*bad.mutable_create_frames());
    this->Reject(bad, kind, text);
  };
  rejected(Kind::INVALID_ARGUMENT, "0 names", [](auto& c) { c.clear_name(); });
  rejected(Kind::INVALID_ARGUMENT, "2 parents", [](auto& c) { c.mutable_parent()->RemoveLast(); });
  rejected(Kind::INVALID_ARGUMENT, "2 poses", [](auto& c) { c.mutable_pose()->Truncate(16); });
  rejected(Kind::INVALID_ARGUMENT, "pose", [](auto& c) { c.mutable_pose()->Truncate(17); });
  rejected(Kind::ALREADY_EXISTS, "'rover'", [](auto& c) { c.set_name(2, "rover"); });
  rejected(Kind::NOT_FOUND, "4711", [](auto& c) { c.set_parent(2, 4711); });
  rejected(Kind::INVALID_ARGUMENT, "quaternion", [](auto& c) { c.set_pose(19, 0.5); });
  rejected(Kind::INVALID_ARGUMENT, "UTF-8", [](auto& c) { c.set_name(1, "M\xe4st"); });
}

TEST(NearMatches, AreTheNamesThatMayBeMeant) {
  using session::NearMatches;
  const std::vector<std::string> names = {"rover", "rover/mast", "rover/mast_pan", "lander",
                                          "rover/wheel_fl"};
  using Names = std::vector<std::string>;
  EXPECT_EQ(NearMatches("rovr", names), Names{"rover"});
  EXPECT_EQ(NearMatches("ROVER", names), Names{"rover"});
  EXPECT_EQ(NearMatches("mast", names), (Names{"rover/mast", "rover/mast_pan"}));
  EXPECT_EQ(NearMatches("other/mast", names), (Names{"rover/mast", "rover/mast_pan"}));
  EXPECT_EQ(NearMatches("wheel_fr", names), Names{"rover/wheel_fl"});
  EXPECT_EQ(NearMatches("antenna", names), Names());
  EXPECT_EQ(NearMatches("x", {"y", "z"}), Names()); // another name altogether
  EXPECT_EQ(NearMatches("", names), Names());
  EXPECT_EQ(NearMatches("a1", {"a2", "a3", "a4", "a5"}), (Names{"a2", "a3", "a4"}));
}

TEST_F(FrameCommands, AMissingFrameIsReportedWithNearMatches) {
  const FrameId rover = this->AddFrame("rover");
  this->AddFrame("mast", rover);
  v1::Command find;
  find.mutable_find_frame()->set_path("rover/mats");
  this->Reject(find, v1::Error::NOT_FOUND, "near matches: 'rover/mast'");
  find.mutable_find_frame()->set_base(rover);
  find.mutable_find_frame()->set_path("mat");
  this->Reject(find, v1::Error::NOT_FOUND, "near matches: 'mast'");
  find.mutable_find_frame()->set_path("antenna");
  EXPECT_EQ(this->Interpreter_.Execute(find).error().message().find("near"), std::string::npos);
}

TEST_F(FrameCommands, PosesOfManyFramesInOneCommand) {
  const FrameId a = this->AddFrame("a");
  const FrameId b = this->AddFrame("b", a);
  v1::Command set;
  const double h = std::sqrt(0.5);
  AddRow(set.mutable_set_poses(), a,
         {1, 0, 0, h, 0, 0, h, 2}); // 90 degrees about Z, twice as large
  AddRow(set.mutable_set_poses(), b, {1, 0, 0, 1, 0, 0, 0, 1});
  this->Accept(set);
  v1::Command get;
  get.mutable_get_poses()->add_frame(b);
  get.mutable_get_poses()->set_relative_to(RootFrame);
  const v1::PosesReply world = this->Accept(get).poses();
  ASSERT_EQ(world.pose_size(), 8);
  // By hand: (1, 0, 0) + 2 * (0, 1, 0).
  EXPECT_NEAR(world.pose(0), 1, 1e-15);
  EXPECT_NEAR(world.pose(1), 2, 1e-15);
  EXPECT_NEAR(world.pose(3), h, 1e-15);
  EXPECT_EQ(world.pose(7), 2);
  get.mutable_get_poses()->set_local(true);
  EXPECT_EQ(this->Accept(get).poses().pose(1), 0);
}

TEST_F(FrameCommands, ReparentKeepsTheWorldPoseOrTheLocalOne) {
  const FrameId a = this->AddFrame("a");
  const FrameId b = this->AddFrame("b");
  v1::Command set;
  AddRow(set.mutable_set_poses(), a, {10, 0, 0, 1, 0, 0, 0, 1});
  AddRow(set.mutable_set_poses(), b, {3, 4, 5, 1, 0, 0, 0, 1});
  this->Accept(set);
  v1::Command move;
  move.mutable_reparent_frame()->set_frame(b);
  move.mutable_reparent_frame()->set_parent(a);
  move.mutable_reparent_frame()->set_keep_world_pose(true);
  this->Accept(move);
  v1::Command get;
  get.mutable_get_poses()->add_frame(b);
  get.mutable_get_poses()->set_local(true);
  EXPECT_EQ(this->Accept(get).poses().pose(0), -7);
  move.mutable_reparent_frame()->set_parent(0);
  move.mutable_reparent_frame()->set_keep_world_pose(false);
  this->Accept(move);
  EXPECT_EQ(this->Accept(get).poses().pose(0), -7);
}

TEST_F(FrameCommands, RemovedFramesAreNamedChildrenFirst) {
  const FrameId a = this->AddFrame("a");
  const FrameId b = this->AddFrame("b", a);
  this->AddBox("box", b);
  v1::Command remove;
  remove.mutable_remove_frame()->set_frame(a);
  const v1::RemovedFrames removed = this->Accept(remove).removed_frames();
  ASSERT_EQ(removed.frame_size(), 2);
  EXPECT_EQ(removed.frame(0), b);
  EXPECT_EQ(removed.frame(1), a);
  v1::Command list;
  list.mutable_list_objects();
  EXPECT_EQ(this->Accept(list).objects().object_size(), 0);
}

TEST_F(FrameCommands, BadInputIsRejectedAndChangesNothing) {
  const FrameId a = this->AddFrame("a");
  const FrameId b = this->AddFrame("b", a);
  v1::Command c;
  c.mutable_create_frame()->set_name("a");
  this->Reject(c, v1::Error::ALREADY_EXISTS, "a");
  c.mutable_create_frame()->set_name("x/y");
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "x/y");
  c.mutable_create_frame()->set_name("new");
  c.mutable_create_frame()->set_parent(99);
  this->Reject(c, v1::Error::NOT_FOUND, "99");
  c.mutable_create_frame()->set_parent(0);
  c.mutable_create_frame()->mutable_pose()->mutable_rotation()->set_w(2);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "new");
  c.Clear();
  c.mutable_reparent_frame()->set_frame(a);
  c.mutable_reparent_frame()->set_parent(b);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "a");
  c.Clear();
  AddRow(c.mutable_set_poses(), a, {5, 0, 0, 1, 0, 0, 0, 1});
  AddRow(c.mutable_set_poses(), b, {NAN, 0, 0, 1, 0, 0, 0, 1});
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "a/b");
  c.mutable_set_poses()->mutable_pose()->RemoveLast();
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "15 numbers");
  c.Clear();
  AddRow(c.mutable_set_poses(), a, {5, 0, 0, 1, 0, 0, 0, 1});
  c.mutable_set_poses()->add_frame(b);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "1 poses for 2 frames");
  c.Clear();
  c.mutable_remove_frame()->set_frame(RootFrame);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "root");
  c.Clear();
  c.mutable_find_frame()->set_path("a/nothing");
  this->Reject(c, v1::Error::NOT_FOUND, "a/nothing");
}

TEST_F(FrameCommands, UnknownCommandsAndScenesAreRejectedByName) {
  v1::Command c;
  this->Reject(c, v1::Error::UNSUPPORTED, "none");
  ASSERT_TRUE(c.ParseFromString(std::string("\xfa\x3e\x00", 3))); // field 1007, empty message
  this->Reject(c, v1::Error::UNSUPPORTED, "number 1007");
  c.Clear();
  c.mutable_capture();
  this->Reject(c, v1::Error::UNSUPPORTED, "capture"); // the plain interpreter draws nothing
  c.Clear();
  c.set_scene("moon");
  c.mutable_create_frame()->set_name("x");
  this->Reject(c, v1::Error::NOT_FOUND, "moon");
  c.Clear();
  c.mutable_create_scene();
  this->Reject(c, v1::Error::ALREADY_EXISTS, "scene");
  c.Clear();
  c.mutable_set_time()->set_time_s(std::numeric_limits<double>::infinity());
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "time");
}

} // namespace
} // namespace dspace::testing
