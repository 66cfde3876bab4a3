// Far shadows of terrain in pictures against exact rays to the Sun's disc.
#include <chrono>
#include <cmath>
#include <thread>

#include "ClipmapTestSupport.h"
#include "Globe.h"
#include "Grids.h"
#include "TestData.h"

#include <dspace/clipmap/PoleCharts.h>
#include <dspace/surface/StreamedTerrain.h>

using namespace dspace;
using namespace dspace::testing;

namespace {

constexpr int Width = 321;
constexpr int Height = 201;

double LinearOf(std::uint8_t value) {
  const double v = value / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// 100 points of equal shares of a disc of directions.
std::vector<Eigen::Vector3d> DiscAbout(const Eigen::Vector3d& toSun, double radius_deg) {
  const Eigen::Vector3d u = toSun.unitOrthogonal();
  const Eigen::Vector3d v = toSun.cross(u);
  std::vector<Eigen::Vector3d> directions;
  for (int k = 0; k < 100; ++k) {
    const double angle = 2.39996322972865332 * k;
    const double r = std::tan(radius_deg * Degree) * std::sqrt((k + 0.5) / 100.0);
    directions.push_back((toSun + r * (std::cos(angle) * u + std::sin(angle) * v)).normalized());
  }
  return directions;
}

struct HorizonFixture : ClipmapFixture {
  Eigen::Vector3d toSun = Eigen::Vector3d::UnitZ();
  vtkSmartPointer<vtkDspaceViewport> viewport;

  // All of the picture lies beyond the shadow maps, so that only horizons shade it.
  void ShowShadows(bool shown) {
    if (!this->viewport) {
      this->viewport = this->View(Width, Height);
    }
    ViewLook look;
    look.shadows.shown = shown;
    look.shadows.cascades = 1;
    look.shadows.size = 256;
    look.shadows.distance = 0.01;
    this->viewport->SetLook(look);
  }
  void SetSun(const Eigen::Vector3d& direction, double radius_deg = 0.2666) {
    this->toSun = direction.normalized();
    Light sun;
    sun.name = SunName;
    sun.direction = -this->toSun;
    sun.radius_deg = radius_deg;
    this->scene->SetLight(sun);
  }
  static Eigen::Vector3d Towards(double azimuth_deg, double elevation_deg) {
    const double a = azimuth_deg * Degree;
    const double e = elevation_deg * Degree;
    return {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
  }

  struct Outcome {
    int pixels = 0;
    int wrong = 0; // by more than 0.25
    int away = 0;  // pixels with no shadow's edge within `reach`
    int awayWrong = 0;
    int shaded = 0;     // by rays, less than a tenth is lit
    int lit = 0;        // more than nine tenths
    double clear = 0.0; // mean difference away from edges
  };
  // The lit fraction of pixels (with shadows over without) against rays from what they show.
  // `lift` [m]: of a ray's start over the ground. `reach` [m]: two posts of what is drawn.
  Outcome Compare(const TerrainSurface& judge, double lift, double reach, int stride,
                  const std::string& name, double radius_deg = 0.2666) {
    this->ShowShadows(true);
    const Capture shadowed = Shoot(this->viewport);
    Keep(shadowed, name);
    this->ShowShadows(false);
    const Capture plain = Shoot(this->viewport);
    const std::vector<Eigen::Vector3d> disc = DiscAbout(this->toSun, radius_deg);
    Outcome outcome;
    for (int y = 1; y < Height; y += stride) {
      for (int x = 1; x < Width; x += stride) {
        const Hit hit = HitAt(*this->scene, plain, x, y);
        const std::size_t at = (std::size_t(y) * Width + x) * 4;
        const double all = LinearOf(plain.color[at]);
        if (!hit.hit || all < 0.02) { // turned away: nothing can be told
          continue;
        }
        const double drawn = LinearOf(shadowed.color[at]) / all;
        // Where levels blend, what is drawn is not the judge's ground: its own is above or below.
        const auto litAt = [&](const Eigen::Vector3d& place, int every) {
          const SurfaceSample sample = judge.Sample(place);
          if (!sample.valid) {
            return -1.0;
          }
          int rays = 0;
          int seen = 0;
          for (std::size_t k = 0; k < disc.size(); k += std::size_t(every)) {
            ++rays;
            seen += !judge.Intersect(sample.position_S + lift * sample.normal_S, disc[k]).hit;
          }
          return double(seen) / rays;
        };
        const double exact = litAt(hit.p, 1);
        if (exact < 0.0) {
          continue;
        }
        bool edge = false;
        const Eigen::Vector3d up = judge.Up(hit.p);
        const Eigen::Vector3d u = up.unitOrthogonal();
        for (int k = 0; k < 16 && !edge; ++k) {
          const double turn = 0.125 * M_PI * k;
          const Eigen::Vector3d beside = (k % 2 == 0 ? reach : 0.5 * reach) *
                                         (std::cos(turn) * u + std::sin(turn) * up.cross(u));
          edge = std::abs(litAt(hit.p + beside, 25) - exact) > 0.25;
        }
        const bool wrong = std::abs(drawn - exact) > 0.25;
        ++outcome.pixels;
        outcome.wrong += wrong;
        outcome.shaded += exact < 0.1;
        outcome.lit += exact > 0.9;
        if (!edge) {
          ++outcome.away;
          outcome.awayWrong += wrong;
          outcome.clear += std::abs(drawn - exact);
        }
      }
    }
    outcome.clear /= std::max(outcome.away, 1);
    std::printf(
        "%s: %d pixels, %d shaded, %d lit, %d wrong; %d away from edges, of which %d wrong, "
        "%.5f in the mean\n",
        name.c_str(), outcome.pixels, outcome.shaded, outcome.lit, outcome.wrong, outcome.away,
        outcome.awayWrong, outcome.clear);
    return outcome;
  }
};

using ClipmapHorizon = HorizonFixture;

// Hills with detail down to two posts, looked at from above so that the finest level shows.
TEST_F(ClipmapHorizon, HillsAreShadedAsByRays) {
  constexpr int Side = 1025;
  AddPlane(Side, Hills, {-60.0, 60.0});
  const auto judge = Sampled(
      Side, Side, NorthUp(-0.5 * Post * Side - 0.5 * Post, 0.5 * Post * Side + 0.5 * Post, Post),
      [](const Eigen::Vector2d& map) {
        return double(float(
            Hills((map.x() + 0.5 * Post * Side) / Post, (0.5 * Post * Side - map.y()) / Post)));
      });
  // The judge's scene has its origin in the middle of its data.
  const Eigen::Vector3d origin = judge->MapToScene({0.0, 0.0, 0.0});
  ASSERT_LT(origin.norm(), 2.0 * Post) << origin.transpose();
  for (const double elevation : {4.0, 9.0, 20.0}) {
    for (const double azimuth : {30.0, 90.0, 211.3}) {
      SetSun(Towards(azimuth, elevation));
      LookFrom({3.0, -4.0, 110.0}, {30.0, 60.0, 0.0});
      const Outcome outcome =
          Compare(*judge, 1e-3, 4.0 * Post, 7,
                  "hills-" + std::to_string(int(azimuth)) + "-" + std::to_string(int(elevation)));
      EXPECT_GT(outcome.pixels, 250);
      EXPECT_LE(outcome.awayWrong, 0.005 * outcome.pixels);
      EXPECT_LT(outcome.clear, 0.01);
    }
  }
}

TEST_F(ClipmapHorizon, NothingIsSweptWhileNothingMovesAndLittleWhileTheSunCreeps) {
  AddPlane(1025, Hills, {-60.0, 60.0});
  SetSun(Towards(40.1, 9.0));
  LookFrom({3.0, -4.0, 110.0}, {30.0, 60.0, 0.0});
  ShowShadows(true);
  Shoot(viewport);
  const std::shared_ptr<HorizonBlocks> blocks = terrain->Horizons(0);
  const std::uint64_t full = blocks->Sweeps();
  EXPECT_GT(full, 100u);
  const Capture before = Shoot(viewport);
  EXPECT_EQ(Shoot(viewport).color, before.color);
  EXPECT_EQ(blocks->Sweeps(), full);
  for (int i = 1; i <= 10; ++i) { // to 40.2 degrees: between the same azimuths
    SetSun(Towards(40.1 + 0.01 * i, 9.0 + 0.005 * i));
    Shoot(viewport);
  }
  EXPECT_EQ(blocks->Sweeps(), full);
  SetSun(Towards(40.26, 9.0)); // one of the two is new
  Shoot(viewport);
  EXPECT_EQ(blocks->Sweeps(), full + full / 2);
  // The picture depends on where the Sun is, not on how it came there.
  SetSun(Towards(40.1, 9.0));
  EXPECT_EQ(Shoot(viewport).color, before.color);
}

TEST_F(ClipmapHorizon, AnInteractivePictureDoesNotWaitAndComesToTheSame) {
  AddPlane(1025, Hills, {-60.0, 60.0});
  SetSun(Towards(40.1, 9.0));
  LookFrom({3.0, -4.0, 110.0}, {30.0, 60.0, 0.0});
  ShowShadows(true);
  Shoot(viewport);
  const std::shared_ptr<HorizonBlocks> blocks = terrain->Horizons(0);
  const std::uint64_t full = blocks->Sweeps();
  SetSun(Towards(130.1, 9.0));
  std::uint64_t revision = terrain->Revision();
  viewport->ForceRender();
  EXPECT_LT(blocks->Sweeps(), 2 * full); // it has not waited for all of them
  // The next azimuth on the Sun's way is swept, too: half as much again.
  for (int i = 0; i < 3000 && blocks->Sweeps() < 2 * full + full / 2; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    viewport->ForceRender();
  }
  EXPECT_NE(terrain->Revision(), revision); // viewports draw it again
  EXPECT_EQ(blocks->Sweeps(), 2 * full + full / 2);
  const Capture now = Shoot(viewport); // nothing is missing
  EXPECT_EQ(blocks->Sweeps(), 2 * full + full / 2);
  SetSun(Towards(40.1, 9.0));
  Shoot(viewport);
  SetSun(Towards(130.1, 9.0));
  EXPECT_EQ(Shoot(viewport).color, now.color);
}

// At night the ground is black, and that is drawn.
TEST_F(ClipmapHorizon, NightIsDrawn) {
  AddPlane(513, Hills, {-60.0, 60.0});
  LookFrom({3.0, -4.0, 110.0}, {30.0, 60.0, 0.0});
  for (const double elevation : {-2.0, -60.0}) {
    SetSun(Towards(100.0, elevation));
    ShowShadows(true);
    const Capture night = Shoot(viewport);
    int lit = 0;
    for (std::size_t i = 0; i < night.color.size() / 4; ++i) {
      lit += std::isfinite(night.depth[i]) && night.color[4 * i] > 0;
    }
    EXPECT_EQ(lit, 0);
  }
}

// A whole body, across the date line and around a pole, whose charts have verticals of their own.
TEST_F(ClipmapHorizon, ABodyIsShadedAsByRays) {
  const TemporaryFolder folder;
  Globe globe;
  globe.width = 1440;
  globe.radius = 1737400.0;
  globe.height = [](double lon, double lat) {
    const double x = lon * Degree;
    const double y = lat * Degree;
    return Bulges(lon, lat) +
           std::cos(y) * (2500.0 * std::sin(80.0 * x + 3.0 * std::sin(20.0 * y)) +
                          900.0 * std::cos(200.0 * y) * std::sin(200.0 * x));
  };
  StreamedTerrainOptions onBody;
  onBody.onBody = true;
  const auto surface = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), onBody);
  ClipmapOptions options;
  options.heights = {-10000.0, 10000.0};
  auto material = std::make_shared<Material>();
  material->color = {0.8, 0.8, 0.8};
  material->roughness = 1.0;
  options.material = material;
  GraphicsObject ground;
  ground.name = "ground";
  ground.custom = std::make_shared<ClipmapTerrain>(surface->Pyramid(), surface->Placement(),
                                                   options, PoleChartsOf(*surface, 124));
  scene->AddObject(ground);
  struct View {
    double lon, lat, above;
    const char* name;
  };
  int shaded = 0;
  for (const View& view : {View{179.9, 20.0, 60e3, "date-line"}, View{30.0, 88.5, 60e3, "pole"},
                           View{-70.0, -50.0, 20e3, "south"}}) {
    const Eigen::Vector3d up = Direction(view.lon, view.lat);
    const Eigen::Vector3d north = (Eigen::Vector3d::UnitZ() - up.z() * up).normalized();
    const Eigen::Vector3d east = north.cross(up);
    const Eigen::Vector3d local = Towards(75.0, 4.0);
    SetSun(local.x() * east + local.y() * north + local.z() * up);
    LookFrom((globe.radius + view.above) * up,
             (globe.radius + 0.0) * (up + 0.02 * north).normalized(), 50.0, north);
    const Outcome outcome = Compare(*surface, 0.5, 4e3, 13, view.name);
    EXPECT_GT(outcome.pixels, 100);
    shaded += outcome.shaded;
    EXPECT_LE(outcome.awayWrong, 0.005 * outcome.pixels) << view.name;
    EXPECT_LT(outcome.clear, 0.01) << view.name;
  }
  EXPECT_GT(shaded, 40);
}

TEST_F(ClipmapHorizon, Apollo15IsShadedAsByRays) {
  DSPACE_REAL_DATA(path, "terrain/moon_apollo15_nac_dtm_257.png");
  StreamedTerrainOptions streamed;
  streamed.elevation.pixelSize = 2.0;
  streamed.elevation.verticalScale = 49.0 / 255.0;
  streamed.elevation.verticalOffset = 0.0;
  streamed.elevation.verticalDatum = VerticalDatum::FromText("relative");
  const auto surface = StreamedTerrain::Open(path, streamed);
  ClipmapOptions options;
  options.heights = surface->HeightRange();
  auto material = std::make_shared<Material>();
  material->color = {0.8, 0.8, 0.8};
  material->roughness = 1.0;
  options.material = material;
  GraphicsObject ground;
  ground.name = "ground";
  ground.custom =
      std::make_shared<ClipmapTerrain>(surface->Pyramid(), surface->Placement(), options);
  scene->AddObject(ground);
  const double floor = surface->Sample({0.0, 0.0, 0.0}).height;
  for (const double azimuth : {95.0, 262.0}) {
    SetSun(Towards(azimuth, 4.0));
    LookFrom({-10.0, -60.0, floor + 90.0}, {10.0, 30.0, floor});
    const Outcome outcome =
        Compare(*surface, 1e-3, 8.0, 7, "apollo15-" + std::to_string(int(azimuth)));
    EXPECT_GT(outcome.pixels, 250);
    EXPECT_LE(outcome.awayWrong, 0.005 * outcome.pixels);
    EXPECT_LT(outcome.clear, 0.01);
  }
}

} // namespace
