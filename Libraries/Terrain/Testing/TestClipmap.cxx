// Pictures of clipmaps: depth against the surface, gaps, seams, and what is uploaded.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <thread>

#include "../../Core/Testing/RenderingTestSupport.h"
#include "FormulaPosts.h"

#include <dspace/terrain/ClipmapDrawer.h>
#include <dspace/terrain/ClipmapTerrain.h>
#include <dspace/terrain/HeightGrid.h>
#include <dspace/terrain/PolarPosts.h>

namespace {

using namespace dspace;
using dspace::testing::FormulaPosts;

// DSPACE_TEST_PICTURES names a folder for those who want to look.
void Keep(const Capture& capture, const std::string& name) {
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

double Hills(double c, double r) {
  return 40.0 * std::sin(0.013 * c) * std::cos(0.017 * r) + 9.0 * std::sin(0.11 * c + 0.07 * r) +
         1.5 * std::sin(0.9 * c) * std::sin(0.8 * r);
}

struct ClipmapFixture : RenderingFixture {
  static constexpr double Post = 2.0; // [m]
  std::shared_ptr<FormulaPosts> posts;
  std::shared_ptr<ClipmapTerrain> terrain;
  ObjectId object = 0;

  void SetUp() override {
    RegisterClipmapDrawer();
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

Hit HitAt(const Scene& scene, const Capture& capture, int x, int y) {
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

Capture Shoot(vtkDspaceViewport* view) {
  CaptureRequest request;
  request.depth = true;
  return view->GetCapture(request);
}

// HeightGrid evaluates the triangles by other code in double precision.
TEST_F(ClipmapFixture, TheFinestRingIsTheStatedSurfaceToAMillimetre) {
  AddPlane(513, Hills, {-51, 51}, false);
  std::vector<double> heights;
  for (int r = 0; r < 513; ++r) {
    for (int c = 0; c < 513; ++c) {
      heights.push_back(Hills(c, r));
    }
  }
  const HeightGrid grid("hills", 513, 513, heights, terrain->Placement().PostToScene());
  const double tolerance = 1e-3 + 1e-6 * 102.0;
  auto view = View(320, 240);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anywhere(-350.0, 350.0);
  const ClipmapGeometry geometry(124);
  int compared = 0;
  for (int n = 0; n < 8; ++n) {
    const Eigen::Vector2d xy(anywhere(random), anywhere(random));
    const double ground = grid.FacetAt(grid.ToGrid(xy)).height;
    const Eigen::Vector3d eye(xy.x(), xy.y(), ground + (n % 2 == 0 ? 0.3 : 12.0));
    LookFrom(eye, eye + Eigen::Vector3d(anywhere(random), anywhere(random), -90.0));
    const Capture capture = Shoot(view);
    for (int y = 0; y < capture.height; ++y) {
      for (int x = 0; x < capture.width; ++x) {
        const Hit hit = HitAt(*scene, capture, x, y);
        const double away = (hit.p - eye).cwiseAbs().head<2>().maxCoeff() / Post;
        if (!hit.hit || away > geometry.BlendFrom() - 1.0) { // its triangle's posts, too
          continue;
        }
        const HeightGrid::Facet facet = grid.FacetAt(grid.ToGrid(hit.p.head<2>()));
        if (!facet.valid) {
          continue;
        }
        // OpenGL places vertices on a grid of 1/256 pixel: the surface is drawn as if moved
        // across the ray by up to half of that along both axes.
        const double pixel = 2.0 * std::tan(30.0 * M_PI / 180.0) / 240.0 * (hit.p - eye).norm();
        const double moved = std::sqrt(2.0) / 512.0 * pixel / grid.Normal(facet).z();
        ASSERT_NEAR(hit.p.z(), facet.height, tolerance + moved)
            << "view " << n << ", pixel " << x << ", " << y;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 100000);
}

// A smooth surface's chords depart from it by at most an eighth of its second derivatives times the
// squared distance of the posts.
TEST_F(ClipmapFixture, CoarserRingsStayWithinTheirChords) {
  const auto smooth = [](double c, double r) {
    return 40.0 * std::sin(0.013 * c) * std::cos(0.017 * r);
  };
  const double bend = 40.0 * (0.013 * 0.013 + 2.0 * 0.013 * 0.017 + 0.017 * 0.017) / 8.0;
  AddPlane(8193, smooth, {-41, 41}, false);
  const Eigen::Affine2d toPosts = terrain->Placement().PostToScene().inverse();
  auto view = View(320, 240);
  const ClipmapGeometry geometry(124);
  int coarse = 0;
  for (const double height : {60.0, 400.0, 3000.0}) {
    const Eigen::Vector3d eye(137.0, -211.0, height);
    LookFrom(eye, eye + Eigen::Vector3d(1.0, 0.4, -0.5));
    const Capture capture = Shoot(view);
    for (int y = 0; y < capture.height; ++y) {
      for (int x = 0; x < capture.width; ++x) {
        const Hit hit = HitAt(*scene, capture, x, y);
        if (!hit.hit) {
          continue;
        }
        const Eigen::Vector2d post = toPosts * Eigen::Vector2d(hit.p.head<2>());
        const double ground = smooth(post.x(), post.y());
        double away = (hit.p - eye).cwiseAbs().head<2>().maxCoeff() / Post;
        away = std::max(away, (height + 41.0) / Post);
        int level = 0;
        while (std::ldexp(away, -level) > geometry.BlendFrom()) {
          ++level;
        }
        const double range = (hit.p - eye).norm();
        ASSERT_NEAR(hit.p.z(), ground, std::ldexp(bend, 2 * level) + 1e-3 + 1e-6 * range)
            << "height " << height << ", pixel " << x << ", " << y;
        coarse += level > 0;
      }
    }
  }
  EXPECT_GT(coarse, 50000);
}

// Nothing but ground is below the horizon: each pixel of another colour is a gap.
TEST_F(ClipmapFixture, NoGapOpensOnAFlight) {
  AddPlane(4097, Hills, {-51, 51}, false);
  auto view = View(240, 180);
  view->SetBackground({1, 0, 0}, {1, 0, 0});
  for (int step = 0; step < 150; ++step) {
    const double t = step / 150.0;
    const Eigen::Vector3d eye(-600.0 + 3.0 * step, 250.0 * std::sin(5.0 * t),
                              step < 100 ? 60.0 : 60.0 * std::pow(1.06, step - 100));
    LookFrom(eye, eye + Eigen::Vector3d(1.0, 0.2, -1.2), 50.0);
    const Capture capture = Shoot(view);
    for (std::size_t i = 0; i < capture.color.size(); i += 4) {
      if (i == 0 && step % 30 == 0) {
        Keep(capture, "flight" + std::to_string(step));
      }
      ASSERT_FALSE(capture.color[i] == 255 && capture.color[i + 1] == 0)
          << "step " << step << ", pixel " << i / 4 % 240 << ", " << i / 4 / 240;
    }
  }
}

// A window that snaps on, and a level that comes or goes with the camera's height, change nothing
// that is seen: the two pictures a hair's breadth apart on either side are alike.
TEST_F(ClipmapFixture, NoPixelJumpsWhereWindowsSnapAndLevelsCome) {
  AddPlane(4097, Hills, {-51, 51}, true);
  auto view = View(320, 240);
  const ClipmapGeometry geometry(124);
  const auto shoot = [&](const Eigen::Vector3d& eye) {
    LookFrom(eye, eye + Eigen::Vector3d(1.0, 0.3, -0.5));
    return view->GetCapture({});
  };
  const auto compare = [&](const Eigen::Vector3d& before, const Eigen::Vector3d& after,
                           const std::string& where) {
    const Capture a = shoot(before);
    const Capture b = shoot(after);
    int changed = 0;
    for (std::size_t i = 0; i < a.color.size(); ++i) {
      changed += std::abs(a.color[i] - b.color[i]) > 6;
    }
    EXPECT_LE(changed, 12) << where; // of 307200: ridges move by a part of a pixel
  };
  const double hair = 1e-4; // [m]
  const double west = -0.5 * Post * 4097;
  for (const int level : {0, 1, 2, 4, 6}) {
    // A post on which windows of this and all finer levels snap.
    const double x = west + Post * (1 << level) * 2.0 * std::round(1000.0 / (1 << level));
    for (const double height : {70.0, 260.0}) {
      compare({x - hair, 3.0, height}, {x + hair, 3.0, height},
              "level " + std::to_string(level) + " snaps at height " + std::to_string(height));
    }
  }
  const auto ground = [&](double x, double y) {
    const Eigen::Vector3d post = terrain->Placement().ToPosts({x, y, 0.0});
    return Hills(std::round(post.x()), std::round(post.y()));
  };
  const Eigen::Vector2d post = // where the ground's height is a post's, in all levels
      terrain->Placement().ToScene({2048.0, 2048.0}, 0.0).head<2>();
  for (const int level : {0, 1, 2, 3}) {
    const double height = ground(post.x(), post.y()) + geometry.BlendTo() * Post * (1 << level);
    compare({post.x(), post.y(), height - hair}, {post.x(), post.y(), height + hair},
            "level " + std::to_string(level) + " goes");
  }
}

// After any number of moves the texture is what a first upload would have been, byte for byte.
TEST_F(ClipmapFixture, TexturesAreThoseOfAFullUploadAndOnlyNewsGoesUp) {
  posts = std::make_shared<FormulaPosts>(3000, 3000, false, Hills, 28);
  const auto pyramid = std::make_shared<ElevationPyramid>(posts);
  ClipmapLevels levels(pyramid, 28);
  const ClipmapGeometry geometry(28);
  const std::size_t side = geometry.Texels();
  // What OpenGL would hold.
  std::vector<std::vector<ClipmapTexel>> textures(levels.Count(),
                                                  std::vector<ClipmapTexel>(side * side));
  std::size_t uploaded = 0;
  const auto upload = [&](int level, const ClipmapUpdate& u, const ClipmapTexel* texels) {
    for (int j = 0; j < u.height; ++j) {
      std::copy_n(texels + std::size_t(j) * u.width, u.width,
                  textures[level].begin() + std::ptrdiff_t(u.y + j) * std::ptrdiff_t(side) + u.x);
    }
    uploaded += std::size_t(u.width) * u.height;
  };
  std::mt19937 random(9);
  Eigen::Vector2d place(1500.0, 1500.0);
  for (int move = 0; move < 500; ++move) {
    const double reach = move % 20 == 19 ? 900.0 : move % 4 == 3 ? 30.0 : 4.0;
    std::uniform_real_distribution<double> step(-reach, reach);
    place = (place + Eigen::Vector2d(step(random), step(random))).cwiseMax(0.0).cwiseMin(2999.0);
    ClipmapLevels::View where;
    where.place = place;
    where.height = 52.0;
    where.cellSize = 2.0;
    where.wait = 60.0;
    std::vector<std::optional<ClipmapWindow>> windows(levels.Count());
    if (move > 0) {
      for (int level = 0; level < levels.Count(); ++level) {
        windows[level] = levels.Window(level);
      }
    }
    uploaded = 0;
    const ClipmapLevels::State state = levels.Update(where, upload);
    ASSERT_TRUE(state.complete);
    std::size_t news = 0;
    ClipmapLevels fresh(pyramid, 28);
    fresh.Update(where, [](int, const ClipmapUpdate&, const ClipmapTexel*) {});
    for (int level = state.finest; level < levels.Count(); ++level) {
      const ClipmapWindow& window = levels.Window(level);
      ASSERT_EQ(window, fresh.Window(level));
      for (std::int64_t r = window.row - 1; r <= window.row + 29; ++r) {
        for (std::int64_t c = window.column - 1; c <= window.column + 29; ++c) {
          const std::size_t at = std::size_t(geometry.Texel(r)) * side + geometry.Texel(c);
          ASSERT_EQ(
              std::memcmp(&textures[level][at], &fresh.Texel(level, c, r), sizeof(ClipmapTexel)), 0)
              << "move " << move << ", level " << level << ", post " << c << ", " << r;
        }
      }
      const auto inside = [&](std::int64_t c, std::int64_t r) {
        return windows[level] && c >= windows[level]->column - 1 &&
               c <= windows[level]->column + 29 && r >= windows[level]->row - 1 &&
               r <= windows[level]->row + 29;
      };
      for (std::int64_t r = window.row - 1; r <= window.row + 29; ++r) {
        for (std::int64_t c = window.column - 1; c <= window.column + 29; ++c) {
          news += !inside(c, r);
        }
      }
    }
    ASSERT_EQ(uploaded, news) << "move " << move;
  }
}

// Bytes are counted at the OpenGL call, and the texture read back.
TEST_F(ClipmapFixture, WhatOpenGLHoldsIsWhatWasCounted) {
  AddPlane(4097, Hills, {-51, 51}, false);
  LookFrom({0, 0, 60}, {100, 40, 20});
  auto view = View(64, 48);
  Shoot(view);
  const std::uint64_t first = context->GetStatistics().textureBytesUploaded;
  LookFrom({0, 0, 60}, {90, 40, 20}); // turned only
  Shoot(view);
  EXPECT_EQ(context->GetStatistics().textureBytesUploaded, first);
  LookFrom({4 * Post, 0, 60}, {90, 40, 20}); // four posts on
  Shoot(view);
  const std::uint64_t moved = context->GetStatistics().textureBytesUploaded - first;
  // 4 columns of level 0, 2 to 4 of level 1, ...: of 127 rows, in the colour and the label picture.
  EXPECT_GE(moved, 2u * 127u * 4u * sizeof(ClipmapTexel));
  EXPECT_LE(moved, 2u * 127u * (4u + 4u + 2u * 6u) * sizeof(ClipmapTexel));
}

TEST_F(ClipmapFixture, ADeadlineIsAnErrorAndAnInteractivePictureIsNot) {
  posts = std::make_shared<FormulaPosts>(4097, 4097, false, [](double c, double r) {
    std::this_thread::sleep_for(std::chrono::microseconds(100)); // some seconds a tile
    return Hills(c, r);
  });
  ClipmapOptions options;
  options.heights = {-51, 51};
  options.deadline = 0.05;
  terrain = std::make_shared<ClipmapTerrain>(
      std::make_shared<ElevationPyramid>(posts),
      PostPlacement::OnPlane(Eigen::Affine2d(Eigen::Scaling(Post, -Post))), options);
  GraphicsObject ground;
  ground.name = "ground";
  ground.custom = terrain;
  scene->AddObject(ground);
  LookFrom({100, -100, 60}, {200, -140, 20});
  auto view = View(64, 48);
  view->ForceRender(); // what is there: nothing
  try {
    Shoot(view);
    FAIL() << "the picture was taken without its data";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::DeadlineExceeded) << error.what();
  }
}

// A ramp of greys: 0 to 255 over its range.
std::shared_ptr<const Image> Greys() {
  auto image = std::make_shared<Image>();
  image->name = "greys";
  image->width = 256;
  image->height = 1;
  image->channels = 3;
  for (int i = 0; i < 256; ++i) {
    image->pixels.insert(image->pixels.end(), 3, std::uint8_t(i));
  }
  return image;
}

// Seen from straight above, a pixel of 2 m: where each colour must be is plain arithmetic.
struct StyleFixture : ClipmapFixture {
  vtkSmartPointer<vtkDspaceViewport> view;
  static constexpr double Rise = 0.25; // of the ground, to the east

  void SetUp() override {
    ClipmapFixture::SetUp();
    AddPlane(
        1025, [](double c, double) { return Rise * Post * c; }, {0.0, 1025.0 * Rise * Post}, false);
    Camera camera;
    camera.name = "camera";
    camera.projection.kind = Projection::Kind::Orthographic;
    camera.projection.height = 200.0;
    camera.projection.nearDistance = 1.0;
    camera.projection.farDistance = 1e4;
    camera.mount.X_FC = LookAt("camera", {0, 0, 400}, {0, 0, 0}, {0, 1, 0});
    scene->SetCamera("main", camera);
    view = View(100, 100);
  }
  Capture With(const ClipmapStyle& style) {
    terrain->SetStyle(style);
    return view->GetCapture({});
  }
  // Of a pixel's centre: scene x, and the ground's height there.
  static double XOf(int x) { return 2.0 * (x + 0.5) - 100.0; }
  static double HeightOf(int x) { return Rise * (XOf(x) + 0.5 * Post * 1025); }
  static int Grey(const Capture& capture, int x, int y) {
    return capture.color[4 * (std::size_t(y) * capture.width + x)];
  }
};

TEST_F(StyleFixture, ARampByHeightShowsHeights) {
  ClipmapStyle style;
  style.ramp.emplace();
  style.ramp->image = Greys();
  style.ramp->range = {HeightOf(0) - 10.0, HeightOf(99) + 10.0};
  const Capture capture = With(style);
  Keep(capture, "ramp");
  for (int x = 0; x < 100; ++x) {
    const double at =
        (HeightOf(x) - style.ramp->range[0]) / (style.ramp->range[1] - style.ramp->range[0]);
    EXPECT_NEAR(Grey(capture, x, 50), 256.0 * at - 0.5, 1.5) << x;
  }
}

TEST_F(StyleFixture, ARampBySlopeShowsDegrees) {
  ClipmapStyle style;
  style.ramp.emplace();
  style.ramp->by = ClipmapStyle::Ramp::By::Slope;
  style.ramp->image = Greys();
  style.ramp->range = {0.0, 90.0};
  const Capture capture = With(style);
  const double degrees = std::atan(Rise) * 180.0 / M_PI;
  EXPECT_NEAR(Grey(capture, 20, 50), 256.0 * degrees / 90.0 - 0.5, 1.5);
  EXPECT_NEAR(Grey(capture, 77, 12), 256.0 * degrees / 90.0 - 0.5, 1.5);
  style.ramp->range = {0.0, 20.0};
  EXPECT_NEAR(Grey(With(style), 20, 50), 256.0 * degrees / 20.0 - 0.5, 1.5);
}

TEST_F(StyleFixture, ContoursAndGridLinesLieAtTheirValues) {
  ClipmapStyle style;
  style.contours.emplace();
  style.contours->interval = 10.0; // [m]: every 40 m of map, 20 pixels
  const Capture contours = With(style);
  Keep(contours, "contours");
  int lines = 0;
  for (int x = 0; x < 100; ++x) {
    const double away = std::abs(std::remainder(HeightOf(x), 10.0)) / Rise / 2.0; // pixels
    if (away < 0.3) {
      EXPECT_LT(Grey(contours, x, 30), 130) << x;
      ++lines;
    } else if (away > 1.2) {
      EXPECT_EQ(Grey(contours, x, 30), Grey(contours, 99, 99)) << x;
    }
  }
  EXPECT_GE(lines, 3);

  ClipmapStyle grid;
  grid.grid.emplace();
  grid.grid->interval = 50.0; // posts here: 100 m, 50 pixels
  grid.grid->color = {1, 0, 0};
  const Capture squares = With(grid);
  Keep(squares, "grid");
  const Eigen::Affine2d toPosts = terrain->Placement().PostToScene().inverse();
  int crossings = 0;
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) {
      const Eigen::Vector2d post = toPosts * Eigen::Vector2d(XOf(x), -XOf(y));
      const double away = std::min(std::abs(std::remainder(post.x(), 50.0)),
                                   std::abs(std::remainder(post.y(), 50.0))); // posts are pixels
      const std::size_t at = 4 * (std::size_t(y) * 100 + x);
      const bool red = squares.color[at] > 180 && squares.color[at + 1] < 140;
      if (away < 0.3) {
        EXPECT_TRUE(red) << x << ", " << y;
        ++crossings;
      } else if (away > 1.2) {
        EXPECT_FALSE(red) << x << ", " << y;
      }
    }
  }
  EXPECT_GT(crossings, 100);
}

TEST_F(StyleFixture, AStyleStacksGoesAndIsRefusedWhole) {
  const Capture plain = view->GetCapture({});
  ClipmapStyle style;
  style.ramp.emplace();
  style.ramp->image = Greys();
  style.ramp->range = {HeightOf(0), HeightOf(99)};
  style.ramp->opacity = 0.0; // seen through
  EXPECT_EQ(With(style).color, plain.color);
  style.levels = 1.0;
  EXPECT_NE(With(style).color, plain.color);
  EXPECT_EQ(With(ClipmapStyle()).color, plain.color);
  style.ramp->opacity = 1.5;
  EXPECT_THROW(terrain->SetStyle(style), Error);
  style.ramp->opacity = 0.5;
  style.contours.emplace();
  style.contours->interval = 0.0;
  EXPECT_THROW(terrain->SetStyle(style), Error);
  EXPECT_TRUE(terrain->Style().Empty());
}

// A body of rows from pole to pole whose first column is at the date line.
struct BodyFixture : ClipmapFixture {
  static constexpr double Radius = 1e6; // [m]
  static constexpr int Columns = 23040;
  static constexpr int Rows = Columns / 2 + 1;
  static constexpr double Step = 2.0 * M_PI / Columns; // [rad]

  static double Relief(double c, double r) {
    const double longitude = c * Step - M_PI;
    const double latitude = M_PI / 2 - r * Step;
    const double w = std::cos(latitude);
    return 2000.0 * w * w * std::sin(3.0 * longitude) * std::sin(5.0 * latitude) +
           30.0 * w * w * std::sin(900.0 * longitude) * std::sin(800.0 * latitude);
  }
  void SetUp() override {
    ClipmapFixture::SetUp();
    posts = std::make_shared<FormulaPosts>(Columns, Rows, true, Relief);
    Add(PostPlacement::OnSphere({-180.0, 90.0}, {360.0 / Columns, -360.0 / Columns}, Radius),
        {-2030.0, 2030.0}, false);
  }
  static Eigen::Vector3d Place(double longitude_deg, double latitude_deg, double height) {
    const double l = longitude_deg * M_PI / 180.0;
    const double p = latitude_deg * M_PI / 180.0;
    return (Radius + height) *
           Eigen::Vector3d(std::cos(p) * std::cos(l), std::cos(p) * std::sin(l), std::sin(p));
  }
  static Eigen::Vector2d PostOf(const Eigen::Vector3d& p) {
    return {(std::atan2(p.y(), p.x()) + M_PI) / Step,
            (M_PI / 2 - std::asin(p.z() / p.norm())) / Step};
  }
  // On the triangles between the posts, by their corners.
  static double OnTriangles(const Eigen::Vector2d& post) {
    const double c = std::floor(post.x());
    const double r = std::floor(post.y());
    const double u = post.x() - c;
    const double v = post.y() - r;
    const double a = Relief(c, r);
    const double d = Relief(c + 1, r + 1);
    return v > u ? a + v * (Relief(c, r + 1) - a) + u * (d - Relief(c, r + 1))
                 : a + u * (Relief(c + 1, r) - a) + v * (d - Relief(c + 1, r));
  }

  // From orbit to the ground in one flight: where a ray meets the ball below the lowest ground
  // there is ground, and beyond the ball above the highest there is none.
  void FlyDown(const Eigen::Vector2d& place) {
    auto view = View(160, 120);

    for (int step = 0; step < 40; ++step) {
      const double above = 1e7 * std::pow(3e-8, step / 39.0); // 1e7 to 0.3 m
      const Eigen::Vector3d ground = Place(place.x(), place.y(), 0.0);
      const double height = OnTriangles(PostOf(ground));
      const Eigen::Vector3d eye = Place(place.x(), place.y(), height + above);
      const Eigen::Vector3d up = eye.normalized();
      const Eigen::Vector3d east = Eigen::Vector3d::UnitZ().cross(up).normalized();
      const double tilt = above > 1e6 ? 0.1 : 0.8;
      LookFrom(eye, eye + tilt * east - up, 60.0, up);
      CaptureRequest request;
      request.label = true;
      const Capture capture = view->GetCapture(request);
      const Projection& projection = scene->Vantage("main").ActiveCamera().projection;
      const Pose X_FC = scene->PlaceCamera("main").X_FC;
      for (int y = 0; y < capture.height; ++y) {
        for (int x = 0; x < capture.width; ++x) {
          const Projection::Ray ray = projection.PixelRay(x, y, capture.width, capture.height);
          const Eigen::Vector3d d = (X_FC.rotation * ray.direction).normalized();
          const double nearest = (eye - eye.dot(d) * d).norm(); // of the line to the centre
          const bool forward = eye.dot(d) < 0.0;
          const bool hit = capture.label[std::size_t(y) * capture.width + x] != 0;
          if (forward && nearest < Radius - 2030.0 - 1e-3 * above) {
            if (!hit) {
              Keep(capture, "missorbit");
            }
            ASSERT_TRUE(hit) << place.transpose() << ", " << above << " m above, pixel " << x
                             << ", " << y;
          }
          if (nearest > Radius + 2030.0 + 1e-3 * above && eye.norm() > Radius + 2030.0) {
            ASSERT_FALSE(hit) << place.transpose() << ", " << above << " m above, pixel " << x
                              << ", " << y;
          }
        }
      }
    }
  }
};

TEST_F(BodyFixture, TheFinestRingIsTheStatedSurface) {
  auto view = View(160, 120);
  const ClipmapGeometry geometry(124);
  // Chords lie below the sphere by at most this; heights between posts are linear either way.
  const double chord = std::pow(Radius * Step, 2) / (8.0 * Radius) * 2.0;
  int compared = 0;
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(12.0, 3.0),
                                       {179.999, -20.0},
                                       {-180.0, 41.0},
                                       {77.0, 78.5},
                                       {-33.0, -60.0}}) {
    for (const double above : {0.3, 30.0, 2000.0}) {
      const Eigen::Vector3d ground = Place(place.x(), place.y(), 0.0);
      const double height = OnTriangles(PostOf(ground));
      const Eigen::Vector3d eye = Place(place.x(), place.y(), height + above);
      const Eigen::Vector3d up = eye.normalized();
      const Eigen::Vector3d east = Eigen::Vector3d::UnitZ().cross(up).normalized();
      LookFrom(eye, eye + east + 0.5 * up.cross(east) - 0.8 * up, 60.0, up);
      const Capture capture = Shoot(view);
      for (int y = 0; y < capture.height; ++y) {
        for (int x = 0; x < capture.width; ++x) {
          const Hit hit = HitAt(*scene, capture, x, y);
          if (!hit.hit && above >= 1.0) {
            Keep(capture, "miss");
          }
          ASSERT_TRUE(hit.hit || above < 1.0)
              << "pixel " << x << ", " << y << "place " << place.transpose() << " above " << above;
          if (!hit.hit) {
            continue;
          }
          const Eigen::Vector2d post = PostOf(hit.p);
          Eigen::Vector2d away = (post - PostOf(eye)).cwiseAbs();
          away.x() = std::min(away.x(), Columns - away.x());
          const double most = std::max(away.maxCoeff(), above / (Radius * Step));
          if (most > geometry.BlendFrom() - 1.0) {
            continue;
          }
          const double range = (hit.p - eye).norm();
          const double moved = std::sqrt(2.0) / 512.0 * 2.0 * std::tan(M_PI / 6.0) / 120.0 * range;
          ASSERT_NEAR(hit.p.norm() - Radius, OnTriangles(post),
                      1e-3 + 1e-6 * 4060.0 + chord + 1.5 * moved)
              << "place " << place.transpose() << " above " << above << ", range " << range;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 50000);
}

TEST_F(BodyFixture, NoGapOpensFromOrbitToTheGround) {
  FlyDown({180.0, 10.0}); // the date line
  FlyDown({20.0, 89.97});
  FlyDown({100.0, -45.0});
}

// With charts of its poles, as a terrain that is opened has them.
struct PoleFixture : BodyFixture {
  void SetUp() override {
    BodyFixture::SetUp();
    scene->RemoveObject(object);
    AddWithPoles(true);
  }
  void AddWithPoles(bool poles, std::shared_ptr<const Image> image = nullptr) {
    const PostPlacement placement = terrain->Placement();
    ClipmapOptions options = terrain->Options();
    if (image) {
      auto material = std::make_shared<Material>(*options.material);
      material->color = {1, 1, 1};
      material->texture = std::move(image);
      options.material = material;
      options.postToTexture.linear() << 1.0 / Columns, 0.0, 0.0, -1.0 / (Rows - 1);
      options.postToTexture.translation() << 0.0, 1.0;
    }
    std::vector<ClipmapChart> charts;
    for (const bool south : {false, true}) {
      const auto polar = std::make_shared<PolarPosts>(posts, placement, 0, south, CoarsestFor(124));
      charts.push_back({std::make_shared<ElevationPyramid>(polar), polar->Placement()});
    }
    terrain =
        std::make_shared<ClipmapTerrain>(std::make_shared<ElevationPyramid>(posts), placement,
                                         options, poles ? charts : std::vector<ClipmapChart>());
    GraphicsObject ground;
    ground.name = "body";
    ground.custom = terrain;
    object = scene->AddObject(ground);
  }
};

// Each post stands where the stereographic projection's textbook formulas put it, and has the
// height of the degree grid's triangles there.
TEST_F(PoleFixture, PolarPostsAreTheGridsAtTheirPlaces) {
  std::mt19937 random(17);
  for (const bool south : {false, true}) {
    const PolarPosts polar(posts, terrain->Placement(), 0, south, CoarsestFor(124));
    const PostLattice& lattice = polar.GetLattice();
    const double half = 0.5 * double(lattice.columns - 1);
    const double spacing = Radius * Step;
    for (int n = 0; n < 30; ++n) {
      PostBlock block;
      block.width = 40;
      block.height = 30;
      const double reach = n % 3 == 0 ? 60.0 : n % 3 == 1 ? 900.0 : half;
      block.column = std::int64_t(half + reach * (2.0 * (random() % 1000) / 999.0 - 1.0)) - 20;
      block.row = std::int64_t(half + reach * (2.0 * (random() % 1000) / 999.0 - 1.0)) - 15;
      std::vector<float> heights(40 * 30);
      polar.Read(block, heights.data());
      for (int i = 0; i < 40 * 30; ++i) {
        const double c = double(block.column + i % 40);
        const double r = double(block.row + i / 40);
        if (c < 0 || r < 0 || c >= double(lattice.columns) || r >= double(lattice.rows)) {
          EXPECT_TRUE(std::isnan(heights[i]));
          continue;
        }
        const double x = (c - half) * spacing; // [m] in the plane
        const double y = (half - r) * spacing;
        const double colatitude = 2.0 * std::atan2(std::hypot(x, y), 2.0 * Radius);
        const double longitude = std::atan2(south ? -y : y, x);
        const double row = (south ? M_PI - colatitude : colatitude) / Step;
        const double column = (longitude + M_PI) / Step;
        ASSERT_NEAR(heights[i], OnTriangles({column, std::min(row, Rows - 1.0 - 1e-9)}), 2e-3)
            << c << ", " << r << (south ? " south" : " north");
      }
    }
  }
}

TEST_F(PoleFixture, TheGroundAtThePolesIsTheStatedSurface) {
  auto view = View(160, 120);
  int compared = 0;
  for (const Eigen::Vector2d& place :
       {Eigen::Vector2d(0.0, 90.0), {33.0, 89.995}, {-170.0, -89.97}, {120.0, -90.0}}) {
    for (const double above : {2.0, 300.0}) {
      const double height = OnTriangles(PostOf(Place(place.x(), place.y() * (1.0 - 1e-12), 0.0)));
      const Eigen::Vector3d eye = Place(place.x(), place.y(), height + above);
      const Eigen::Vector3d up = eye.normalized();
      LookFrom(eye, eye + up.unitOrthogonal() - 0.6 * up, 60.0, up);
      const Capture capture = Shoot(view);
      for (int y = 0; y < capture.height; ++y) {
        for (int x = 0; x < capture.width; ++x) {
          const Hit hit = HitAt(*scene, capture, x, y);
          const double range = (hit.p - eye).norm();
          if (!hit.hit || range > 40.0 * Radius * Step) {
            continue;
          }
          // Here the relief bends by less than a centimetre from post to post.
          const double pixel = 2.0 * std::tan(M_PI / 6.0) / 120.0 * range;
          ASSERT_NEAR(hit.p.norm() - Radius, OnTriangles(PostOf(hit.p)),
                      0.02 + std::pow(Radius * Step, 2) / (4.0 * Radius) + pixel / 300.0)
              << place.transpose() << ", " << above << " m above, range " << range;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 60000);
}

TEST_F(PoleFixture, NoGapOpensAboveThePoles) {
  FlyDown({20.0, 89.97});
  FlyDown({-60.0, 61.0});
  FlyDown({140.0, -80.0});
}

// The same picture from the same place, through either chart.
TEST_F(PoleFixture, ImagesAndGridsLieAlikeOnBothCharts) {
  auto image = std::make_shared<Image>();
  image->name = "directions";
  image->width = 1024;
  image->height = 512;
  image->channels = 3;
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 1024; ++x) { // continuous around
      const double longitude = (x + 0.5) / 1024.0 * 2.0 * M_PI;
      image->pixels.push_back(std::uint8_t(127.5 + 120.0 * std::sin(longitude)));
      image->pixels.push_back(std::uint8_t(127.5 + 120.0 * std::cos(3.0 * longitude)));
      image->pixels.push_back(std::uint8_t(y / 2));
    }
  }
  ClipmapStyle style;
  style.grid.emplace();
  style.grid->interval = 15.0;
  style.grid->width = 3.0;
  auto view = View(320, 240);
  for (const Eigen::Vector2d& place : {Eigen::Vector2d(170.0, 66.0), {-20.0, -72.0}}) {
    const Eigen::Vector3d eye = Place(place.x(), place.y(), 6e5);
    LookFrom(eye, Place(place.x() + 5.0, place.y() * 1.1, 0.0), 60.0, Eigen::Vector3d::UnitZ());
    std::vector<Capture> captures;
    for (const bool poles : {true, false}) {
      scene->RemoveObject(object);
      AddWithPoles(poles, image);
      EXPECT_EQ(terrain->ChartAt(eye) != 0, poles);
      terrain->SetStyle(style);
      captures.push_back(Shoot(view));
      Keep(captures.back(), std::string(poles ? "poles" : "grid") + std::to_string(int(place.y())));
    }
    // A line may be drawn a pixel aside; within some degrees of the pole the degree grid's own
    // triangles are too coarse to be compared with.
    const auto alike = [&captures](int x, int y) {
      for (int j = std::max(y - 1, 0); j <= std::min(y + 1, 239); ++j) {
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, 319); ++i) {
          int most = 0;
          for (std::size_t k = 0; k < 3; ++k) {
            most = std::max(most, std::abs(captures[0].color[4 * (std::size_t(y) * 320 + x) + k] -
                                           captures[1].color[4 * (std::size_t(j) * 320 + i) + k]));
          }
          if (most <= 40) {
            return true;
          }
        }
      }
      return false;
    };
    std::size_t differ = 0;
    std::size_t ground = 0;
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) {
        const Hit hit = HitAt(*scene, captures[0], x, y);
        if (hit.hit && std::abs(hit.p.z()) / hit.p.norm() < std::sin(75.0 * M_PI / 180.0)) {
          ++ground;
          differ += !alike(x, y);
        }
      }
    }
    EXPECT_GT(ground, 20000u);
    EXPECT_LT(differ, ground / 200) << place.transpose();
  }
}

} // namespace
