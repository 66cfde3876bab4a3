// A viewer's own vantages and cameras beside what a simulation does (viewports: Python.watching),
// and whom its banner hears.
#include <dspace/link/watching/ViewerViews.h>

#include <memory>

#include <dspace/link/watching/LinkBanner.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

using session::Interpreter;
using session::ViewerViews;

constexpr const char* Mine = "viewer:mine";

v1::Command CreateVantage(const std::string& name) {
  v1::Command command;
  command.mutable_create_vantage()->set_name(name);
  return command;
}

// At (x, 0, 0) of a frame, looking along its Z.
v1::Command SetCamera(const std::string& vantage, FrameId frame, double x) {
  v1::Command command;
  v1::SetCamera* set = command.mutable_set_camera();
  set->set_vantage(vantage);
  set->set_name("camera");
  set->mutable_mount()->set_frame(frame);
  set->mutable_mount()->mutable_pose()->mutable_position()->set_x(x);
  return command;
}

class ViewerViewsTest : public CommandTest {
protected:
  // Two frames, the child turned by 90 degrees about Z, and a camera of the viewer's on it.
  void SetUp() override {
    this->Parent = this->AddFrame("parent");
    this->Child = this->AddFrame("child", this->Parent);
    this->Put(this->Interpreter_);
    v1::Command create = CreateVantage(Mine);
    ASSERT_TRUE(this->Own.Owns(create));
    ASSERT_FALSE(this->Own.Execute(this->Interpreter_, create).has_error());
    v1::Command set = SetCamera(Mine, this->Child, 5);
    ASSERT_TRUE(this->Own.Owns(set));
    ASSERT_FALSE(this->Own.Execute(this->Interpreter_, set).has_error());
  }

  void Put(Interpreter& interpreter) {
    v1::Command command;
    const double h = std::sqrt(0.5);
    command.mutable_set_poses()->add_frame(this->Parent);
    command.mutable_set_poses()->add_frame(this->Child);
    for (const double v : {100.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
      command.mutable_set_poses()->add_pose(v);
    }
    for (const double v : {0.0, 10.0, 0.0, h, 0.0, 0.0, h, 1.0}) {
      command.mutable_set_poses()->add_pose(v);
    }
    EXPECT_FALSE(interpreter.Execute(command).has_error());
  }

  // The same scene in another interpreter, with other ids.
  void Build(Interpreter& interpreter, FrameId first) {
    v1::Command command;
    command.mutable_create_scene();
    interpreter.Execute(command);
    for (const auto& [id, parent, name] :
         {std::tuple{first, FrameId(1), "parent"}, {first + 1, first, "child"}}) {
      command.mutable_create_frame()->set_id(id);
      command.mutable_create_frame()->set_parent(parent);
      command.mutable_create_frame()->set_name(name);
      ASSERT_FALSE(interpreter.Execute(command).has_error());
    }
  }

  // By hand: the parent's 100, the child's 10, and X of the child is Y of the root.
  void ExpectInRoot(Interpreter& interpreter) {
    const Camera& camera = interpreter.FindScene("scene")->Vantage(Mine).GetCamera("camera");
    EXPECT_EQ(camera.mount.frame, RootFrame);
    EXPECT_LT((camera.mount.X_FC.position - Eigen::Vector3d(100, 15, 0)).norm(), 1e-12);
    EXPECT_NEAR(camera.mount.X_FC.rotation.w(), std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(camera.mount.X_FC.rotation.z(), std::sqrt(0.5), 1e-12);
  }

  FrameId Parent = 0, Child = 0;
  ViewerViews Own;
};

// What a snapshot's command is refused for is no matter of views that are not there yet.
TEST_F(ViewerViewsTest, MakesNoRoomWhileASnapshotIsApplied) {
  this->Own.BeforeSnapshot(this->Interpreter_);
  Interpreter next;
  v1::Command command;
  command.mutable_create_scene();
  ASSERT_FALSE(next.Execute(command).has_error());
  for (int i = 0; i < 5; ++i) {
    v1::Command refused;
    if (i == 0) {
      refused.mutable_remove_frame()->set_frame(this->Parent);
    } else if (i == 1) {
      refused.mutable_remove_robot()->set_robot("arm");
    } else if (i == 2) {
      refused.mutable_remove_vantage()->set_name(Mine);
    } else if (i == 3) {
      refused.mutable_remove_camera()->set_name("camera");
    } else {
      refused.mutable_import_object()->add_level()->set_path("/nowhere/at/all.obj");
    }
    ASSERT_TRUE(next.Execute(refused).has_error());
    EXPECT_NO_THROW(EXPECT_FALSE(this->Own.RemoveConflicting(next, refused))) << i;
  }
}

TEST_F(ViewerViewsTest, OwnsItsOwnAlone) {
  for (v1::Command command : {CreateVantage("main 2"), SetCamera("main", 1, 0), SetCamera("", 1, 0),
                              SetCamera("viewer:another's", 1, 0)}) {
    EXPECT_FALSE(this->Own.Owns(command)) << command.ShortDebugString();
  }
  v1::Command remove;
  remove.mutable_remove_viewport()->set_viewport("view");
  EXPECT_FALSE(this->Own.Owns(remove));
  remove.mutable_remove_vantage()->set_name("main");
  EXPECT_FALSE(this->Own.Owns(remove));
  remove.mutable_remove_vantage()->set_name(Mine);
  EXPECT_TRUE(this->Own.Owns(remove));
  remove.set_scene("other");
  EXPECT_FALSE(this->Own.Owns(remove));
  EXPECT_FALSE(this->Own.Owns(v1::Command()));
}

TEST_F(ViewerViewsTest, OutlastASnapshotAndLoseNothingOfTheCamera) {
  v1::Command project;
  project.mutable_set_camera()->set_vantage(Mine);
  project.mutable_set_camera()->set_name("camera");
  project.mutable_set_camera()->mutable_projection()->mutable_perspective()->set_vertical_fov_deg(
      20);
  ASSERT_FALSE(this->Own.Execute(this->Interpreter_, project).has_error());
  this->Own.BeforeSnapshot(this->Interpreter_);
  Interpreter next;
  this->Build(next, 100);
  this->Own.AfterSnapshot(next);
  this->Own.Resume(next, false);
  const Camera& camera = next.FindScene("scene")->Vantage(Mine).GetCamera("camera");
  EXPECT_EQ(camera.mount.frame, 101u); // it follows on the frame of that path
  EXPECT_EQ(camera.mount.X_FC.position.x(), 5);
  EXPECT_EQ(camera.projection.verticalFov_deg, 20);
}

TEST_F(ViewerViewsTest, WithoutItsFrameACameraStaysWhereItWas) {
  this->Own.BeforeSnapshot(this->Interpreter_);
  for (const bool alone : {true, false}) {
    Interpreter next;
    ViewerViews own = this->Own;
    v1::Command command;
    command.mutable_create_scene();
    next.Execute(command);
    own.AfterSnapshot(next);
    own.Resume(next, alone);
    if (!alone) { // whoever drives may be about to build the scene,
      EXPECT_EQ(next.FindScene("scene")->VantageNames().size(), 1u);
      command.mutable_set_time()->set_time_s(0.1);
      next.Execute(command);
      own.Resume(next, false); // and has gone on without
    }
    this->ExpectInRoot(next);
  }
}

TEST_F(ViewerViewsTest, AFrameThatTheSimulationRemovesGoes) {
  v1::Command remove;
  remove.mutable_remove_frame()->set_frame(this->Parent);
  ASSERT_TRUE(this->Interpreter_.Execute(remove).has_error());
  ASSERT_TRUE(this->Own.RemoveConflicting(this->Interpreter_, remove));
  EXPECT_FALSE(this->Interpreter_.Execute(remove).has_error());
  this->ExpectInRoot(this->Interpreter_);
  EXPECT_FALSE(
      this->Own.RemoveConflicting(this->Interpreter_, remove)); // nothing is in the way any more
}

TEST_F(ViewerViewsTest, ViewsSleepWhileThereIsNoScene) {
  v1::Command remove;
  remove.mutable_remove_scene();
  this->Own.RemoveConflicting(this->Interpreter_, remove);
  EXPECT_FALSE(this->Interpreter_.Execute(remove).has_error());
  EXPECT_FALSE(this->Own.Owns(SetCamera(Mine, 1, 0)));
  this->Own.BeforeSnapshot(this->Interpreter_);
  Interpreter next; // two snapshots without it
  this->Own.AfterSnapshot(next);
  this->Own.Resume(next, true);
  this->Own.BeforeSnapshot(next);
  Interpreter last;
  this->Own.AfterSnapshot(last);
  this->Own.Resume(last, false);
  EXPECT_TRUE(last.GetState().scenes.empty());
  this->Build(last, 200);
  this->Own.Resume(last, false);
  EXPECT_EQ(last.FindScene("scene")->Vantage(Mine).GetCamera("camera").mount.frame, 201u);
  EXPECT_TRUE(this->Own.Owns(SetCamera(Mine, 1, 0)));
}

TEST_F(ViewerViewsTest, ASceneThatIsGoneOrAnotherIsLeft) {
  v1::Command remove;
  remove.mutable_remove_scene();
  this->Accept(remove); // RemoveConflicting has not been told
  EXPECT_NO_THROW(this->Own.BeforeSnapshot(this->Interpreter_));
  v1::Command scene;
  scene.mutable_create_scene();
  this->Accept(scene);
  EXPECT_NO_THROW(this->Own.BeforeSnapshot(this->Interpreter_));
}

TEST_F(ViewerViewsTest, ANewViewTakesTheNameOfASuspendedOne) {
  v1::Command remove;
  remove.mutable_remove_scene();
  this->Own.RemoveConflicting(this->Interpreter_, remove);
  this->Interpreter_.Execute(remove);
  v1::Command scene;
  scene.mutable_create_scene();
  this->Interpreter_.Execute(scene);
  v1::Command create = CreateVantage(Mine);
  ASSERT_FALSE(this->Own.Execute(this->Interpreter_, create).has_error());
  v1::Command set = SetCamera(Mine, 1, 7);
  ASSERT_FALSE(this->Own.Execute(this->Interpreter_, set).has_error());
  this->Own.Resume(this->Interpreter_, true);
  const Camera& camera = this->Interpreter_.FindScene("scene")->Vantage(Mine).GetCamera("camera");
  EXPECT_EQ(camera.mount.X_FC.position.x(), 7);
}

// An interpreter may outlast who follows it.
TEST(LinkBanner, LeavesNoListenerBehind) {
  Interpreter first, second;
  const auto nothing = [](const v1::Command&, const v1::Reply&) {};
  auto banner = std::make_unique<session::LinkBanner>();
  for (Interpreter* each : {&first, &second}) {
    ASSERT_EQ(each->AddListener(nothing), 1u);
    banner->Follow(*each);
    ASSERT_EQ(each->AddListener(nothing), 3u); // the banner's is 2
  }
  EXPECT_FALSE(first.RemoveListener(2));
  banner.reset();
  EXPECT_FALSE(second.RemoveListener(2));
  EXPECT_TRUE(second.RemoveListener(3));
}

} // namespace
} // namespace dspace::testing
