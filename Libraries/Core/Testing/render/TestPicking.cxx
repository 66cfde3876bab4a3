// Picking and the label plane: what is picked is what is seen, at its place.
#include "RenderingTestSupport.h"

using namespace dspace;

namespace {

struct PickingTest : RenderingFixture {};

} // namespace

TEST_F(PickingTest, PicksWhatARayHits) {
  Look({});
  const FrameId far = scene->Frames().Create(RootFrame, "far", At(20, 1, 1));
  const FrameId ball = scene->Frames().Create(far, "ball", At(0, -1, -1));
  const ObjectId id =
      scene->AddObject(Object("ball", ball, MakeSphere(2.0, 512), Unlit({1, 1, 1})));
  auto viewport = View(300, 200);
  const Projection projection = scene->Vantage("main").ActiveCamera().projection;
  int hits = 0;
  for (int y = 40; y < 160; y += 7) {
    for (int x = 90; x < 210; x += 7) {
      const PickResult pick = viewport->Pick(x, y);
      const auto ray = projection.PixelRay(x, y, 300, 200);
      const Eigen::Vector3d d(ray.direction.z(), -ray.direction.x(), -ray.direction.y());
      const Eigen::Vector3d c(20, 0, 0);
      const double b = d.dot(c);
      const double discriminant = b * b - c.squaredNorm() + 4.0;
      if (std::abs(discriminant) < 0.05) {
        continue; // at the limb the facets differ from the sphere
      }
      ASSERT_EQ(pick.object, discriminant > 0 ? id : 0u) << x << " " << y;
      if (pick.object) {
        ++hits;
        const Eigen::Vector3d p = (b - std::sqrt(discriminant)) * d;
        EXPECT_LT((pick.p_root - p).norm(), 2e-3);
        EXPECT_LT((pick.p_frame - (p - c)).norm(), 2e-3);
        EXPECT_EQ(pick.frame, ball);
      }
    }
  }
  EXPECT_GT(hits, 30);
  EXPECT_EQ(viewport->Pick(5, 5).object, 0u);
  EXPECT_THROW(viewport->Pick(300, 5), Error);
}

namespace {

// 10 pixels a metre about (79.5, 49.5), Y to the left, Z up, as seen from the root's origin along
// X.
Projection TenPixelsAMetre() {
  Projection projection;
  projection.kind = Projection::Kind::Orthographic;
  projection.height = 10.0;
  projection.nearDistance = 1.0;
  projection.farDistance = 100.0;
  return projection;
}

} // namespace

TEST_F(PickingTest, TheRadiusReachesTheNearestObjectAndNoFarther) {
  Look(TenPixelsAMetre());
  const FrameId near = scene->Frames().Create(RootFrame, "near", At(8, 2, 1));
  const FrameId far = scene->Frames().Create(RootFrame, "far", At(20, -2, 1));
  const ObjectId left = scene->AddObject(
      Object("left", near, PlaneTowardsCamera(2, 2), Unlit({1, 1, 1}))); // x 50..69, y 30..49
  const ObjectId right = scene->AddObject(
      Object("right", far, PlaneTowardsCamera(2, 2), Unlit({1, 1, 1}))); // x 90..109, y 30..49
  auto viewport = View(160, 100);
  EXPECT_EQ(viewport->Pick(72, 40).object, 0u);
  EXPECT_EQ(viewport->Pick(72, 40, 2).object, 0u); // three pixels from column 69
  const PickResult pick = viewport->Pick(72, 40, 3);
  EXPECT_EQ(pick.object, left);
  // The place is the one of the pixel that was found: (69, 40).
  EXPECT_LT((pick.p_root - Eigen::Vector3d(8, (79.5 - 69) / 10, (49.5 - 40) / 10)).norm(), 1e-4);
  EXPECT_LT((pick.p_frame - (pick.p_root - Eigen::Vector3d(8, 2, 1))).norm(), 1e-9);
  EXPECT_NEAR(pick.depth, 8, 1e-4);
  EXPECT_EQ(viewport->Pick(79, 40, 30).object, left);  // 10 pixels to the left, 11 to the right
  EXPECT_EQ(viewport->Pick(80, 40, 30).object, right); // and the other way round
  EXPECT_EQ(viewport->Pick(0, 0, 256).object, left);   // the circle reaches out of the picture
  EXPECT_EQ(viewport->Pick(72, 52, 4).object, 0u);     // a corner is farther than either side
  EXPECT_EQ(viewport->Pick(72, 52, 5).object, left);
  EXPECT_EQ(viewport->Pick(60, 40, 8).object, left); // where something lies, it is that
  EXPECT_LT((viewport->Pick(60, 40, 8).p_root - Eigen::Vector3d(8, 1.95, 0.95)).norm(), 1e-4);
}

TEST_F(PickingTest, FollowsTheCameraTheSizeAndTheScene) {
  Look(TenPixelsAMetre());
  const FrameId frame = scene->Frames().Create(RootFrame, "f", At(8, 2, 1));
  const ObjectId id =
      scene->AddObject(Object("square", frame, PlaneTowardsCamera(2, 2), Unlit({1, 1, 1})));
  Camera aside = scene->Vantage("main").GetCamera("camera");
  aside.name = "aside"; // two metres to the right: the square shows 20 pixels farther left
  aside.mount.X_FC.position = {0, -2, 0};
  scene->SetCamera("main", aside);
  scene->CreateVantage("other");
  aside.name = "other's";
  scene->SetCamera("other", aside);
  auto viewport = View(160, 100);
  viewport->SetCamera("camera");
  EXPECT_EQ(viewport->Pick(60, 40).object, id);
  viewport->SetCamera("aside");
  EXPECT_EQ(viewport->Pick(60, 40).object, 0u);
  EXPECT_EQ(viewport->Pick(40, 40).object, id);
  viewport->SetCamera("camera");
  EXPECT_EQ(viewport->Pick(60, 40).object, id);
  viewport->SetVantage("other");
  EXPECT_EQ(viewport->Pick(60, 40).object, 0u);
  EXPECT_EQ(viewport->Pick(40, 40).object, id);
  viewport->Resize(160, 50); // half as many pixels a metre: x 69.5 - 10 .. 69.5 + 10 - 20
  EXPECT_EQ(viewport->Pick(60, 20).object, id);
  EXPECT_EQ(viewport->Pick(40, 20).object, 0u);
  scene->Frames().SetLocalPose(frame, At(8, -2, 1));
  EXPECT_EQ(viewport->Pick(60, 20).object, 0u);
  EXPECT_EQ(viewport->Pick(80, 20).object, id);
}

TEST_F(PickingTest, LeavesOutWhatIsHiddenOrNotToBePicked) {
  Look(TenPixelsAMetre());
  const FrameId frame = scene->Frames().Create(RootFrame, "f", At(8, 0, 0));
  const FrameId front = scene->Frames().Create(RootFrame, "front", At(5, 0, 0));
  const ObjectId back =
      scene->AddObject(Object("back", frame, PlaneTowardsCamera(2, 2), Unlit({1, 1, 1})));
  GraphicsObject marker = Object("marker", front, PlaneTowardsCamera(2, 2), Unlit({1, 1, 0}, 0.5));
  marker.nature = Nature::Ornamental;
  const ObjectId markerId = scene->AddObject(marker);
  auto viewport = View(160, 100);
  const auto labelAt = [&](const CaptureRequest& request) {
    return viewport->GetCapture(request).label[50 * 160 + 80];
  };
  EXPECT_EQ(viewport->Pick(80, 50).object, markerId);
  EXPECT_EQ(labelAt({false, false, true, false, {}}), markerId);
  EXPECT_EQ(labelAt({false, false, true, true, {}}), back); // physical only
  CaptureRequest without{false, false, true, false, {"ornamental"}};
  EXPECT_EQ(labelAt(without), back);
  EXPECT_EQ(viewport->Pick(80, 50).object, markerId); // the requests were for one picture each
  viewport->SetOrnamentsVisible(false);
  EXPECT_EQ(viewport->Pick(80, 50).object, back);
  viewport->SetOrnamentsVisible(true);
  viewport->SetFragmentVisible("physical", false);
  EXPECT_EQ(viewport->Pick(80, 50).object, markerId);
  viewport->SetFragmentVisible("ornamental", false);
  EXPECT_EQ(viewport->Pick(80, 50).object, 0u);
  viewport->SetFragmentVisible("physical", true);
  viewport->SetFragmentVisible("ornamental", true);
  auto glass = Object("glass", front, PlaneTowardsCamera(2, 2), Unlit({1, 1, 0}, 0.5));
  glass.pickable = false;
  glass.X_FO = Eigen::Affine3d(Eigen::Translation3d(-1, 0, 0));
  const ObjectId glassId = scene->AddObject(glass);
  EXPECT_EQ(viewport->Pick(80, 50).object, markerId);
  EXPECT_EQ(labelAt({false, false, true, false, {}}), glassId);
}
