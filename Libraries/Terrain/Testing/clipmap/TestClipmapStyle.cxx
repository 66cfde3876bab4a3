// What a style lays over a clipmap, by plain arithmetic.

#include "ClipmapTestSupport.h"

namespace dspace::testing {
namespace {

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

// A level's colour ends, to the pixel, where the level has turned into the next coarser one.
TEST_F(StyleFixture, ColoursOfLevelsEndWhereTheirBlendingDoes) {
  ClipmapStyle style;
  style.levels = 1.0;
  terrain->SetStyle(style);
  // A wide lens sees several levels from above.
  const Eigen::Vector3d eye(7.3, -4.1, HeightOf(50) + 90.0);
  LookFrom(eye, {eye.x(), eye.y(), 0.0}, 160.0, Eigen::Vector3d::UnitY());
  view->Resize(300, 300);
  view->SetSamples(1);
  const Capture capture = Shoot(view);
  Keep(capture, "levels");
  // The six hues, linear light: which one a pixel has.
  const double hues[6][3] = {{0.8, 0.1, 0.1},  {0.9, 0.6, 0.05}, {0.35, 0.7, 0.1},
                             {0.05, 0.6, 0.6}, {0.1, 0.2, 0.8},  {0.6, 0.1, 0.6}};
  const auto srgb = [](double v) { return 255.0 * (1.055 * std::pow(v, 1 / 2.4) - 0.055); };
  const auto hue = [&](int x, int y) {
    for (int k = 0; k < 6; ++k) {
      double away = 0.0;
      for (int i = 0; i < 3; ++i) {
        away = std::max(
            away, std::abs(capture.color[4 * (std::size_t(y) * 300 + x) + i] - srgb(hues[k][i])));
      }
      if (away < 2.0) {
        return k;
      }
    }
    return -1;
  };
  const double edge = ClipmapGeometry(124).BlendTo();
  const double above = (eye.z() - Rise * (eye.x() + 0.5 * Post * 1025)) / Post; // posts
  std::array<int, 6> seen = {};
  for (int y = 0; y < 300; ++y) {
    for (int x = 0; x < 300; ++x) {
      const Hit hit = HitAt(*scene, capture, x, y);
      if (!hit.hit || hit.p.head<2>().cwiseAbs().maxCoeff() > 1000.0) {
        continue;
      }
      const double away = (hit.p - eye).head<2>().cwiseAbs().maxCoeff() / Post;
      const double level = std::max(std::ceil(std::log2(std::max(away, above) / edge)), 0.0);
      // Positions are floats and a pixel's depth: nothing else may move the border.
      const double nearest = edge * std::exp2(std::round(std::log2(std::max(away, above) / edge)));
      if (std::abs(std::max(away, above) - nearest) < 0.003 * nearest) {
        continue;
      }
      ASSERT_EQ(hue(x, y), int(level)) << x << ", " << y << ": " << away << " posts away";
      ++seen[std::size_t(level)];
    }
  }
  EXPECT_GT(seen[0], 500);
  EXPECT_GT(seen[1], 500);
  EXPECT_GT(seen[2], 500);
}

// Texels of 20 m, ten pixels.
TEST_F(StyleFixture, DetailsTileTheMapWhereTheyAreWanted) {
  auto image = std::make_shared<Image>();
  image->name = "four greys";
  image->width = image->height = 2;
  image->channels = 1;
  image->pixels = {60, 200, 120, 250}; // the top row first
  const auto linear = [](double v) {
    v /= 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  double mean = 0.0;
  for (const std::uint8_t v : image->pixels) {
    mean += 0.25 * linear(v);
  }
  ClipmapStyle style;
  style.details.resize(1);
  style.details[0].image = image;
  style.details[0].size = 40.0;
  style.details[0].opacity = 1.0;
  const Capture plain = view->GetCapture({});
  const Capture capture = With(style);
  Keep(capture, "details");
  for (int y = 0; y < 100; ++y) {
    for (int x = 0; x < 100; ++x) {
      // In texels from the middle of one, of the tile whose corner is the scene's origin; row 0 of
      // an image is its top. Between the middles of texels their values are mixed.
      const double u = XOf(x) / 20.0 - 0.5;
      const double v = -XOf(y) / 20.0 - 0.5;
      double structure = 0.0;
      for (const int j : {0, 1}) {
        for (const int i : {0, 1}) {
          const int column = (int(std::floor(u)) + i) & 1;
          const int row = 1 - ((int(std::floor(v)) + j) & 1);
          structure += (i ? u - std::floor(u) : 1.0 - u + std::floor(u)) *
                       (j ? v - std::floor(v) : 1.0 - v + std::floor(v)) *
                       linear(image->pixels[2 * row + column]);
        }
      }
      const double expected = std::min(linear(Grey(plain, x, y)) * structure / mean, 1.0);
      ASSERT_NEAR(linear(Grey(capture, x, y)), expected, 0.012) << x << ", " << y;
    }
  }

  const double degrees = std::atan(Rise) * 180.0 / M_PI;
  style.details[0].slopes = {degrees + 5.0, 90.0}; // steeper than all of it
  EXPECT_EQ(With(style).color, plain.color);
  style.details[0].slopes = {degrees - 5.0, degrees + 5.0};
  EXPECT_EQ(With(style).color, capture.color);
  style.details[0].heights = {HeightOf(50), HeightOf(50) + 1e4}; // the eastern half, softly
  style.details[0].heights[1] = HeightOf(50) + 100.0;
  const Capture half = With(style);
  for (int y = 0; y < 100; ++y) {
    EXPECT_EQ(Grey(half, 20, y), Grey(plain, 20, y));
    EXPECT_EQ(Grey(half, 80, y), Grey(capture, 80, y));
  }
  style.details.resize(3, style.details[0]);
  EXPECT_THROW(terrain->SetStyle(style), Error);
}

// Each image goes up with the first picture that shows it: none may push another aside.
TEST_F(StyleFixture, TheFirstPictureOfAStyleIsAsTheNext) {
  const auto grey = [](std::uint8_t value) {
    auto image = std::make_shared<Image>();
    image->name = "grey";
    image->width = image->height = 2;
    image->channels = 1;
    image->pixels = {value, 255, 255, value};
    return image;
  };
  ClipmapStyle style;
  style.details.resize(2);
  style.details[0].image = grey(40);
  style.details[1].image = grey(90);
  style.ramp.emplace();
  style.ramp->image = Greys();
  style.ramp->range = {HeightOf(0), HeightOf(99)};
  style.ramp->opacity = 0.3;
  const Capture first = With(style);
  view->Invalidate();
  EXPECT_EQ(view->GetCapture({}).color, first.color);
}

// A terrain that is removed is forgotten with the next picture: tiles, threads, textures and all.
TEST_F(StyleFixture, ATerrainThatIsRemovedIsLetGo) {
  CaptureRequest request;
  request.label = true;
  view->GetCapture(request);
  const std::weak_ptr<ClipmapTerrain> watch = terrain;
  const std::weak_ptr<ElevationPyramid> tiles = terrain->Pyramid();
  terrain.reset();
  scene->RemoveObject(object);
  view->GetCapture(request);
  EXPECT_TRUE(watch.expired());
  EXPECT_TRUE(tiles.expired());
}

TEST_F(StyleFixture, AStyleStacksGoesAndIsRejectedWhole) {
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

} // namespace
} // namespace dspace::testing
