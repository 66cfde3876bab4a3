// Cameras and vantages of a scene: which is active, what they hold in place, how a chase lags.
#include "SceneTestSupport.h"

#include <cmath>

using namespace dspace;

TEST_F(SceneTest, OneCameraOfAVantageIsActive) {
  const auto& main = this->S.Vantage("main");
  EXPECT_EQ(main.ActiveCamera().name, "first");
  this->S.SetCamera("main", Fixed("second", this->Mast));
  EXPECT_EQ(main.ActiveCamera().name, "first");
  this->S.SetActiveCamera("main", "second");
  EXPECT_EQ(main.ActiveCamera().name, "second");
  EXPECT_EQ(this->S.PlaceCamera("main").frame, this->Mast);
  EXPECT_EQ(this->S.PlaceCamera("main", "first").frame, RootFrame);
  ExpectRejected(this->S, Invalid, "active", [&] { this->S.RemoveCamera("main", "second"); });
  ExpectRejected(this->S, NotFound, "third", [&] { this->S.SetActiveCamera("main", "third"); });
  ExpectRejected(this->S, NotFound, "third", [&] { this->S.RemoveCamera("main", "third"); });
  ExpectRejected(this->S, NotFound, "side", [&] { this->S.SetCamera("side", Fixed("c", 1)); });
  ExpectRejected(this->S, Exists, "main", [&] { this->S.CreateVantage("main"); });
  ExpectRejected(this->S, NotFound, "side", [&] { this->S.RemoveVantage("side"); });
  ExpectRejected(this->S, NotFound, "frame 99",
                 [&] { this->S.SetCamera("main", Fixed("first", 99)); });
  Camera bad = Fixed("first", 1);
  bad.projection.verticalFov_deg = 200;
  ExpectRejected(this->S, Invalid, "200", [&] { this->S.SetCamera("main", bad); });
  bad = Fixed("first", 1);
  bad.mount.kind = CameraMount::Kind::Chase;
  ExpectRejected(this->S, Invalid, "root", [&] { this->S.SetCamera("main", bad); });

  this->S.RemoveCamera("main", "first");
  this->S.RemoveCamera("main", "second"); // the last one may go
  EXPECT_THROW(this->S.PlaceCamera("main"), Error);
  this->S.SetCamera("main", Fixed("new", 1));
  EXPECT_EQ(main.ActiveCamera().name, "new");
  this->S.RemoveVantage("main");
  EXPECT_TRUE(this->S.VantageNames().empty());
}

TEST_F(SceneTest, AFrameTakesItsObjectsAndLightsAlong) {
  GraphicsObject camera = Object("camera box");
  camera.frame = this->Mast;
  this->S.AddObject(camera);
  const ObjectId rock = this->S.AddObject(Object("rock"));
  this->S.SetLight(Lamp("headlight", this->Mast));
  this->S.SetLight(Lamp("sun", RootFrame));
  this->S.RemoveFrame(this->Rover);
  EXPECT_FALSE(this->S.Frames().Contains(this->Rover));
  EXPECT_FALSE(this->S.Frames().Contains(this->Mast));
  EXPECT_EQ(this->S.Objects().size(), 1u);
  EXPECT_EQ(this->S.Fragments().Get("physical").objects, std::vector<ObjectId>{rock});
  ASSERT_EQ(this->S.Fragments().Lights().size(), 1u);
  EXPECT_EQ(this->S.Fragments().Lights()[0].name, "sun");
  EXPECT_EQ(this->S.FindObject("body"), 0u);
  GraphicsObject again = Object("body");
  again.id = this->Body;
  ExpectRejected(this->S, Exists, "in use", [&] { this->S.AddObject(again); });
}

TEST_F(SceneTest, AFrameUnderACameraStays) {
  this->S.SetLight(Lamp("headlight", this->Mast));
  this->S.SetCamera("main", Fixed("mastcam", this->Mast));
  ExpectRejected(this->S, Invalid, "mastcam", [&] { this->S.RemoveFrame(this->Rover); });
  Camera chase = Fixed("mastcam", this->Rover);
  chase.mount.kind = CameraMount::Kind::Chase;
  this->S.SetCamera("main", chase);
  ExpectRejected(this->S, Invalid, "follows", [&] { this->S.RemoveFrame(this->Rover); });
  ExpectRejected(this->S, Invalid, "root", [&] { this->S.RemoveFrame(RootFrame); });
  ExpectRejected(this->S, NotFound, "frame 99", [&] { this->S.RemoveFrame(99); });
  this->S.RemoveFrame(this->Mast); // the camera's frame is above it
  EXPECT_EQ(this->S.Frames().Size(), 2u);
}

TEST_F(SceneTest, ChaseLagDependsOnCommandsOnly) {
  Camera chase = Fixed("chase", this->Rover);
  chase.mount.kind = CameraMount::Kind::Chase;
  chase.mount.axes = CameraMount::ChaseAxes::Parent;
  chase.mount.offset = {-5, 0, 2};
  chase.mount.smoothing_s = 0.5;
  // The same commands, with the camera asked for never, once a step, or often.
  const auto run = [&](int asks) {
    Scene scene("s");
    const FrameId rover = scene.Frames().Create(RootFrame, "rover");
    scene.CreateVantage("v");
    chase.mount.frame = rover;
    scene.SetCamera("v", chase);
    for (int step = 1; step <= 10; ++step) {
      scene.SetTime(0.1 * step);
      Pose X;
      X.position.x() = 0.3 * step;
      scene.Frames().SetLocalPose(rover, X);
      for (int i = 0; i < asks; ++i) {
        scene.PlaceCamera("v");
      }
    }
    return scene.PlaceCamera("v").X_FC.position;
  };
  const Eigen::Vector3d p = run(0);
  EXPECT_EQ(p, run(1));
  EXPECT_EQ(p, run(3));
  // By hand: in place at time 0, then x' = w + (x - w) e^-0.2 with w = 0.3 step - 5.
  double x = -5.0;
  for (int step = 1; step <= 10; ++step) {
    const double wanted = 0.3 * step - 5.0;
    x = wanted + (x - wanted) * std::exp(-0.2);
  }
  EXPECT_NEAR(p.x(), x, 1e-12);
  EXPECT_EQ(p.z(), 2.0);
}

TEST_F(SceneTest, ChaseLagBeginsWhenTheCameraIsSet) {
  Camera chase = Fixed("chase", this->Rover);
  chase.mount.kind = CameraMount::Kind::Chase;
  chase.mount.axes = CameraMount::ChaseAxes::Parent;
  chase.mount.offset = {-5, 0, 2};
  chase.mount.smoothing_s = 2.0;
  this->S.SetCamera("main", chase);
  const auto place = [&] { return this->S.PlaceCamera("main", "chase").X_FC.position.x(); };
  // A move before any time step: no time has passed, so the camera has not moved.
  Pose X;
  X.position = {10, 0, 0};
  this->S.Frames().SetLocalPose(this->Rover, X);
  EXPECT_EQ(place(), -5.0);
  EXPECT_EQ(place(), -5.0);
  // In its place at 5 it is 10 late, which decays by exp(-dt / tau), in one step or in several.
  this->S.SetTime(0.5);
  EXPECT_NEAR(place(), 5.0 - 10.0 * std::exp(-0.25), 1e-12);
  this->S.SetTime(3.0);
  EXPECT_NEAR(place(), 5.0 - 10.0 * std::exp(-1.5), 1e-12);
  // Without smoothing it forgets where it was.
  chase.mount.smoothing_s = 0.0;
  this->S.SetCamera("main", chase);
  EXPECT_EQ(place(), 5.0);
  chase.mount.smoothing_s = 2.0;
  this->S.SetCamera("main", chase);
  EXPECT_EQ(place(), 5.0);
}

TEST_F(SceneTest, ChaseLagOutlivesAChangeOfLensNotOfFrame) {
  Camera chase = Fixed("chase", this->Rover);
  chase.mount.kind = CameraMount::Kind::Chase;
  chase.mount.smoothing_s = 1e6;
  this->S.SetCamera("main", chase);
  this->S.SetTime(1.0);
  Pose X;
  X.position = {100, 0, 0};
  this->S.Frames().SetLocalPose(this->Rover, X);
  chase.projection.verticalFov_deg = 20;
  this->S.SetCamera("main", chase);
  EXPECT_NEAR(this->S.PlaceCamera("main", "chase").X_FC.position.x(), -5.0, 1e-3);
  this->S.SetTime(0.5); // back: starts again
  EXPECT_NEAR(this->S.PlaceCamera("main", "chase").X_FC.position.x(), 95.0, 1e-9);
  this->S.SetTime(2.0);
  chase.mount.frame = this->Mast;
  this->S.SetCamera("main", chase);
  EXPECT_EQ(this->S.PlaceCamera("main", "chase").frame, this->Rover);
  EXPECT_NEAR(this->S.PlaceCamera("main", "chase").X_FC.position.x(), -5.0, 1e-9);
}
