// Pictures against closed forms: projection, translucency, light, what is left out, what is
// redrawn.
#include "RenderingTestSupport.h"

#include "vtkOpenGLRenderWindow.h"
#include "vtkTextureObject.h"

using namespace dspace;

namespace {

struct RenderingTest : RenderingFixture {};

std::uint8_t Srgb(double linear) {
  const double v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * v));
}

} // namespace

TEST_F(RenderingTest, DrawsABoxWhereProjectionByHandPutsIt) {
  Projection projection;
  projection.verticalFov_deg = 2.0 * std::atan(0.5) * 180.0 / M_PI; // one metre high at one metre
  Look(projection);
  const FrameId frame = scene->Frames().Create(RootFrame, "box");
  Pose pose;
  pose.position = {10.5, 2.0, 1.0}; // front face at X = 10
  scene->Frames().SetLocalPose(frame, pose);
  scene->AddObject(Object("box", frame, MakeBox({1, 1, 1}), Unlit({1, 0, 0})));
  auto viewport = View(200, 100);
  const Capture capture = viewport->GetCapture({true, true, true, false, {}});
  // Focal length 100 px, centre (99.5, 49.5): Y is left, Z is up. The front face covers
  // Y 1.5..2.5 -> x 99.5 - 25 .. 99.5 - 15, Z 0.5..1.5 -> y 49.5 - 15 .. 49.5 - 5.
  int left = 1000, right = -1, top = 1000, bottom = -1;
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 200; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * 200 + x;
      const bool red = capture.color[4 * i] == 255;
      EXPECT_EQ(red, capture.label[i] == 1);
      EXPECT_EQ(red, std::isfinite(capture.depth[i]));
      if (red && std::abs(capture.depth[i] - 10.0) < 1e-4) {
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
    }
  }
  EXPECT_NEAR(left, 75, 0);
  EXPECT_NEAR(right, 84, 0);
  EXPECT_NEAR(top, 35, 0);
  EXPECT_NEAR(bottom, 44, 0);
}

TEST_F(RenderingTest, OrthographicAndOffAxisCamerasPutSquaresWhereTheHandDoes) {
  const FrameId frame = scene->Frames().Create(RootFrame, "square", At(8, 1.0, -0.5));
  scene->AddObject(Object("square", frame, PlaneTowardsCamera(1, 1), Unlit({1, 1, 1})));
  Projection orthographic;
  orthographic.kind = Projection::Kind::Orthographic;
  orthographic.height = 5.0;
  orthographic.nearDistance = 1.0;
  orthographic.farDistance = 100.0;
  Look(orthographic);
  auto viewport = View(160, 100);
  // 20 px a metre about (79.5, 49.5): Y 0.5..1.5 -> x 49.5..69.5, Z -1..0 -> y 49.5..69.5.
  Capture capture = viewport->GetCapture({false, true, true, false, {}});
  Extent extent = ExtentOf(capture, 1);
  EXPECT_EQ(extent.left, 50);
  EXPECT_EQ(extent.right, 69);
  EXPECT_EQ(extent.top, 50);
  EXPECT_EQ(extent.bottom, 69);
  EXPECT_NEAR(capture.depth[60 * 160 + 60], 8.0, 1e-4);

  Projection offAxis; // covers tangents -0.4..0.1 across and -0.1..0.2 down
  offAxis.kind = Projection::Kind::Frustum;
  offAxis.left = -0.4;
  offAxis.right = 0.1;
  offAxis.top = -0.1;
  offAxis.bottom = 0.2;
  Look(offAxis);
  // x = (tan + 0.4) / 0.5 * 160 - 0.5 with tan = -Y / 8; y = (tan + 0.1) / 0.3 * 100 - 0.5 with
  // tan = -Z / 8: Y 1.5 -> 67.5, Y 0.5 -> 107.5; Z 0 -> 32.83, Z -1 -> 74.5.
  capture = viewport->GetCapture({false, true, true, false, {}});
  extent = ExtentOf(capture, 1);
  EXPECT_EQ(extent.left, 68);
  EXPECT_EQ(extent.right, 107);
  EXPECT_EQ(extent.top, 33);
  EXPECT_EQ(extent.bottom, 74);
}

TEST_F(RenderingTest, IntersectingTranslucentQuadsBlendAsByHand) {
  Look({});
  // A planet behind, two quads that cross along the middle of the picture.
  scene->AddObject(Object("planet", scene->Frames().Create(RootFrame, "planet", At(1e7, 0, 0)),
                          MakeSphere(5e6), Unlit({0.2, 0.4, 0.9})));
  Pose red = At(10, 0, 0);
  red.rotation = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());
  Pose green = At(10, 0, 0);
  green.rotation = Eigen::AngleAxisd(-0.3, Eigen::Vector3d::UnitZ());
  const FrameId a = scene->Frames().Create(RootFrame, "a", red);
  const FrameId b = scene->Frames().Create(RootFrame, "b", green);
  scene->AddObject(Object("red", a, PlaneTowardsCamera(3, 3), Unlit({0.9, 0.1, 0.1}, 0.6)));
  scene->AddObject(Object("green", b, PlaneTowardsCamera(3, 3), Unlit({0.1, 0.8, 0.1}, 0.3)));
  auto viewport = View(101, 101);
  const Capture capture = viewport->GetCapture({});
  EXPECT_EQ(context->GetStatistics().translucentLayers, 2);
  const auto expect = [&](int x, const std::array<double, 3>& front, double alphaFront,
                          const std::array<double, 3>& back, double alphaBack) {
    const std::array<double, 3> planet = {0.2, 0.4, 0.9};
    for (int k = 0; k < 3; ++k) {
      const double behind =
          LinearFromSrgb(back[k]) * alphaBack + (1 - alphaBack) * LinearFromSrgb(planet[k]);
      const double linear = LinearFromSrgb(front[k]) * alphaFront + (1 - alphaFront) * behind;
      EXPECT_NEAR(capture.color[4 * (50 * 101 + x) + k], Srgb(linear), 1) << "x " << x << " " << k;
    }
  };
  // Turned by +0.3 about Z, the red quad's left (+Y) edge lies nearer (X = -Y sin).
  expect(45, {0.9, 0.1, 0.1}, 0.6, {0.1, 0.8, 0.1}, 0.3);
  expect(56, {0.1, 0.8, 0.1}, 0.3, {0.9, 0.1, 0.1}, 0.6);
}

TEST_F(RenderingTest, AnUnchangedViewportIsNotDrawnAgainAndAHiddenOneNotAtAll) {
  Look({});
  auto viewport = View(20, 20);
  EXPECT_TRUE(viewport->Render());
  EXPECT_FALSE(viewport->Render());
  const FrameId frame = scene->Frames().Create(RootFrame, "frame");
  EXPECT_TRUE(viewport->Render());
  scene->Frames().SetLocalPose(frame, At(1, 0, 0));
  viewport->SetVisible(false);
  const auto drawn = context->GetStatistics().framesDrawn;
  EXPECT_FALSE(viewport->Render());
  EXPECT_EQ(context->GetStatistics().framesDrawn, drawn);
  viewport->SetVisible(true);
  EXPECT_TRUE(viewport->Render());
}

TEST_F(RenderingTest, APhysicalPictureKnowsNothingOfOrnaments) {
  const auto build = [&](bool ornaments) {
    auto made = std::make_shared<Scene>("scene");
    made->CreateVantage("main");
    Camera camera;
    camera.name = "camera";
    camera.mount.X_FC = LookAt("", {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
    made->SetCamera("main", camera);
    Light sun;
    sun.name = "sun";
    sun.direction = {1, 1, -1};
    made->SetLight(sun);
    const FrameId frame = made->Frames().Create(RootFrame, "f", At(8, 0, 0));
    if (ornaments) {
      GraphicsObject arrow = Object("arrow", frame, MakeArrow(6), Unlit({1, 1, 0}, 0.5));
      arrow.nature = Nature::Ornamental;
      arrow.X_FO = Eigen::Affine3d(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
      made->AddObject(arrow);
    }
    made->AddObject(Object("ball", frame, MakeSphere(1), std::make_shared<Material>()));
    made->AddObject(Object("glass", frame, MakeBox({3, 3, 3}), Unlit({0, 0.5, 1}, 0.3)));
    auto viewport = vtkSmartPointer<vtkDspaceViewport>::New();
    viewport->Initialize(context, made, "v", "main", 90, 70);
    viewport->SetCornerAxes(true);
    TextTable table;
    table.name = "table";
    table.rows = {{"height", "1 m"}};
    viewport->SetTextTable(table);
    return std::make_pair(viewport, made);
  };
  auto with = build(true);
  auto without = build(false);
  CaptureRequest physical{true, true, true, true, {}};
  const Capture a = with.first->GetCapture(physical);
  const Capture b = without.first->GetCapture(physical);
  EXPECT_EQ(a.color, b.color);
  EXPECT_EQ(a.depth, b.depth);
  const ObjectId arrow = with.second->FindObject("arrow");
  EXPECT_EQ(std::count(a.label.begin(), a.label.end(), arrow), 0);
  const Capture full = with.first->GetCapture({true, false, true, false, {}});
  EXPECT_NE(full.color, a.color);
  EXPECT_GT(std::count(full.label.begin(), full.label.end(), arrow), 0);
}

TEST_F(RenderingTest, RejectsMoreSamplesThanCanBeDrawnBeforeAnythingChanges) {
  Look({});
  auto viewport = View(50, 40, 1);
  int side = 0;
  viewport->Run([&](vtkRenderWindow* window) {
    side = vtkTextureObject::GetMaximumTextureSize(vtkOpenGLRenderWindow::SafeDownCast(window));
  });
  ASSERT_GE(side, 8192);
  const int wide = std::min(side, 16384); // at one sample a pixel, not at two
  const auto rejected = [&](const std::string& name, const std::string& size, auto&& f) {
    try {
      f();
      ADD_FAILURE() << "accepted, not rejected with " << size;
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument);
      for (const std::string& part :
           {"viewport '" + name + "'", size, std::to_string(side) + " a side",
            std::string("samples=1, or a smaller size")}) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      }
    }
  };
  const std::string tall = std::to_string(wide) + " x 9";
  // With as many samples as it takes to pass the limit.
  const int many = side / wide + 1;
  const auto fresh = [&](int samples) {
    auto made = vtkSmartPointer<vtkDspaceViewport>::New();
    made->Initialize(context, scene, "fresh", "main", wide, 9, samples);
    return made;
  };
  rejected("fresh", tall, [&] { fresh(many); });
  EXPECT_NO_THROW(fresh(1)->GetCapture({}));
  viewport->SetSamples(many);
  rejected("view", tall, [&] { viewport->Resize(wide, 9); });
  EXPECT_EQ(viewport->GetWidth(), 50);
  viewport->SetSamples(1);
  viewport->Resize(wide, 9);
  rejected("view", tall, [&] { viewport->SetSamples(many); });
  EXPECT_EQ(viewport->GetSamples(), 1);
  EXPECT_EQ(viewport->GetCapture({}).width, wide);
  // Sides that pass, and too many in all.
  viewport->Resize(16, 16);
  viewport->SetSamples(8);
  if (side > 16384) {
    EXPECT_THROW(viewport->Resize(side / 8, side / 8), Error);
    EXPECT_EQ(viewport->GetHeight(), 16);
  }
}

TEST_F(RenderingTest, RejectsBadSizesAndRepeatsItselfToTheByte) {
  Look({});
  scene->AddObject(Object("ball", scene->Frames().Create(RootFrame, "f", At(5, 0, 0)),
                          MakeSphere(1), std::make_shared<Material>()));
  auto viewport = View(50, 40, 2);
  EXPECT_THROW(viewport->Resize(0, 0), Error);
  EXPECT_THROW(viewport->Resize(100000, 100000), Error);
  EXPECT_THROW(viewport->SetSamples(0), Error);
  EXPECT_EQ(viewport->GetWidth(), 50);
  const Capture first = viewport->GetCapture({});
  viewport->Resize(70, 30);
  viewport->GetCapture({});
  viewport->Resize(50, 40);
  EXPECT_EQ(viewport->GetCapture({}).color, first.color);
  auto unknown = vtkSmartPointer<vtkDspaceViewport>::New();
  EXPECT_THROW(unknown->Initialize(context, scene, "v", "nowhere", 10, 10), Error);
}
