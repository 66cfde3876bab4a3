#include <cmath>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

class CameraCommands : public CommandTest {};

void Set(v1::Vector3* v, double x, double y, double z) {
  v->set_x(x);
  v->set_y(y);
  v->set_z(z);
}

v1::Command LookingDown(const std::string& name) {
  v1::Command command;
  v1::SetCamera* set = command.mutable_set_camera();
  set->set_name(name);
  v1::LookAt* look = set->mutable_mount()->mutable_look_at();
  Set(look->mutable_eye(), 0, 0, 10);
  Set(look->mutable_target(), 0, 0, 0);
  Set(look->mutable_up(), 0, 1, 0);
  return command;
}

TEST_F(CameraCommands, LookAtPlacesASensorCamera) {
  v1::Command command = LookingDown("down");
  this->Accept(command);
  v1::Command describe;
  describe.mutable_describe_camera();
  const v1::CameraInfo info = this->Accept(describe).camera();
  EXPECT_EQ(info.name(), "down");
  EXPECT_TRUE(info.active());
  EXPECT_EQ(info.projection().perspective().vertical_fov_deg(), 45);
  // X right stays X; Y down is -Y; Z forward is -Z: half a turn about X.
  EXPECT_NEAR(std::abs(info.mount().pose().rotation().x()), 1, 1e-15);
  EXPECT_EQ(info.mount().pose().position().z(), 10);
}

TEST_F(CameraCommands, WhatIsNotGivenStays) {
  v1::Command command = LookingDown("down");
  this->Accept(command);
  v1::Command lens;
  lens.mutable_set_camera()->set_name("down");
  lens.mutable_set_camera()->mutable_projection()->mutable_orthographic()->set_height(30);
  this->Accept(lens);
  v1::Command describe;
  describe.mutable_describe_camera()->set_name("down");
  const v1::CameraInfo info = this->Accept(describe).camera();
  EXPECT_EQ(info.projection().orthographic().height(), 30);
  EXPECT_FALSE(info.projection().has_far()); // it follows what is drawn
  EXPECT_EQ(info.mount().pose().position().z(), 10);
}

TEST_F(CameraCommands, TheirPoseIsAnsweredInAnyFrame) {
  const FrameId carrier = this->AddFrame("carrier");
  v1::Command move; // (5, 2, 1), a quarter turn about Z
  move.mutable_set_poses()->add_frame(carrier);
  for (const double v : {5.0, 2.0, 1.0, std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5), 1.0}) {
    move.mutable_set_poses()->add_pose(v);
  }
  this->Accept(move);
  v1::Command camera;
  camera.mutable_set_camera()->set_name("chase");
  camera.mutable_set_camera()->mutable_mount()->set_frame(carrier);
  camera.mutable_set_camera()->mutable_mount()->mutable_chase()->mutable_offset()->set_x(-4);
  this->Accept(camera);
  v1::Command ask;
  ask.mutable_get_camera_pose()->set_name("chase");
  const v1::Pose inRoot = this->Accept(ask).camera_pose().pose(); // it heads along Y
  EXPECT_NEAR(inRoot.position().x(), 5, 1e-12);
  EXPECT_NEAR(inRoot.position().y(), -2, 1e-12);
  EXPECT_NEAR(inRoot.position().z(), 1, 1e-12);
  EXPECT_EQ(inRoot.scale(), 1);
  ask.mutable_get_camera_pose()->set_relative_to(carrier);
  const v1::Pose inCarrier = this->Accept(ask).camera_pose().pose();
  EXPECT_NEAR(inCarrier.position().x(), -4, 1e-12);
  EXPECT_NEAR(inCarrier.position().y(), 0, 1e-12);
  EXPECT_NEAR(inCarrier.position().z(), 0, 1e-12);
  ask.mutable_get_camera_pose()->set_relative_to(999);
  this->Reject(ask, Kind::NOT_FOUND, "999");
  ask.mutable_get_camera_pose()->set_name("none");
  this->Reject(ask, Kind::NOT_FOUND, "camera 'none'");
}

TEST_F(CameraCommands, ChaseIsKept) {
  const FrameId rover = this->AddFrame("rover");
  v1::Command command;
  v1::SetCamera* set = command.mutable_set_camera();
  set->set_name("chase");
  set->mutable_mount()->set_frame(rover);
  v1::Mount::Chase* chase = set->mutable_mount()->mutable_chase();
  chase->set_axes(v1::Mount::Chase::PARENT);
  Set(chase->mutable_offset(), -5, 1, 2);
  chase->set_smoothing_s(0.5);
  this->Accept(command);
  v1::Command describe;
  describe.mutable_describe_camera();
  const v1::Mount mount = this->Accept(describe).camera().mount();
  EXPECT_EQ(mount.frame(), rover);
  EXPECT_EQ(mount.chase().axes(), v1::Mount::Chase::PARENT);
  EXPECT_EQ(mount.chase().offset().y(), 1);
  EXPECT_EQ(mount.chase().up().z(), 1);
  EXPECT_EQ(mount.chase().smoothing_s(), 0.5);
  v1::Command remove;
  remove.mutable_remove_frame()->set_frame(rover);
  this->Reject(remove, v1::Error::INVALID_ARGUMENT, "chase");
}

TEST_F(CameraCommands, BadInputIsRejectedAndChangesNothing) {
  v1::Command good = LookingDown("down");
  this->Accept(good);
  v1::Command c = LookingDown("down");
  Set(c.mutable_set_camera()->mutable_mount()->mutable_look_at()->mutable_target(), 0, 0, 10);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "down"); // at its own target
  c.Clear();
  c.mutable_set_camera()->set_name("down");
  v1::Projection* projection = c.mutable_set_camera()->mutable_projection();
  projection->set_near(10);
  projection->set_far(1);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "down");
  projection->clear_far();
  projection->mutable_perspective()->set_vertical_fov_deg(180);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "180");
  projection->mutable_orthographic()->set_height(0);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "height");
  c.Clear();
  c.mutable_set_camera()->set_name("lost");
  c.mutable_set_camera()->mutable_mount()->set_frame(55);
  this->Reject(c, v1::Error::NOT_FOUND, "55");
  c.mutable_set_camera()->set_vantage("nowhere");
  this->Reject(c, v1::Error::NOT_FOUND, "nowhere");
  c.Clear();
  c.mutable_set_active_camera()->set_name("absent");
  this->Reject(c, v1::Error::NOT_FOUND, "absent");
  c.Clear();
  c.mutable_set_light()->set_name("bad");
  c.mutable_set_light()->set_intensity(-1);
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "bad");
  c.mutable_set_light()->set_intensity(1);
  c.mutable_set_light()->set_kind(static_cast<v1::SetLight::Kind>(17));
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "17");
  c.Clear();
  c.mutable_remove_fragment()->set_name("physical");
  this->Reject(c, v1::Error::INVALID_ARGUMENT, "physical");
}

TEST_F(CameraCommands, FragmentsAndLights) {
  v1::Command c;
  c.mutable_create_fragment()->set_name("arm");
  this->Accept(c);
  const ObjectId box = this->AddBox("box");
  v1::Command move;
  move.mutable_move_to_fragment()->set_object(box);
  move.mutable_move_to_fragment()->set_fragment("arm");
  this->Accept(move);
  v1::Command list;
  list.mutable_list_fragments();
  const v1::FragmentList fragments = this->Accept(list).fragments();
  ASSERT_EQ(fragments.fragment_size(), 3);
  EXPECT_EQ(fragments.fragment(2).object(0), box);
  v1::Command lights;
  lights.mutable_list_lights();
  EXPECT_EQ(this->Accept(lights).lights().light_size(), 1);
  v1::Command remove;
  remove.mutable_remove_light()->set_name("sun");
  this->Accept(remove);
  EXPECT_EQ(this->Accept(lights).lights().light_size(), 0);
}

} // namespace
} // namespace dspace::testing
