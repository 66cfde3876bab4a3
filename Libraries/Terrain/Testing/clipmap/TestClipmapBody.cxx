// Clipmaps around a body: from orbit to the ground, the date line, the poles.
#include <random>

#include <TestData.h>

#include <dspace/clipmap/PoleCharts.h>
#include <dspace/posts/PolarPosts.h>
#include <dspace/surface/StreamedTerrain.h>

#include "ClipmapTestSupport.h"

namespace dspace::testing {
namespace {

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

// Nothing of the other chart is there yet: the one that the camera comes from goes on.
TEST_F(PoleFixture, ChartsHandOverWithoutAnEmptyPicture) {
  auto view = View(64, 48);
  const auto lookFrom = [&](double latitude) {
    LookFrom(Place(40.0, latitude, 5e4), Place(40.0, latitude + 0.5, 0.0), 60.0,
             Place(40.0, latitude, 0.0).normalized());
  };
  lookFrom(59.9);
  view->GetCapture({});
  lookFrom(60.1);
  view->ForceRender(); // an interactive picture: it does not wait
  EXPECT_GT(context->GetStatistics().trianglesDrawn, 1000u);
  const Capture complete = view->GetCapture({});
  view->Invalidate();
  EXPECT_EQ(view->GetCapture({}).color, complete.color);
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

// Whole bodies from real data, in hundreds of small steps: across the date line, over a pole, and
// across the parallel where one chart takes over from another.
struct RealBodyFixture : ClipmapFixture {
  double radius = 0.0;
  std::shared_ptr<const StreamedTerrain> surface;

  void Open(const std::string& path, const ElevationOptions& elevation) {
    StreamedTerrainOptions options;
    options.elevation = elevation;
    options.onBody = true;
    surface = StreamedTerrain::Open(path, options);
    radius = surface->Placement().Radius();
    ClipmapOptions look;
    look.heights = surface->HeightRange();
    auto material = std::make_shared<Material>();
    material->lit = false;
    look.material = material;
    GraphicsObject ground;
    ground.name = "body";
    ground.custom = std::make_shared<ClipmapTerrain>(surface->Pyramid(), surface->Placement(), look,
                                                     PoleChartsOf(*surface, look.cells));
    scene->AddObject(ground);
  }
  Eigen::Vector3d Place(const Eigen::Vector2d& degrees, double height) const {
    const double l = degrees.x() * M_PI / 180.0;
    const double p = degrees.y() * M_PI / 180.0;
    return (radius + height) *
           Eigen::Vector3d(std::cos(p) * std::cos(l), std::cos(p) * std::sin(l), std::sin(p));
  }
  // From one place towards another, `above` metres over the ground.
  void Fly(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double above, int steps) {
    auto view = View(96, 72);
    view->SetBackground({1, 0, 0}, {1, 0, 0});
    const Eigen::Vector3d a = Place(from, 0.0).normalized();
    const Eigen::Vector3d b = Place(to, 0.0).normalized();
    const double least = radius + surface->HeightRange()[0];
    for (int step = 0; step <= steps; ++step) {
      const Eigen::Vector3d up = (a + (b - a) * step / steps).normalized();
      const double ground = surface->Sample(radius * up).height;
      const Eigen::Vector3d eye = (radius + ground + above) * up;
      LookFrom(eye, eye + (b - a).normalized() - 0.7 * up, 70.0, up);
      const Capture capture = view->GetCapture({});
      const Projection& projection = scene->Vantage("main").ActiveCamera().projection;
      const Pose X_FC = scene->PlaceCamera("main").X_FC;
      for (int y = 0; y < capture.height; ++y) {
        for (int x = 0; x < capture.width; ++x) {
          const Projection::Ray ray = projection.PixelRay(x, y, capture.width, capture.height);
          const Eigen::Vector3d d = (X_FC.rotation * ray.direction).normalized();
          // Rays into the ball below all ground, half a degree under its rim.
          const double nearest = (eye - eye.dot(d) * d).norm();
          if (eye.dot(d) < 0.0 && nearest < least - 0.009 * eye.norm()) {
            const std::size_t at = 4 * (std::size_t(y) * capture.width + x);
            ASSERT_FALSE(capture.color[at] == 255 && capture.color[at + 1] == 0)
                << "step " << step << " of " << from.transpose() << " to " << to.transpose()
                << ", pixel " << x << ", " << y;
          }
        }
      }
    }
  }
};

TEST_F(RealBodyFixture, NoGapOpensOnFlightsOverTheMoon) {
  DSPACE_REAL_DATA(path, "terrain/moon_lola_global_4ppd_km.tif");
  ElevationOptions elevation;
  elevation.verticalScale = 1000.0;
  elevation.crs = "IAU_2015:30100";
  elevation.verticalDatum = VerticalDatum::FromText("sphere:1737400");
  Open(path, elevation);
  Fly({178.0, 12.0}, {-178.0, 14.0}, 3e3, 80);  // the date line
  Fly({20.0, -88.0}, {-150.0, -88.5}, 8e3, 80); // the south pole
  Fly({70.0, 59.0}, {75.0, 61.0}, 20e3, 60);    // from one chart to the next
}

TEST_F(RealBodyFixture, NoGapOpensOnFlightsOverMars) {
  DSPACE_REAL_DATA(path, "terrain/mars_mola_megt90n000cb_4ppd_m.tif");
  ElevationOptions elevation;
  elevation.verticalDatum = VerticalDatum::FromText("sphere:3396190");
  Open(path, elevation);
  Fly({-2.0, -14.0}, {3.0, -12.0}, 5e3, 60);    // its grid's edge is at longitude 0
  Fly({-70.0, -12.0}, {-60.0, -14.0}, 2e3, 80); // Valles Marineris
  Fly({100.0, 87.0}, {-80.0, 88.0}, 2e5, 60);
}

} // namespace
} // namespace dspace::testing
