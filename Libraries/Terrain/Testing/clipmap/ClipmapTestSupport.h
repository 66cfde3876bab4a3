// What the tests of clipmaps' pictures share: terrain made of a formula, a camera, what a pixel
// shows.
#ifndef DSPACE_TEST_CLIPMAPTESTSUPPORT_H
#define DSPACE_TEST_CLIPMAPTESTSUPPORT_H

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "FormulaPosts.h"
#include "RenderingTestSupport.h"

#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/clipmap/gl/ClipmapDrawing.h>

namespace dspace::testing {

// DSPACE_TEST_PICTURES names a folder for those who want to look.
inline void Keep(const Capture& capture, const std::string& name) {
  const char* folder = std::getenv("DSPACE_TEST_PICTURES");
  if (!folder) {
    return;
  }
  std::FILE* file = std::fopen((std::string(folder) + "/" + name + ".ppm").c_str(), "wb");
  std::fprintf(file, "P6 %d %d 255\n", capture.width, capture.height);
  for (std::size_t i = 0; i < capture.color.size(); i += 4) {
    std::fwrite(&capture.color[i], 1, 3, file);
  }
  std::fclose(file);
}

inline double Hills(double c, double r) {
  return 40.0 * std::sin(0.013 * c) * std::cos(0.017 * r) + 9.0 * std::sin(0.11 * c + 0.07 * r) +
         1.5 * std::sin(0.9 * c) * std::sin(0.8 * r);
}

struct ClipmapFixture : RenderingFixture {
  static constexpr double Post = 2.0; // [m]
  std::shared_ptr<FormulaPosts> posts;
  std::shared_ptr<ClipmapTerrain> terrain;
  ObjectId object = 0;

  void SetUp() override {
    RegisterClipmapDrawer(context->GetDrawers());
    scene->CreateVantage("main");
  }

  void AddPlane(std::int64_t side, FormulaPosts::Formula formula, std::array<double, 2> heights,
                bool lit = true) {
    posts = std::make_shared<FormulaPosts>(side, side, false, std::move(formula));
    Eigen::Affine2d map = Eigen::Affine2d::Identity();
    map.linear() << Post, 0.0, 0.0, -Post;
    map.translation() << -0.5 * Post * double(side), 0.5 * Post * double(side);
    Add(PostPlacement::OnPlane(map), heights, lit);
  }
  void Add(const PostPlacement& placement, std::array<double, 2> heights, bool lit) {
    ClipmapOptions options;
    options.heights = heights;
    auto material = std::make_shared<Material>();
    material->color = {0.8, 0.7, 0.6};
    material->roughness = 1.0;
    material->lit = lit;
    options.material = material;
    terrain = std::make_shared<ClipmapTerrain>(std::make_shared<ElevationPyramid>(posts), placement,
                                               options);
    GraphicsObject ground;
    ground.name = "ground";
    ground.custom = terrain;
    object = scene->AddObject(ground);
    if (lit) {
      Light sun;
      sun.name = "sun";
      sun.direction = Eigen::Vector3d(-0.6, 0.3, -0.5).normalized();
      scene->SetLight(sun);
    }
  }
  void LookFrom(const Eigen::Vector3d& eye, const Eigen::Vector3d& at, double fov = 60.0,
                const Eigen::Vector3d& vertical = Eigen::Vector3d::UnitZ()) {
    Camera camera;
    camera.name = "camera";
    camera.projection.verticalFov_deg = fov;
    camera.projection.nearDistance = 0.05;
    camera.projection.farDistance = 1e9;
    const Eigen::Vector3d up =
        (at - eye).normalized().cross(vertical).norm() < 0.1 ? vertical.unitOrthogonal() : vertical;
    camera.mount.X_FC = LookAt("camera", eye, at, up);
    scene->SetCamera("main", camera);
  }
};

// Of a pixel's centre: the point that was drawn there, in the root frame.
struct Hit {
  bool hit = false;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
};

inline Hit HitAt(const Scene& scene, const Capture& capture, int x, int y) {
  const float depth = capture.depth[std::size_t(y) * capture.width + x];
  if (!std::isfinite(depth)) {
    return {};
  }
  const Projection& projection = scene.Vantage("main").ActiveCamera().projection;
  const Projection::Ray ray = projection.PixelRay(x, y, capture.width, capture.height);
  const Eigen::Vector3d p_C =
      ray.origin + ray.direction * ((double(depth) - ray.origin.z()) / ray.direction.z());
  return {true, scene.PlaceCamera("main").X_FC.Apply(p_C)};
}

inline Capture Shoot(vtkDspaceViewport* view) {
  CaptureRequest request;
  request.depth = true;
  return view->GetCapture(request);
}

} // namespace dspace::testing

#endif
