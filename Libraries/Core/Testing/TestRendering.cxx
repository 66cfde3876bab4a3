// Pictures against closed forms: projection, depth, translucency, precision, sharing.
#include <gtest/gtest.h>

#include <cmath>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkNew.h"

#include <dspace/Error.h>
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
  scene->AddObject(Object("box", frame, Box({1, 1, 1}), Unlit({1, 0, 0})));
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
