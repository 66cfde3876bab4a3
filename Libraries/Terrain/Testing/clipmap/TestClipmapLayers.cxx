// Colour layers on clipmaps, against the formula that paints them.
#include <cmath>
#include <random>

#include "ClipmapTestSupport.h"
#include "FormulaLayer.h"

namespace dspace::testing {
namespace {

using Color = std::array<double, 4>;

// Waves in metres, slow against a pixel of the tests.
Color Waves(const Eigen::Vector3d& p, double length) {
  return {0.5 + 0.4 * std::sin(p.x() / length), 0.5 + 0.4 * std::sin(p.y() / length),
          0.5 + 0.4 * std::cos((p.x() + p.y()) / length), 1.0};
}

struct LayersFixture : ClipmapFixture {
  static constexpr std::int64_t Side = 4097; // posts
  vtkSmartPointer<vtkDspaceViewport> view;

  // A plane whose posts are 2 m apart and whose tiles have a zoom of 1 m texels.
  void AddPlaneWithGrid(FormulaPosts::Formula formula, std::array<double, 2> heights) {
    posts = std::make_shared<FormulaPosts>(Side, Side, false, std::move(formula));
    Eigen::Affine2d map = Eigen::Affine2d::Identity();
    map.linear() << Post, 0.0, 0.0, -Post;
    map.translation() << -0.5 * Post * double(Side), 0.5 * Post * double(Side);
    ColorGrid grid;
    grid.placement = PostPlacement::OnPlane(map);
    grid.firstPost.setConstant(-0.5);
    grid.rootPosts.setConstant(8192.0);
    grid.extent = Eigen::AlignedBox2d(Eigen::Vector2d::Constant(-0.5),
                                      Eigen::Vector2d::Constant(double(Side) - 0.5));
    AddWith(grid.placement, heights, {grid});
  }
  void AddWith(const PostPlacement& placement, std::array<double, 2> heights,
               std::vector<ColorGrid> grids) {
    ClipmapOptions options;
    options.heights = heights;
    auto material = std::make_shared<Material>();
    material->color = {0.8, 0.7, 0.6};
    material->lit = false;
    options.material = material;
    terrain =
        std::make_shared<ClipmapTerrain>(std::make_shared<ElevationPyramid>(posts), placement,
                                         options, std::vector<ClipmapChart>(), std::move(grids));
    GraphicsObject ground;
    ground.name = "ground";
    ground.custom = terrain;
    object = scene->AddObject(ground);
  }
  void Paint(const std::string& name, FormulaLayer::Formula formula, double pixel,
             double opacity = 1.0) {
    StackedLayer layer;
    layer.name = name;
    layer.layer = std::make_shared<FormulaLayer>(std::move(formula), pixel);
    layer.opacity = opacity;
    terrain->Layers()->Add(layer);
  }
};

double Linear(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}
double Encoded(double l) {
  return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1.0 / 2.4) - 0.055;
}

// Every pixel that shows ground has the colour of its place; the number of them.
int ExpectColors(const Scene& scene, const Capture& capture, double tolerance,
                 const std::function<Color(const Eigen::Vector3d&)>& expected) {
  int pixels = 0;
  double worst = 0.0;
  for (int y = 1; y + 1 < capture.height; ++y) {
    for (int x = 1; x + 1 < capture.width; ++x) {
      // Not at silhouettes, where a pixel mixes.
      const Hit hit = HitAt(scene, capture, x, y);
      bool edge = !hit.hit;
      for (const auto& [i, j] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
        const float here = capture.depth[std::size_t(y) * capture.width + x];
        const float there = capture.depth[std::size_t(y + j) * capture.width + x + i];
        edge |= !(std::abs(there / here - 1.0f) < 0.1f);
      }
      if (edge) {
        continue;
      }
      const Color color = expected(hit.p);
      for (std::size_t k = 0; k < 3; ++k) {
        const int shown = capture.color[4 * (std::size_t(y) * capture.width + x) + k];
        worst = std::max(worst, std::abs(shown - 255.0 * color[k]));
      }
      ++pixels;
    }
  }
  EXPECT_LE(worst, tolerance);
  return pixels;
}

TEST_F(LayersFixture, EveryPixelHasTheColorOfItsPlace) {
  AddPlaneWithGrid(Hills, {-60.0, 60.0});
  Paint(
      "waves", [](const Eigen::Vector3d& p, int) { return Waves(p, 300.0); }, 1.0);
  view = View(320, 240);
  int pixels = 0;
  for (const auto& [eye, at, fov] :
       {std::tuple(Eigen::Vector3d(0, 0, 70), Eigen::Vector3d(600, 200, 0), 60.0),
        {Eigen::Vector3d(-500, 300, 2500), Eigen::Vector3d(100, 0, 0), 60.0},
        {Eigen::Vector3d(37, -900, 90), Eigen::Vector3d(500, 900, 0), 5.0},
        {Eigen::Vector3d(0, 0, 9000), Eigen::Vector3d(1, 0, 0), 60.0}}) {
    LookFrom(eye, at, fov);
    const Capture capture = Shoot(view);
    Keep(capture, "layers_" + std::to_string(int(eye.z())));
    pixels += ExpectColors(*scene, capture, 3.0,
                           [](const Eigen::Vector3d& p) { return Waves(p, 300.0); });
  }
  EXPECT_GT(pixels, 120000);
}

// The layer paints its zoom: texels are no larger than pixels, and not much smaller.
TEST_F(LayersFixture, TexelsAreAsLargeAsPixels) {
  AddPlaneWithGrid([](double, double) { return 0.0; }, {0.0, 0.0});
  Paint(
      "zooms",
      [](const Eigen::Vector3d&, int zoom) {
        return Color{zoom / 16.0, 0, 0, 1};
      },
      1e-3);
  const double root = 8192.0 * Post / 256.0; // [m] a texel of zoom 0
  view = View(320, 240);
  const auto zoomAt = [this](const Capture& capture, int x, int y) {
    return 16.0 * capture.color[4 * (std::size_t(y) * capture.width + x)] / 255.0;
  };
  for (const auto& [height, fov] : {std::pair(6000.0, 60.0), {800.0, 60.0}, {90.0, 10.0}}) {
    LookFrom({5, 5, height}, {5, 6, 0}, fov);
    const Capture capture = Shoot(view);
    const double pixel = 2.0 * std::tan(0.5 * fov * M_PI / 180.0) * height / 240.0;
    const double zoom = std::log2(root / pixel);
    EXPECT_GT(zoomAt(capture, 160, 120), zoom - 0.8) << height;
    EXPECT_LT(zoomAt(capture, 160, 120), zoom + 0.8) << height;
  }
  // A parallel camera, from whatever height.
  Camera camera;
  camera.name = "camera";
  camera.projection.kind = Projection::Kind::Orthographic;
  camera.projection.height = 60.0;
  camera.projection.nearDistance = 1.0;
  camera.projection.farDistance = 1e5;
  camera.mount.X_FC = LookAt("camera", {300, 500, 4000}, {300, 500, 0}, {0, 1, 0});
  scene->SetCamera("main", camera);
  EXPECT_NEAR(zoomAt(Shoot(view), 160, 120), std::log2(root / (60.0 / 240.0)), 0.8);
}

TEST_F(LayersFixture, LayersAreMixedInLinearLight) {
  AddPlaneWithGrid([](double, double) { return 0.0; }, {0.0, 0.0});
  view = View(64, 48);
  LookFrom({0, 0, 300}, {0, 1, 0});
  const Capture bare = Shoot(view);
  Paint(
      "lower",
      [](const Eigen::Vector3d&, int) {
        return Color{0.9, 0.2, 0.1, 0.6};
      },
      1.0);
  Paint(
      "upper",
      [](const Eigen::Vector3d&, int) {
        return Color{0.1, 0.3, 0.8, 1.0};
      },
      1.0, 0.25);
  const std::array<double, 3> ground = {0.8, 0.7, 0.6};
  const std::array<double, 3> lower = {0.9, 0.2, 0.1};
  const std::array<double, 3> upper = {0.1, 0.3, 0.8};
  const double a = 153.0 / 255.0; // 0.6 in 8 bits
  const Capture both = Shoot(view);
  const std::size_t middle = 4 * (24 * 64 + 32);
  for (std::size_t k = 0; k < 3; ++k) {
    double light = Linear(ground[k]) * (1.0 - a) + a * Linear(lower[k]);
    light = light * 0.75 + 0.25 * Linear(upper[k]);
    EXPECT_NEAR(both.color[middle + k], 255.0 * Encoded(light), 2.0) << k;
  }
  // Out of sight they are as if they were not there.
  terrain->Layers()->Change("lower", std::nullopt, false, std::nullopt);
  terrain->Layers()->Change("upper", 0.0, std::nullopt, std::nullopt);
  EXPECT_EQ(Shoot(view).color, bare.color);
  terrain->Layers()->Change("upper", 1.0, std::nullopt, std::nullopt);
  const Capture covered = Shoot(view);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(covered.color[middle + k], 255.0 * upper[k], 1.0) << k;
  }
}

// Tiles that earlier pictures brought are on the GPU still, and none of them shows.
TEST_F(LayersFixture, APictureHangsOnItsOwnViewAlone) {
  AddPlaneWithGrid(Hills, {-60.0, 60.0});
  Paint(
      "zooms",
      [](const Eigen::Vector3d&, int zoom) {
        return Color{zoom / 16.0, 0.3, 0, 1};
      },
      0.01);
  view = View(160, 120);
  const auto far = [this] { LookFrom({0, -900, 260}, {0, 0, 0}, 40.0); };
  far();
  const Capture first = Shoot(view);
  for (const double height : {70.0, 120.0, 200.0}) { // on what the first one sees from afar
    LookFrom({10, -60, height}, {10, 0, 0});
    Shoot(view);
  }
  view->Resize(640, 480); // more slots, too
  Shoot(view);
  view->Resize(160, 120);
  terrain->Layers()->Change("zooms", 0.5, std::nullopt, std::nullopt);
  far();
  Shoot(view);
  terrain->Layers()->Change("zooms", 1.0, std::nullopt, std::nullopt);
  EXPECT_EQ(Shoot(view).color, first.color);
}

TEST_F(LayersFixture, AroundABodyThereIsNoSeam) {
  constexpr double Radius = 1e6;
  constexpr int Columns = 4096;
  posts = std::make_shared<FormulaPosts>(
      Columns, Columns / 2 + 1, true, [](double, double r) { return 500.0 * std::sin(0.05 * r); });
  ColorGrid grid;
  grid.placement =
      PostPlacement::OnSphere({-180.0, 90.0}, {360.0 / Columns, -360.0 / Columns}, Radius);
  grid.rootColumns = 2;
  grid.periodic = true;
  grid.rootPosts.setConstant(0.5 * Columns);
  grid.extent = Eigen::AlignedBox2d(Eigen::Vector2d::Zero(), Eigen::Vector2d(Columns, Columns / 2));
  AddWith(grid.placement, {-500.0, 500.0}, {grid});
  const auto directions = [](const Eigen::Vector3d& p) {
    const Eigen::Vector3d d = p.normalized();
    return Color{0.5 + 0.4 * std::sin(5.0 * d.x()), 0.5 + 0.4 * std::sin(7.0 * d.y()),
                 0.5 + 0.4 * std::sin(6.0 * d.z()), 1.0};
  };
  Paint(
      "directions", [&directions](const Eigen::Vector3d& p, int) { return directions(p); }, 20.0);
  view = View(320, 240);
  int pixels = 0;
  for (const auto& [lon, lat, height] : {std::tuple(180.0, 5.0, 2e6),
                                         {-179.9, 30.0, 4e4},
                                         {179.95, -20.0, 3000.0},
                                         {10.0, 55.0, 3e5},
                                         {720.0 + 93.0, -45.0, 1e5}}) {
    const double l = lon * M_PI / 180.0;
    const double p = lat * M_PI / 180.0;
    const Eigen::Vector3d up(std::cos(p) * std::cos(l), std::cos(p) * std::sin(l), std::sin(p));
    LookFrom((Radius + height) * up, 0.9 * Radius * up + Eigen::Vector3d(0, 0, 0.05 * Radius));
    const Capture capture = Shoot(view);
    Keep(capture, "layers_body_" + std::to_string(int(height)));
    pixels += ExpectColors(*scene, capture, 4.0, directions);
  }
  EXPECT_GT(pixels, 150000);
}

} // namespace
} // namespace dspace::testing
