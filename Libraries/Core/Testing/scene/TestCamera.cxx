// Projections by hand and by two independent paths; look-at and chase placement by hand.
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/scene/Camera.h>

namespace {

using dspace::Camera;
using dspace::CameraMount;
using dspace::CameraPose;
using dspace::ChaseState;
using dspace::FrameId;
using dspace::FrameTree;
using dspace::Pose;
using dspace::Projection;
using Eigen::Vector3d;

constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Degree = 3.14159265358979323846 / 180.0;

Projection Perspective(double nearDistance, double farDistance) {
  Projection p;
  p.verticalFov_deg = 90.0;
  p.nearDistance = nearDistance;
  p.farDistance = farDistance;
  return p;
}

Projection Orthographic() {
  Projection p;
  p.kind = Projection::Kind::Orthographic;
  p.height = 4.0;
  p.nearDistance = -1.0;
  p.farDistance = 9.0;
  return p;
}

Projection OffAxis() {
  Projection p;
  p.kind = Projection::Kind::Frustum;
  p.left = -0.1;
  p.right = 0.7;
  p.top = -0.6;
  p.bottom = -0.2;
  p.nearDistance = 0.5;
  p.farDistance = 200.0;
  return p;
}

// Pixel and buffer depth of p_C by the clip matrix, as OpenGL's viewport transform has it.
Vector3d ByClip(const Projection& projection, const Vector3d& p_C, int width, int height) {
  const Eigen::Vector4d clip =
      projection.ClipFromView(width, height) * Eigen::Vector4d(p_C.x(), -p_C.y(), -p_C.z(), 1.0);
  const Vector3d ndc = clip.head<3>() / clip.w();
  return {0.5 * (ndc.x() + 1.0) * width - 0.5, 0.5 * (1.0 - ndc.y()) * height - 0.5, ndc.z()};
}

dspace::Error::Kind KindOf(const std::function<void()>& f, const std::string& word) {
  try {
    f();
  } catch (const dspace::Error& e) {
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
    return e.GetKind();
  }
  ADD_FAILURE() << "accepted; expected an error with '" << word << "'";
  return dspace::Error::Kind::Internal;
}

constexpr auto Invalid = dspace::Error::Kind::InvalidArgument;

#define EXPECT_REFUSED(statement, word) EXPECT_EQ(KindOf([&] { statement; }, word), Invalid)

} // namespace

TEST(Projection, PerspectiveByHand) {
  // 90° over 200 rows: a tangent of 1 is 100 pixels, from the centre of the image at (199.5, 99.5).
  const Projection p = Perspective(0.1, Infinity);
  const auto centre = p.Project({0, 0, 5}, 400, 200);
  EXPECT_DOUBLE_EQ(centre.x, 199.5);
  EXPECT_DOUBLE_EQ(centre.y, 99.5);
  EXPECT_DOUBLE_EQ(centre.depth, 5.0);
  const auto q = p.Project({4, -1, 2}, 400, 200); // tangents 2 right, 0.5 up
  EXPECT_NEAR(q.x, 199.5 + 200.0, 1e-9);
  EXPECT_NEAR(q.y, 99.5 - 50.0, 1e-9);
  EXPECT_TRUE(q.visible);
  const auto behind = p.Project({0, 0, -1}, 400, 200);
  EXPECT_FALSE(behind.visible);
  EXPECT_TRUE(std::isnan(behind.x) && std::isnan(behind.y));
  EXPECT_FALSE(p.Project({0, 0, 0}, 400, 200).visible);
  EXPECT_NEAR(p.MetresPerPixel(50.0, 200), 0.5, 1e-12); // 100 m over 200 rows
}

TEST(Projection, OrthographicByHand) {
  // 4 m over 200 rows: 50 pixels a metre, whatever the depth.
  const Projection p = Orthographic();
  for (const double z : {-0.5, 0.0, 8.0}) {
    const auto q = p.Project({1.0, 0.5, z}, 400, 200);
    EXPECT_NEAR(q.x, 199.5 + 50.0, 1e-9);
    EXPECT_NEAR(q.y, 99.5 + 25.0, 1e-9);
    EXPECT_EQ(q.depth, z);
    EXPECT_TRUE(q.visible);
  }
  EXPECT_NEAR(p.MetresPerPixel(7.0, 200), 0.02, 1e-15);
}

TEST(Projection, OffAxisByHand) {
  // Tangents -0.1..0.7 over 800 columns, -0.6..-0.2 over 400 rows: 1000 pixels a unit.
  const Projection p = OffAxis();
  const auto ahead = p.Project({0, 0, 3}, 800, 400);
  EXPECT_NEAR(ahead.x, 100.0 - 0.5, 1e-9);
  EXPECT_NEAR(ahead.y, 600.0 - 0.5, 1e-9);              // below the image
  const auto q = p.Project({0.5, -1.0, 2.0}, 800, 400); // tangents 0.25, -0.5
  EXPECT_NEAR(q.x, 350.0 - 0.5, 1e-9);
  EXPECT_NEAR(q.y, 100.0 - 0.5, 1e-9);
  EXPECT_NEAR(p.MetresPerPixel(10.0, 400), 0.01, 1e-15);
}

TEST(Projection, MatrixAgreesWithProject) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (const Projection& p :
       {Perspective(0.2, Infinity), Perspective(0.2, 300.0), Orthographic(), OffAxis()}) {
    for (int i = 0; i < 500; ++i) {
      const double depth = 0.6 + 8.0 * share(random);
      const Projection::Ray ray =
          p.PixelRay(640.0 * share(random), 360.0 * share(random), 640, 360);
      const Vector3d p_C = ray.origin + ray.direction * (depth / ray.direction.z());
      const auto direct = p.Project(p_C, 640, 360);
      const Vector3d clip = ByClip(p, p_C, 640, 360);
      EXPECT_NEAR(direct.x, clip.x(), 1e-9);
      EXPECT_NEAR(direct.y, clip.y(), 1e-9);
      EXPECT_NEAR(p.DepthFromBuffer(clip.z()), depth, 1e-10);
    }
  }
}

TEST(Projection, DepthIsReversed) {
  for (const Projection& p : {Perspective(0.25, Infinity), Perspective(0.25, 1e3), OffAxis()}) {
    EXPECT_NEAR(ByClip(p, {0, 0, p.Near()}, 64, 64).z(), 1.0, 1e-14);
    EXPECT_DOUBLE_EQ(p.DepthFromBuffer(1.0), p.Near());
    EXPECT_EQ(p.DepthFromBuffer(0.0), Infinity);
  }
  EXPECT_NEAR(ByClip(Perspective(0.25, 1e3), {0, 0, 1e3}, 64, 64).z(), 0.0, 1e-15);
  EXPECT_NEAR(Perspective(0.25, 1e3).DepthFromBuffer(1e-9), 1e3, 1e-2);
  // With the far plane at infinity the buffer holds near / depth.
  EXPECT_NEAR(ByClip(Perspective(0.25, Infinity), {0, 0, 1e6}, 64, 64).z(), 0.25e-6, 1e-18);
  EXPECT_NEAR(Perspective(0.25, Infinity).DepthFromBuffer(0.25e-6), 1e6, 1e-6);
  const Projection flat = Orthographic(); // -1 m to 9 m
  EXPECT_NEAR(ByClip(flat, {0, 0, -1}, 64, 64).z(), 1.0, 1e-15);
  EXPECT_NEAR(ByClip(flat, {0, 0, 9}, 64, 64).z(), 0.0, 1e-15);
  EXPECT_NEAR(flat.DepthFromBuffer(0.3), 6.0, 1e-14);
  EXPECT_EQ(flat.DepthFromBuffer(0.0), Infinity);
}

TEST(Projection, PixelRayMeetsItsPixel) {
  for (const Projection& p : {Perspective(0.1, Infinity), Orthographic(), OffAxis()}) {
    for (const double x : {-0.5, 0.0, 17.25, 319.5}) {
      for (const double y : {-0.5, 100.0, 239.5}) {
        const Projection::Ray ray = p.PixelRay(x, y, 320, 240);
        EXPECT_NEAR(ray.direction.norm(), 1.0, 1e-15);
        const auto q = p.Project(ray.origin + 12.0 * ray.direction, 320, 240);
        EXPECT_NEAR(q.x, x, 1e-10);
        EXPECT_NEAR(q.y, y, 1e-10);
      }
    }
  }
  const Projection::Ray corner = Orthographic().PixelRay(-0.5, -0.5, 400, 200);
  EXPECT_LT((corner.origin - Vector3d(-4, -2, 0)).norm(), 1e-14);
  EXPECT_EQ(corner.direction, Vector3d(Vector3d::UnitZ()));
}

TEST(Projection, RejectsWhatCannotBeProjected) {
  const auto rejected = [](Projection p, const std::string& word) {
    EXPECT_REFUSED(p.Check("left eye"), word);
    EXPECT_REFUSED(p.Check("left eye"), "left eye");
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Projection p;
  EXPECT_NO_THROW(p.Check("left eye"));
  for (const double fov : {0.0, -1.0, 180.0, 1e-300, nan}) {
    p.verticalFov_deg = fov;
    rejected(p, "fov");
  }
  // Finite, and beyond what a float of the GPU holds.
  rejected(Perspective(1e300, Infinity), "near distance is 1e+300; accepted: 1e-9 to 1e18 metres");
  rejected(Perspective(1e-300, 1.0), "near");
  rejected(Perspective(1.0, 1e300), "far distance is 1e+300; accepted: up to 1e18 metres");
  EXPECT_NO_THROW(Perspective(1e-9, 1e18).Check("left eye"));
  EXPECT_TRUE(Perspective(1e-9, 1e18).ClipFromView(4, 3).cast<float>().allFinite());
  rejected(Perspective(0.0, 1.0), "near");
  rejected(Perspective(nan, 1.0), "near");
  rejected(Perspective(2.0, 2.0), "far");
  rejected(Perspective(2.0, 1.0), "far");
  rejected(Perspective(2.0, nan), "far");
  p = Orthographic();
  EXPECT_NO_THROW(p.Check("left eye"));
  p.farDistance = Infinity;
  rejected(p, "far");
  p = Orthographic();
  for (const double height : {0.0, -2.0, 1e300, 1e-300, Infinity, nan}) {
    p.height = height;
    rejected(p, "height");
  }
  p = Orthographic();
  p.nearDistance = -1e300;
  rejected(p, "near");
  p.nearDistance = p.Far() - 1e-10;
  rejected(p, "far");
  p = OffAxis();
  EXPECT_NO_THROW(p.Check("left eye"));
  p.right = p.left;
  rejected(p, "left");
  p = OffAxis();
  p.top = p.bottom + 1.0;
  rejected(p, "top");
  p.top = nan;
  rejected(p, "top");
  p = OffAxis();
  p.right = 1e300;
  rejected(p, "right is 1e+300; accepted: -1e6 to 1e6");
  EXPECT_REFUSED(OffAxis().ClipFromView(0, 10), "0 x 10");
  EXPECT_REFUSED(OffAxis().Project({0, 0, 1}, 10, -1), "10 x -1");
  EXPECT_REFUSED(Orthographic().MetresPerPixel(1.0, 0), "0");
}

TEST(Projection, NearAndFarThatAreAbsentFollowWhatIsSeen) {
  Projection perspective;
  EXPECT_EQ(perspective.Near(), 0.05);
  EXPECT_TRUE(std::isinf(perspective.Far()));
  const auto near = [&](double nearest, double farthest) {
    return *perspective.Seeing(nearest, farthest).nearDistance;
  };
  EXPECT_EQ(near(3.0, 9.0), 0.05);
  EXPECT_DOUBLE_EQ(near(1e-3, 9.0), 0.9e-3);
  EXPECT_EQ(near(1e-12, 9.0), 1e-9);
  EXPECT_EQ(near(-1.0, 9.0), 0.05);
  EXPECT_EQ(near(1.0, 0.0), 0.05); // nothing
  EXPECT_TRUE(std::isinf(*perspective.Seeing(1.0, 2.0).farDistance));
  EXPECT_NO_THROW(perspective.Seeing(1e-12, 1e18).Check("eye"));

  Projection flat;
  flat.kind = Projection::Kind::Orthographic;
  const std::vector<std::pair<double, double>> depths = {
      {2e5 - 1, 2e5 + 1}, {5.0, 5.0}, {-3.0, 7.0}, {0.0, 1e17}, {1.0, 0.0}};
  for (const auto& [nearest, farthest] : depths) {
    const Projection seeing = flat.Seeing(nearest, farthest);
    EXPECT_NO_THROW(seeing.Check("eye")) << nearest;
    EXPECT_GE(seeing.Near(), 0.0);
    if (nearest <= farthest) {
      EXPECT_LE(seeing.Near(), std::max(nearest, 0.0));
      EXPECT_GT(seeing.Far(), farthest);
      // No more than a hundredth of the depth buffer's range is spare.
      EXPECT_LT(seeing.Far() - seeing.Near(), 1.01 * (farthest - nearest) + 1e-5 * farthest + 1e-5);
    }
  }
  // A distance that is set stays.
  flat.nearDistance = -10.0;
  EXPECT_EQ(flat.Seeing(1.0, 2.0).Near(), -10.0);
  flat.farDistance = -5.0;
  EXPECT_EQ(flat.Seeing(1.0, 2.0).Far(), -5.0);
  flat.nearDistance.reset();
  flat.farDistance = 5.0;
  EXPECT_LT(flat.Seeing(100.0, 200.0).Near(), 5.0);
  EXPECT_EQ(flat.Seeing(100.0, 200.0).Far(), 5.0);
}

TEST(LookAt, AxesByHand) {
  const Pose X = dspace::LookAt("c", {1, 2, 3}, {1, 7, 3}, {0, 0, 2});
  EXPECT_EQ(X.position, Vector3d(1, 2, 3));
  EXPECT_EQ(X.scale, 1.0);
  const Eigen::Matrix3d R = X.rotation.toRotationMatrix();
  EXPECT_LT((R.col(0) - Vector3d(1, 0, 0)).norm(), 1e-15);  // right
  EXPECT_LT((R.col(1) - Vector3d(0, 0, -1)).norm(), 1e-15); // down
  EXPECT_LT((R.col(2) - Vector3d(0, 1, 0)).norm(), 1e-15);  // forward
  // Straight down, north up: east is right.
  const Eigen::Matrix3d D =
      dspace::LookAt("c", {0, 0, 9}, {0, 0, 0}, {0, 1, 0}).rotation.toRotationMatrix();
  EXPECT_LT((D.col(0) - Vector3d(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((D.col(1) - Vector3d(0, -1, 0)).norm(), 1e-15);
  EXPECT_LT((D.col(2) - Vector3d(0, 0, -1)).norm(), 1e-15);
}

TEST(LookAt, RejectsWhatHasNoDirection) {
  const Vector3d up = Vector3d::UnitZ();
  EXPECT_REFUSED(dspace::LookAt("mast", {1, 2, 3}, {1, 2, 3}, up), "mast");
  EXPECT_REFUSED(dspace::LookAt("mast", {0, 0, 0}, {0, 0, -3}, up), "line of sight");
  EXPECT_REFUSED(dspace::LookAt("mast", {0, 0, 0}, {1, 0, 0}, {0, 0, 0}), "up");
  EXPECT_REFUSED(dspace::LookAt("mast", {0, Infinity, 0}, {1, 0, 0}, up), "eye");
  EXPECT_REFUSED(dspace::LookAt("mast", {0, 0, 0}, {std::nan(""), 0, 0}, up), "target");
}

namespace {

// A frame at (10, 20, 0) in its parent, turned by `yaw` about Z and then pitched up by `pitch`.
struct ChaseScene {
  FrameTree tree;
  FrameId parent = 0;
  FrameId frame = 0;
  Camera camera;

  ChaseScene() {
    Pose far;
    far.position = {1e9, 0, 0};
    far.scale = 2.0;
    this->parent = this->tree.Create(dspace::RootFrame, "site", far);
    this->frame = this->tree.Create(this->parent, "rover");
    this->camera.name = "chase";
    this->camera.mount.kind = CameraMount::Kind::Chase;
    this->camera.mount.frame = this->frame;
    this->camera.mount.offset = {-5, 0, 2};
    this->camera.mount.target = {0, 0, 2};
    this->Turn(0, 0);
  }
  void Turn(double yaw_deg, double pitch_deg) {
    Pose X;
    X.position = {10, 20, 0};
    X.rotation = Eigen::AngleAxisd(yaw_deg * Degree, Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(-pitch_deg * Degree, Vector3d::UnitY());
    this->tree.SetLocalPose(this->frame, X);
  }
  CameraPose Place(CameraMount::ChaseAxes axes) {
    this->camera.mount.axes = axes;
    ChaseState state;
    return dspace::PlaceCamera(this->camera, this->tree, 0.0, state);
  }
};

Vector3d Forward(const CameraPose& pose) {
  return pose.X_FC.rotation * Vector3d::UnitZ();
}

} // namespace

TEST(Chase, AxesByHand) {
  ChaseScene s;
  s.Turn(90, 30); // X_F is (0, cos 30°, sin 30°), Z_F is (0, -sin 30°, cos 30°)
  const CameraPose parent = s.Place(CameraMount::ChaseAxes::Parent);
  EXPECT_EQ(parent.frame, s.parent);
  EXPECT_EQ(parent.X_FC.scale, 1.0);
  EXPECT_LT((parent.X_FC.position - Vector3d(5, 20, 2)).norm(), 1e-14);
  EXPECT_LT((Forward(parent) - Vector3d(1, 0, 0)).norm(), 1e-15);

  const CameraPose heading = s.Place(CameraMount::ChaseAxes::Heading);
  EXPECT_LT((heading.X_FC.position - Vector3d(10, 15, 2)).norm(), 1e-14);
  EXPECT_LT((Forward(heading) - Vector3d(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((heading.X_FC.rotation * Vector3d::UnitY() - Vector3d(0, 0, -1)).norm(), 1e-15);

  const double c = std::cos(30 * Degree);
  const CameraPose followed = s.Place(CameraMount::ChaseAxes::Followed);
  const Vector3d expected =
      Vector3d(10, 20, 0) - 5 * Vector3d(0, c, 0.5) + 2 * Vector3d(0, -0.5, c);
  EXPECT_LT((followed.X_FC.position - expected).norm(), 1e-14);
  EXPECT_LT((Forward(followed) - Vector3d(0, c, 0.5)).norm(), 1e-15);
}

TEST(Chase, HeadingOutlivesAnUprightNose) {
  ChaseScene s;
  s.Turn(37, 90 - 1e-7);
  const Vector3d before = s.Place(CameraMount::ChaseAxes::Heading).X_FC.position;
  s.Turn(37, 90);
  const Vector3d at = s.Place(CameraMount::ChaseAxes::Heading).X_FC.position;
  EXPECT_LT((at - before).norm(), 1e-5);
  s.Turn(37, -90);
  EXPECT_LT((s.Place(CameraMount::ChaseAxes::Heading).X_FC.position - at).norm(), 1e-5);
}

TEST(Chase, SightAlongUpFallsBackOnTheFollowedFrame) {
  ChaseScene s;
  s.camera.mount.offset = {0, 0, 7};
  s.camera.mount.target = {0, 0, 0};
  s.Turn(90, 0);
  const CameraPose pose = s.Place(CameraMount::ChaseAxes::Followed);
  EXPECT_LT((Forward(pose) - Vector3d(0, 0, -1)).norm(), 1e-15);
  // The rover's X, (0, 1, 0), is up in the image.
  EXPECT_LT((pose.X_FC.rotation * Vector3d::UnitY() - Vector3d(0, -1, 0)).norm(), 1e-15);
}

// On the equator of a body at longitude 90: up is Y of the body, east is -X, north is Z.
TEST(Chase, TheLocalVerticalIsUpright) {
  ChaseScene s;
  Pose X;
  X.position = {0, 1000, 0};
  Eigen::Matrix3d R; // X north, Y west, Z up
  R.col(0) = Vector3d(0, 0, 1);
  R.col(1) = Vector3d(1, 0, 0);
  R.col(2) = Vector3d(0, 1, 0);
  // Nose up by 20 degrees: the heading stays north.
  X.rotation = Eigen::Quaterniond(R) * Eigen::AngleAxisd(-20 * Degree, Vector3d::UnitY());
  s.tree.SetLocalPose(s.frame, X);
  s.camera.mount.aim = s.parent;
  s.camera.mount.vertical = CameraMount::Vertical::Away;
  const CameraPose heading = s.Place(CameraMount::ChaseAxes::Heading);
  EXPECT_EQ(heading.frame, s.parent);
  EXPECT_LT((heading.X_FC.position - Vector3d(0, 1002, -5)).norm(), 1e-12);
  EXPECT_LT((Forward(heading) - Vector3d(0, 0, 1)).norm(), 1e-14);
  EXPECT_LT((heading.X_FC.rotation * -Vector3d::UnitY() - Vector3d(0, 1, 0)).norm(), 1e-14);
  // The parent's axes stay; only the picture is upright.
  s.camera.mount.offset = {7, 3, 0};
  s.camera.mount.target = {0, 0, 0};
  const CameraPose parent = s.Place(CameraMount::ChaseAxes::Parent);
  EXPECT_LT((parent.X_FC.position - Vector3d(7, 1003, 0)).norm(), 1e-12);
  const Vector3d up = parent.X_FC.rotation * -Vector3d::UnitY();
  EXPECT_NEAR(up.z(), 0.0, 1e-14);
  EXPECT_GT(up.y(), 0.9);
  // The Z axis of a plane that leans by 30 degrees.
  Pose leaning;
  leaning.rotation = Eigen::AngleAxisd(30 * Degree, Vector3d::UnitX());
  s.camera.mount.aim = s.tree.Create(s.parent, "slope", leaning);
  s.camera.mount.vertical = CameraMount::Vertical::Axis;
  const CameraPose slope = s.Place(CameraMount::ChaseAxes::Parent);
  const Vector3d normal(0, -0.5, std::cos(30 * Degree));
  const Vector3d across = Forward(slope).cross(normal).normalized();
  EXPECT_LT((slope.X_FC.rotation * Vector3d::UnitX() - across).norm(), 1e-14);
  // Where there is no direction away from the centre, the parent's Z is up.
  X.position = Vector3d::Zero();
  s.tree.SetLocalPose(s.frame, X);
  s.camera.mount.aim = s.parent;
  s.camera.mount.vertical = CameraMount::Vertical::Away;
  EXPECT_LT((s.Place(CameraMount::ChaseAxes::Heading).X_FC.position.z()), 1e-12);
  s.camera.mount.aim = 999;
  EXPECT_THROW(s.Place(CameraMount::ChaseAxes::Heading), dspace::Error);
}

TEST(LookAt, LookingAlongZHasYAtTheTop) {
  EXPECT_EQ(dspace::UpFor({0, 0, -3}), Vector3d(0, 1, 0));
  EXPECT_EQ(dspace::UpFor({0, 0, 3}), Vector3d(0, 1, 0));
  EXPECT_EQ(dspace::UpFor({1e-3, 0, -3}), Vector3d(0, 0, 1));
}

TEST(Chase, LagIsTheExactExponentialOfSimulationTime) {
  ChaseScene s;
  s.camera.mount.axes = CameraMount::ChaseAxes::Parent;
  s.camera.mount.smoothing_s = 2.0;
  ChaseState state;
  dspace::PlaceCamera(s.camera, s.tree, 100.0, state); // starts in place
  EXPECT_LT((state.p_PC - Vector3d(5, 20, 2)).norm(), 1e-14);

  Pose X = s.tree.LocalPose(s.frame);
  X.position.x() += 8.0;
  s.tree.SetLocalPose(s.frame, X);
  ChaseState many = state;
  const CameraPose once = dspace::PlaceCamera(s.camera, s.tree, 103.0, state);
  EXPECT_NEAR(once.X_FC.position.x(), 13.0 - 8.0 * std::exp(-1.5), 1e-13);
  for (int i = 1; i <= 300; ++i) {
    dspace::PlaceCamera(s.camera, s.tree, 100.0 + 0.01 * i, many);
  }
  EXPECT_LT((many.p_PC - state.p_PC).norm(), 1e-12);

  // The same time again moves nothing, however often.
  const Vector3d there = state.p_PC;
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(dspace::PlaceCamera(s.camera, s.tree, 103.0, state).X_FC.position, there);
  }
  // It looks at the target from where it is.
  EXPECT_LT((Forward(once) - (Vector3d(18, 20, 2) - there).normalized()).norm(), 1e-15);

  // A step back starts again.
  EXPECT_LT((dspace::PlaceCamera(s.camera, s.tree, 50.0, state).X_FC.position - Vector3d(13, 20, 2))
                .norm(),
            1e-14);
}

TEST(Chase, LagStartsAnewInAnotherParent) {
  ChaseScene s;
  s.camera.mount.axes = CameraMount::ChaseAxes::Parent;
  s.camera.mount.smoothing_s = 1e9;
  ChaseState state;
  dspace::PlaceCamera(s.camera, s.tree, 0.0, state);
  s.tree.Reparent(s.frame, dspace::RootFrame, false);
  Pose X;
  X.position = {-3, 0, 0};
  s.tree.SetLocalPose(s.frame, X);
  const CameraPose pose = dspace::PlaceCamera(s.camera, s.tree, 1.0, state);
  EXPECT_EQ(pose.frame, dspace::RootFrame);
  EXPECT_LT((pose.X_FC.position - Vector3d(-8, 0, 2)).norm(), 1e-14);
}

TEST(Chase, LagOntoTheTargetKeepsALineOfSight) {
  ChaseScene s;
  s.camera.mount.axes = CameraMount::ChaseAxes::Parent;
  s.camera.mount.smoothing_s = 1.0;
  ChaseState state;
  dspace::PlaceCamera(s.camera, s.tree, 0.0, state);
  Pose X = s.tree.LocalPose(s.frame); // the target comes to where the camera is
  X.position.x() -= 5.0;
  s.tree.SetLocalPose(s.frame, X);
  const CameraPose pose = dspace::PlaceCamera(s.camera, s.tree, 0.0, state);
  EXPECT_LT((pose.X_FC.position - Vector3d(5, 20, 2)).norm(), 1e-14);
  EXPECT_LT((Forward(pose) - Vector3d(1, 0, 0)).norm(), 1e-15);
}

TEST(Mount, FixedIsAsItWasGiven) {
  ChaseScene s;
  s.camera.mount = CameraMount();
  s.camera.mount.frame = s.frame;
  s.camera.mount.X_FC = dspace::LookAt("c", {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  ChaseState state;
  const CameraPose pose = dspace::PlaceCamera(s.camera, s.tree, 3.0, state);
  EXPECT_EQ(pose.frame, s.frame);
  EXPECT_EQ(pose.X_FC, s.camera.mount.X_FC);
  s.camera.mount.frame = 4711;
  EXPECT_EQ(KindOf([&] { dspace::PlaceCamera(s.camera, s.tree, 3.0, state); }, "4711"),
            dspace::Error::Kind::NotFound);
}

TEST(Mount, Rejections) {
  CameraMount mount;
  EXPECT_NO_THROW(mount.Check("c"));
  mount.X_FC.scale = 2.0;
  EXPECT_REFUSED(mount.Check("c"), "scale");
  mount.X_FC.scale = 1.0;
  mount.X_FC.rotation.w() = 1.1;
  EXPECT_REFUSED(mount.Check("c"), "camera 'c'");
  mount = CameraMount();
  mount.kind = CameraMount::Kind::Chase;
  EXPECT_NO_THROW(mount.Check("c"));
  mount.smoothing_s = -1.0;
  EXPECT_REFUSED(mount.Check("c"), "smoothing");
  mount.smoothing_s = std::nan("");
  EXPECT_REFUSED(mount.Check("c"), "smoothing");
  mount.smoothing_s = 1.0;
  mount.target.x() = 1e300;
  EXPECT_REFUSED(mount.Check("c"), "target is (1e+300, 0, 0); accepted: within 1e18 metres");
  EXPECT_REFUSED(dspace::LookAt("c", {0, 1e300, 0}, {0, 0, 0}, {0, 0, 1}), "eye");
  mount.target = mount.offset;
  EXPECT_REFUSED(mount.Check("c"), "target");
  mount.target = mount.offset + Vector3d(0, 0, 3);
  EXPECT_REFUSED(mount.Check("c"), "line of sight");
  mount.axes = CameraMount::ChaseAxes::Followed; // only sometimes along up
  EXPECT_NO_THROW(mount.Check("c"));
  mount.up.setZero();
  EXPECT_REFUSED(mount.Check("c"), "up");
  ChaseScene s;
  s.camera.mount.frame = dspace::RootFrame;
  ChaseState state;
  EXPECT_REFUSED(dspace::PlaceCamera(s.camera, s.tree, 0.0, state), "root");
}
