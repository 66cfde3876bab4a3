// Pictures against closed forms: projection, depth, translucency, precision, sharing.
#include <gtest/gtest.h>

#include <cmath>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <dspace/Error.h>
#include <dspace/render/DrawList.h>
#include <dspace/scene/Primitives.h>

using namespace dspace;

namespace {

std::shared_ptr<const Material> Unlit(std::array<double, 3> color, double opacity = 1.0) {
  auto material = std::make_shared<Material>();
  material->color = color;
  material->opacity = opacity;
  material->lit = false;
  return material;
}

GraphicsObject Object(const std::string& name, FrameId frame, Mesh mesh,
                      std::shared_ptr<const Material> material) {
  GraphicsObject object;
  object.name = name;
  object.frame = frame;
  object.levels = {{{{std::make_shared<const Mesh>(std::move(mesh)), std::move(material)}}, 0.0}};
  return object;
}

struct Fixture : ::testing::Test {
  vtkNew<vtkDspaceRenderContext> context;
  std::shared_ptr<Scene> scene = std::make_shared<Scene>("scene");

  // A camera at the root's origin that looks along the root's X, Z up.
  void Look(Projection projection, FrameId frame = RootFrame) {
    if (scene->VantageNames().empty()) {
      scene->CreateVantage("main");
    }
    Camera camera;
    camera.name = "camera";
    camera.projection = projection;
    camera.mount.frame = frame;
    camera.mount.X_FC = LookAt("camera", {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
    scene->SetCamera("main", camera);
  }
  vtkSmartPointer<vtkDspaceViewport> View(int width, int height, int samples = 1) {
    auto viewport = vtkSmartPointer<vtkDspaceViewport>::New();
    viewport->Initialize(context, scene, "view", "main", width, height);
    viewport->SetSamples(samples);
    return viewport;
  }
};

} // namespace

TEST_F(Fixture, DrawsABoxWhereProjectionByHandPutsIt) {
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

namespace {

// Columns and rows that a colour covers, as first and last pixel.
struct Extent {
  int left = 1 << 30, right = -1, top = 1 << 30, bottom = -1;
};

Extent ExtentOf(const Capture& capture, ObjectId label) {
  Extent extent;
  for (int y = 0; y < capture.height; ++y) {
    for (int x = 0; x < capture.width; ++x) {
      if (capture.label[static_cast<std::size_t>(y) * capture.width + x] == label) {
        extent.left = std::min(extent.left, x);
        extent.right = std::max(extent.right, x);
        extent.top = std::min(extent.top, y);
        extent.bottom = std::max(extent.bottom, y);
      }
    }
  }
  return extent;
}

Mesh PlaneTowardsCamera(double width, double height) {
  // In YZ, facing -X: towards a camera at the origin that looks along X.
  Mesh mesh = MakePlane(width, height);
  for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
    const float x = mesh.positions[i];
    const float y = mesh.positions[i + 1];
    mesh.positions[i] = 0.0f;
    mesh.positions[i + 1] = -x;
    mesh.positions[i + 2] = y;
    mesh.normals[i] = -1.0f;
    mesh.normals[i + 1] = 0.0f;
    mesh.normals[i + 2] = 0.0f;
  }
  return mesh;
}

Pose At(double x, double y, double z) {
  Pose pose;
  pose.position = {x, y, z};
  return pose;
}

std::uint8_t Srgb(double linear) {
  const double v = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * v));
}

} // namespace

TEST_F(Fixture, OrthographicAndOffAxisCamerasPutSquaresWhereTheHandDoes) {
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

TEST_F(Fixture, IntersectingTranslucentQuadsBlendAsByHand) {
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

TEST_F(Fixture, DepthHoldsFromCentimetresToBeyondTheMoon) {
  Projection projection;
  projection.nearDistance = 0.1;
  projection.farDistance = 4e8;
  projection.verticalFov_deg = 40;
  Look(projection);
  auto viewport = View(64, 64);
  for (const double distance : {0.2, 1.0, 1e3, 1e6, 1e8, 3.5e8}) {
    auto trial = std::make_shared<Scene>("trial");
    trial->CreateVantage("main");
    Camera camera = scene->Vantage("main").ActiveCamera();
    trial->SetCamera("main", camera);
    const double size = 0.4 * distance;
    // The farther one is drawn last, and is tilted so that depths vary over the picture.
    Pose near = At(distance, 0, 0);
    near.rotation = Eigen::AngleAxisd(0.5, Eigen::Vector3d(0, 1, 1).normalized());
    Pose far = near;
    far.position.x() = distance * (1 + 1e-4);
    Mesh mesh = PlaneTowardsCamera(1, 1);
    GraphicsObject front =
        Object("front", trial->Frames().Create(RootFrame, "f", near), mesh, Unlit({1, 1, 1}));
    GraphicsObject back =
        Object("back", trial->Frames().Create(RootFrame, "b", far), mesh, Unlit({1, 0, 0}));
    front.X_FO = Eigen::Affine3d(Eigen::Scaling(size));
    back.X_FO = Eigen::Affine3d(Eigen::Scaling(size));
    const ObjectId frontId = trial->AddObject(front);
    const ObjectId backId = trial->AddObject(back);
    auto view = vtkSmartPointer<vtkDspaceViewport>::New();
    view->Initialize(context, trial, "trial", "main", 64, 64);
    const Capture capture = view->GetCapture({false, true, true, false, {}});
    int fronts = 0;
    int backs = 0;
    for (int y = 20; y < 44; ++y) {
      for (int x = 20; x < 44; ++x) {
        fronts += capture.label[y * 64 + x] == frontId;
        backs += capture.label[y * 64 + x] == backId;
      }
    }
    EXPECT_EQ(fronts, 24 * 24) << "at " << distance << " m";
    EXPECT_EQ(backs, 0) << "at " << distance << " m";
    // Depth against the tilted plane itself, at the central pixel's corner of four.
    const Eigen::Vector3d n = near.rotation * Eigen::Vector3d::UnitX();
    const auto ray = projection.PixelRay(30, 40, 64, 64);
    const Eigen::Vector3d d(ray.direction.z(), -ray.direction.x(), -ray.direction.y()); // in root
    const double t = n.dot(near.position) / n.dot(d);
    EXPECT_NEAR(capture.depth[40 * 64 + 30] / (t * d.x()), 1.0, 2e-6) << "at " << distance << " m";
  }
}

TEST_F(Fixture, MovingTheCommonFrameByAnAstronomicalUnitChangesNoByte) {
  const double au = 149597870700.0;
  const FrameId ship = scene->Frames().Create(RootFrame, "ship", At(1, 2, 3));
  const FrameId part = scene->Frames().Create(ship, "part", At(5, 0.3, 0.2));
  auto lit = std::make_shared<Material>();
  scene->AddObject(Object("part", part, MakeSphere(1.0), lit));
  Light sun;
  sun.name = "sun";
  sun.direction = {1, 0.3, -0.5};
  scene->SetLight(sun);
  Light lamp; // hangs on the ship, as the camera does
  lamp.name = "lamp";
  lamp.kind = Light::Kind::Point;
  lamp.frame = ship;
  lamp.position = {3, 1, 1};
  scene->SetLight(lamp);
  Look({}, ship);
  auto viewport = View(120, 90);
  const Capture before = viewport->GetCapture({true, true, true, false, {}});
  scene->Frames().SetLocalPose(ship, At(au, -au, 0.5 * au));
  const Capture after = viewport->GetCapture({true, true, true, false, {}});
  EXPECT_EQ(before.color, after.color);
  EXPECT_EQ(before.depth, after.depth);
  EXPECT_EQ(before.label, after.label);
  EXPECT_GT(ExtentOf(after, 1).right, 0);
}

TEST_F(Fixture, WithTheCameraInAnotherBranchNothingMovesByATwentiethOfAPixel) {
  // Ship and camera in two branches, one astronomical unit out: edges keep their pixels.
  const double au = 149597870700.0;
  const FrameId ship = scene->Frames().Create(RootFrame, "ship", At(5, 0, 0));
  const FrameId eye = scene->Frames().Create(RootFrame, "eye", At(0, 0, 0));
  scene->AddObject(Object("square", ship, PlaneTowardsCamera(1, 1), Unlit({1, 1, 1})));
  Look({}, eye);
  auto viewport = View(400, 400, 8); // an edge moved by 0.02 px changes no more than the coverage
  const Capture before = viewport->GetCapture({});
  scene->Frames().SetLocalPose(ship, At(au + 5, au, -au));
  scene->Frames().SetLocalPose(eye, At(au, au, -au));
  const Capture after = viewport->GetCapture({});
  int largest = 0;
  for (std::size_t i = 0; i < before.color.size(); ++i) {
    // In linear light a shift of 0.02 px changes an edge pixel's coverage by 0.02, which one of
    // the 64 samples' steps (0.125 a row of samples) can round up.
    const double difference =
        std::abs(LinearFromSrgb(before.color[i] / 255.0) - LinearFromSrgb(after.color[i] / 255.0));
    largest = std::max(largest, static_cast<int>(std::lround(1000 * difference)));
  }
  EXPECT_LE(largest, 125 + 5);
  // And by closed form: the relative pose itself is off by less than 0.02 px at 482.8 px / 5 m.
  const Pose X = scene->Frames().RelativePose(eye, ship);
  EXPECT_LT((X.position - Eigen::Vector3d(5, 0, 0)).norm() * 482.8 / 5, 0.02);
}

TEST_F(Fixture, CamerasAtEarthAndMoonShareTheSceneWithoutUploads) {
  const double distance = 384400e3;
  scene->AddObject(Object("earth", scene->Frames().Create(RootFrame, "earth", At(0, 0, 0)),
                          MakeSphere(6.4e6, 64), std::make_shared<Material>()));
  scene->AddObject(Object("moon", scene->Frames().Create(RootFrame, "moon", At(distance, 0, 0)),
                          MakeSphere(1.7e6, 64), std::make_shared<Material>()));
  Look({});
  Camera nearEarth = scene->Vantage("main").ActiveCamera();
  nearEarth.name = "near earth";
  nearEarth.mount.X_FC = LookAt("", {-2e7, 0, 0}, {0, 0, 0}, {0, 0, 1});
  scene->SetCamera("main", nearEarth);
  Camera nearMoon = nearEarth;
  nearMoon.name = "near moon";
  nearMoon.mount.X_FC = LookAt("", {distance + 5e6, 1e6, 0}, {distance, 0, 0}, {0, 0, 1});
  scene->SetCamera("main", nearMoon);
  auto a = View(80, 60);
  auto b = View(80, 60);
  a->SetCamera("near earth");
  b->SetCamera("near moon");
  a->Render();
  b->Render();
  const RenderStatistics first = context->GetStatistics();
  EXPECT_GT(first.meshBytesUploaded, 0u);
  for (int i = 0; i < 3; ++i) {
    a->ForceRender();
    b->ForceRender();
  }
  const RenderStatistics last = context->GetStatistics();
  EXPECT_EQ(first.meshBytesUploaded, last.meshBytesUploaded);
  EXPECT_EQ(first.textureBytesUploaded, last.textureBytesUploaded);
  EXPECT_EQ(first.instanceBytesUploaded, last.instanceBytesUploaded);
  EXPECT_EQ(first.meshBytes, last.meshBytes);
}

TEST_F(Fixture, AWheelOnTheMoonDoesNotJitter) {
  // A wheel seen from 2 m, both on the Moon's body-fixed frame far from the root: as the Moon
  // moves along its orbit in steps that floats cannot resolve, no byte of the picture changes.
  const FrameId moon = scene->Frames().Create(RootFrame, "moon", At(3.844e8, 0, 0));
  const FrameId site = scene->Frames().Create(moon, "site", At(1737400.0, 0, 0));
  const FrameId wheel = scene->Frames().Create(site, "wheel", At(2, 0, 0));
  scene->AddObject(Object("wheel", wheel, MakeCylinder(0.25, 0.2), std::make_shared<Material>()));
  Light head;
  head.name = "head";
  head.kind = Light::Kind::Head;
  scene->SetLight(head);
  Look({}, site);
  auto viewport = View(100, 100);
  const Capture first = viewport->GetCapture({});
  for (int step = 1; step < 20; ++step) {
    Pose pose = At(3.844e8 + 0.137 * step, 1022.0 * step, 0);
    pose.rotation = Eigen::AngleAxisd(1e-7 * step, Eigen::Vector3d::UnitZ());
    scene->Frames().SetLocalPose(moon, pose);
    ASSERT_EQ(viewport->GetCapture({}).color, first.color) << "step " << step;
  }
}

TEST_F(Fixture, PicksWhatARayHits) {
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

TEST_F(Fixture, AnUnchangedViewportIsNotDrawnAgainAndAHiddenOneNotAtAll) {
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

TEST_F(Fixture, APhysicalPictureKnowsNothingOfOrnaments) {
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

TEST_F(Fixture, LambertsLawHoldsUnderADirectionalLight) {
  Look({});
  const FrameId frame = scene->Frames().Create(RootFrame, "f", At(10, 0, 0));
  auto material = std::make_shared<Material>();
  material->color = {1, 1, 1};
  material->roughness = 1.0;
  scene->AddObject(Object("wall", frame, PlaneTowardsCamera(20, 20), material));
  Light sun;
  sun.name = "sun";
  sun.intensity = 0.5;
  for (const double angle_deg : {0.0, 30.0, 60.0, 80.0, 100.0}) {
    const double angle = angle_deg * M_PI / 180;
    sun.direction = {std::cos(angle), 0, -std::sin(angle)};
    scene->SetLight(sun);
    auto viewport = View(21, 21);
    const double measured =
        LinearFromSrgb(viewport->GetCapture({}).color[4 * (10 * 21 + 10)] / 255.0);
    // A white matt dielectric: 0.96 diffuse at most, plus a faint lobe below 0.04 / 4 pi * pi.
    const double lambert = std::max(0.0, 0.5 * std::cos(angle));
    EXPECT_NEAR(measured, lambert, 0.04 * 0.5 + 0.01) << angle_deg;
  }
}

TEST_F(Fixture, RefusesBadSizesAndRepeatsItselfToTheByte) {
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
