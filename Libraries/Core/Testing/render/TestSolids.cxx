// Leaving out the back faces of solids must not be seen: pictures and labels with and without.
#include "RenderingTestSupport.h"

using namespace dspace;

namespace {

struct SolidsTest : RenderingFixture {

  // What a camera at the root, looking along X, sees of `mesh` placed by X_FO on a frame at
  // `place`.
  Capture Picture(Mesh mesh, bool solid, const Pose& place, const Eigen::Affine3d& X_FO,
                  const Projection& projection) {
    scene = std::make_shared<Scene>("solids");
    Look(projection);
    const FrameId frame = scene->Frames().Create(RootFrame, "part", place);
    mesh.solid = solid;
    auto material = std::make_shared<Material>();
    material->color = {0.8, 0.5, 0.2};
    GraphicsObject object = Object("part", frame, std::move(mesh), material);
    object.X_FO = X_FO;
    scene->AddObject(object);
    Light sun;
    sun.name = "sun";
    sun.direction = {1, 0.6, -0.4};
    scene->SetLight(sun);
    return View(160, 120)->GetCapture({true, true, true, false, {}});
  }

  void ExpectSame(const Mesh& mesh, const Pose& place, const Eigen::Affine3d& X_FO,
                  const Projection& projection) {
    const Capture solid = Picture(mesh, true, place, X_FO, projection);
    const Capture both = Picture(mesh, false, place, X_FO, projection);
    ASSERT_TRUE(std::any_of(both.label.begin(), both.label.end(), [](auto l) { return l != 0; }))
        << "the part must be in sight";
    EXPECT_EQ(solid.label, both.label);
    EXPECT_EQ(solid.color, both.color);
    EXPECT_EQ(solid.depth, both.depth);
  }
};

Pose Turned(double x) {
  Pose pose = At(x, 0.2, -0.1);
  pose.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  return pose;
}

} // namespace

TEST_F(SolidsTest, FromOutsideNothingIsMissing) {
  const Eigen::Affine3d none = Eigen::Affine3d::Identity();
  for (const Mesh& mesh : {MakeBox({1, 2, 0.5}), MakeSphere(0.8, 16), MakeCylinder(0.4, 2, 12),
                           MakeCone(0.7, 1.5, 9)}) {
    ASSERT_TRUE(mesh.solid);
    SCOPED_TRACE(mesh.name);
    ExpectSame(mesh, Turned(4), none, {});
    Projection orthographic;
    orthographic.kind = Projection::Kind::Orthographic;
    orthographic.height = 4.0;
    orthographic.farDistance = 100.0;
    ExpectSame(mesh, Turned(4), none, orthographic);
  }
}

TEST_F(SolidsTest, MirroredPartsShowTheirOutside) {
  ExpectSame(MakeBox({1, 2, 0.5}), Turned(4), Eigen::Affine3d(Eigen::Scaling(1.0, -1.0, 1.0)), {});
}

TEST_F(SolidsTest, FromInsideAndCutByTheNearPlaneTheInsideIsSeen) {
  const Eigen::Affine3d none = Eigen::Affine3d::Identity();
  ExpectSame(MakeBox({6, 6, 6}), Turned(0.5), none, {}); // the camera is inside
  Projection cutting;
  cutting.nearDistance = 4.0; // through the box's middle
  ExpectSame(MakeBox({2, 2, 2}), Turned(4), none, cutting);
}
