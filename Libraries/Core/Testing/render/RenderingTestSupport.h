// What the tests of pictures share: a scene, a camera, viewports, and simple objects.
#ifndef DSPACE_CORE_TESTING_RENDERING_TEST_SUPPORT_H
#define DSPACE_CORE_TESTING_RENDERING_TEST_SUPPORT_H

#include <gtest/gtest.h>

#include <cmath>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <dspace/Error.h>
#include <dspace/render/DrawList.h>
#include <dspace/scene/Primitives.h>

namespace dspace {

inline std::shared_ptr<const Material> Unlit(std::array<double, 3> color, double opacity = 1.0) {
  auto material = std::make_shared<Material>();
  material->color = color;
  material->opacity = opacity;
  material->lit = false;
  return material;
}

inline GraphicsObject Object(const std::string& name, FrameId frame, Mesh mesh,
                             std::shared_ptr<const Material> material) {
  GraphicsObject object;
  object.name = name;
  object.frame = frame;
  object.levels = {{{{std::make_shared<const Mesh>(std::move(mesh)), std::move(material)}}, 0.0}};
  return object;
}

inline Mesh PlaneTowardsCamera(double width, double height) {
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

inline Pose At(double x, double y, double z) {
  Pose pose;
  pose.position = {x, y, z};
  return pose;
}

// Columns and rows that an object covers, as first and last pixel.
struct Extent {
  int left = 1 << 30, right = -1, top = 1 << 30, bottom = -1;
};

inline Extent ExtentOf(const Capture& capture, ObjectId label) {
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

struct RenderingFixture : ::testing::Test {
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
  // The most by which a vertex is displaced [pixels]: a GPU rounds vertices to a grid of 1/256 of a
  // pixel (GL_SUBPIXEL_BITS is 8 or more). 0 on llvmpipe, where the tests' tolerances cover it.
  double VertexOffset() {
    return context->GetRendererName().find("llvmpipe") == std::string::npos ? 1.0 / 512.0 : 0.0;
  }
};

} // namespace dspace

#endif
