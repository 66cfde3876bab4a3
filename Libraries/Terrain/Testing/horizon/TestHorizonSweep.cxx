// Horizons against closed forms and exact rays, on made ground.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/posts/PolarPosts.h>

#include "FormulaPosts.h"
#include "Globe.h"
#include "HorizonTestSupport.h"
#include "TemporaryFolder.h"

namespace {

using namespace dspace;
using namespace dspace::testing;

constexpr double MoonRadius = 1737400.0;

// North-up square posts `size` metres apart.
PostPlacement Plane(double size) {
  Eigen::Affine2d map = Eigen::Affine2d::Identity();
  map.linear() << size, 0.0, 0.0, -size;
  return PostPlacement::OnPlane(map);
}

HorizonSweep SweepOf(std::int64_t side, double size, FormulaPosts::Formula formula,
                     std::array<double, 2> heights, int near = 16) {
  HorizonOptions options;
  options.heights = heights;
  options.near = near;
  return {std::make_shared<ElevationPyramid>(
              std::make_shared<FormulaPosts>(side, side, false, std::move(formula))),
          Plane(size), options};
}

// A scarp 20 m high along a column: its crest is seen at its distance in every azimuth.
TEST(HorizonSweep, AScarpsCrestStandsAtItsDistance) {
  const auto scarp = [](double c, double) { return c >= 200.0 ? 20.0 : 0.0; };
  const HorizonSweep sweep = SweepOf(401, 2.0, scarp, {0.0, 20.0});
  for (const double azimuth : {90.0, 45.0, 120.25, 61.0, 140.0}) {
    std::vector<float> all(37 * 5);
    std::vector<float> distant(all.size());
    sweep.Sweep({0, 150, 198, 37, 5}, azimuth, all.data(), distant.data());
    for (int i = 0; i < 37; ++i) {
      const double away = 2.0 * (200.0 - (150.0 + i)) / std::sin(azimuth * ToRadians);
      for (int j = 0; j < 5; ++j) {
        EXPECT_NEAR(all[std::size_t(j) * 37 + i], 20.0 / away, 1e-5 * 20.0 / away)
            << azimuth << " at " << i;
        // Beyond 16 posts only: the crest, or the plateau where an edge next crosses the way.
        const float far = distant[std::size_t(j) * 37 + i];
        EXPECT_LE(far, 20.0 / std::max(away, 32.0) * 1.00001) << azimuth << " at " << i;
        EXPECT_GE(far, 20.0 / std::max(away, 34.9) * 0.99999) << azimuth << " at " << i;
      }
    }
    // Away from it there is level ground, and at last none.
    float back = 0.0f;
    float far = 0.0f;
    sweep.Sweep({0, 150, 200, 1, 1}, azimuth + 180.0, &back, &far);
    EXPECT_NEAR(back, 0.0, 1e-6);
    EXPECT_NEAR(far, 0.0, 1e-6);
    sweep.Sweep({0, 0, 200, 1, 1}, 270.0, &back, &far);
    EXPECT_EQ(back, HorizonSweep::None);
    EXPECT_EQ(far, HorizonSweep::None);
  }
}

// A cone's own side has the slope of its line of ascent; its top is seen from afar.
TEST(HorizonSweep, AConeIsSeenAtItsAngle) {
  const auto cone = [](double c, double r) {
    return std::max(0.0, 60.0 - 0.5 * std::hypot(c - 512.0, r - 512.0));
  };
  const HorizonSweep sweep = SweepOf(1025, 1.0, cone, {0.0, 60.0});
  std::mt19937 random(3);
  std::uniform_int_distribution<int> place(0, 1024);
  for (int i = 0; i < 300; ++i) {
    const int c = place(random);
    const int r = place(random);
    const double east = 512.0 - c;
    const double north = r - 512.0;
    const double away = std::hypot(east, north);
    if (away < 20.0) {
      continue;
    }
    // Towards its axis; the apex is a post, met up to a millionth of a post.
    const double azimuth = std::atan2(east, north) / ToRadians;
    const double expected = std::atan2(60.0 - cone(c, r), away) / ToRadians;
    // Beyond 256 posts the coarser posts (here of the same formula) are looked at every half post.
    EXPECT_NEAR(SweptHorizon(sweep, 0, c, r, azimuth).first, expected, away < 250.0 ? 2e-3 : 0.12)
        << c << ", " << r;
  }
}

// On a smooth sphere every post sees the horizon dip to its own plane, or below it from a height.
TEST(HorizonSweep, ASpheresHorizonDips) {
  const TemporaryFolder folder;
  Globe globe;
  globe.width = 360;
  globe.radius = MoonRadius;
  globe.height = [](double, double) { return 500.0; };
  StreamedTerrainOptions onBody;
  onBody.onBody = true;
  const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), onBody);
  HorizonOptions options;
  options.heights = {400.0, 600.0};
  const HorizonSweep sweep(terrain->Pyramid(), terrain->Placement(), options);
  const PostLattice& lattice = terrain->Pyramid()->Lattice();
  std::mt19937 random(3);
  for (const int level : {0, 4, lattice.levels - 2}) {
    std::uniform_int_distribution<std::int64_t> column(0, lattice.ColumnsAt(level) - 1);
    std::uniform_int_distribution<std::int64_t> row(0, lattice.RowsAt(level) - 1);
    for (int i = 0; i < 20; ++i) {
      // The next edge, at most a diagonal away, is seen at the dip of half its angle.
      const auto [all, distant] = SweptHorizon(sweep, level, column(random), row(random),
                                               std::uniform_real_distribution<>(0, 360)(random));
      const double post =
          std::ldexp(terrain->Placement().CellSize({0.0, lattice.rows / 2.0}), level);
      EXPECT_LE(all, 1e-4);
      EXPECT_GE(all, -0.71 * post / MoonRadius / ToRadians - 1e-4);
      EXPECT_LE(distant, -7.9 * post / MoonRadius / ToRadians + 1e-4);
    }
  }
}

// A summit of 10.8 km is seen over the curvature 194 km away and no farther.
TEST(HorizonSweep, ALunarSummitIsSeenOverTheCurvature) {
  const TemporaryFolder folder;
  Globe globe;
  globe.width = 1440; // 7.6 km a pixel
  globe.radius = MoonRadius;
  const double lon = 10.125;
  const double lat = 30.125; // a pixel's centre
  globe.height = [&](double x, double y) {
    return std::abs(x - lon) < 0.01 && std::abs(y - lat) < 0.01 ? 10800.0 : 0.0;
  };
  StreamedTerrainOptions onBody;
  onBody.onBody = true;
  const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), onBody);
  HorizonOptions options;
  options.heights = {0.0, 10800.0};
  const PostPlacement& placement = terrain->Placement();
  const HorizonSweep sweep(terrain->Pyramid(), placement, options);
  const double reach = std::acos(MoonRadius / (MoonRadius + 10800.0)) * MoonRadius;
  EXPECT_NEAR(reach, 194e3, 1e3);
  const Eigen::Vector2d summit =
      (Eigen::Vector2d(lon, lat) * ToRadians - placement.First()).cwiseQuotient(placement.Step());
  for (int a = 0; a < 360; a += 30) {
    for (const double away : {60e3, 120e3, 180e3, 205e3}) {
      // From a post about there towards the summit, along the great circle between them.
      const Eigen::Vector2d post = HorizonPath(placement, summit, a).At(away).post.array().round();
      const Eigen::Vector3d top = placement.ToScene(summit, 10800.0);
      const Eigen::Vector3d eye = placement.ToScene(post, 0.0);
      const ChartDirection towards = ChartDirectionAt(placement, post, top - eye);
      const double swept = SweptHorizon(sweep, 0, std::int64_t(post.x()), std::int64_t(post.y()),
                                        towards.azimuth_deg)
                               .first;
      if (away < reach) {
        // Means blunt the pyramid of slope 1.4 by some 70 m.
        EXPECT_LE(swept, towards.elevation_deg + 1e-3) << a << " " << away;
        EXPECT_GE(swept, towards.elevation_deg - 0.13) << a << " " << away;
      } else {
        EXPECT_LE(swept, 1e-3);
      }
    }
  }
}

// Hills of all wavelengths from two posts on; a level's posts are means.
struct RoughPlane {
  TemporaryFolder folder;
  std::shared_ptr<StreamedTerrain> terrain;
  std::vector<float> heights;
  int side;

  RoughPlane(int width, double pixel, double steepness, double holes) : side(width) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    struct Wave {
      double x, y, phase, height;
    };
    std::vector<Wave> waves;
    for (double length = 3.0; length < width; length *= 1.3) {
      for (int k = 0; k < 3; ++k) {
        const double turn = 2.0 * M_PI * unit(random);
        waves.push_back({2.0 * M_PI / length * std::cos(turn), 2.0 * M_PI / length * std::sin(turn),
                         7.0 * unit(random), steepness * pixel * length / 40.0});
      }
    }
    this->heights.resize(std::size_t(width) * width);
    for (int r = 0; r < width; ++r) {
      for (int c = 0; c < width; ++c) {
        double h = 100.0;
        for (const Wave& w : waves) {
          h += w.height * std::sin(w.x * c + w.y * r + w.phase);
        }
        this->heights[std::size_t(r) * width + c] = unit(random) < holes ? -9999.0f : float(h);
      }
    }
    RasterFile file;
    file.width = file.height = width;
    file.type = GDT_Float32;
    file.noData = -9999.0;
    file.geotransform = std::array<double, 6>{0, pixel, 0, 0, 0, -pixel};
    file.value = [this](int c, int r, int) {
      return double(this->heights[std::size_t(r) * this->side + c]);
    };
    this->terrain = StreamedTerrain::Open(file.Write(this->folder / "rough.tif"));
  }
};

struct Errors {
  std::vector<double> all;
  double At(double share) {
    std::sort(this->all.begin(), this->all.end());
    return this->all[std::size_t(share * double(this->all.size() - 1))];
  }
  double Mean() const {
    double sum = 0.0;
    for (const double e : this->all) {
      sum += e / double(this->all.size());
    }
    return sum;
  }
};

TEST(HorizonSweep, WithinItsLevelItIsThatOfExactRays) {
  RoughPlane rough(256, 2.0, 1.0, 0.0); // all of it within 256 posts but for corners
  HorizonOptions options;
  options.heights = rough.terrain->HeightRange();
  options.posts = 512;
  const HorizonSweep sweep(rough.terrain->Pyramid(), rough.terrain->Placement(), options);
  std::mt19937 random(5);
  std::uniform_int_distribution<int> place(0, 255);
  std::uniform_real_distribution<double> turn(0.0, 360.0);
  for (int i = 0; i < 600; ++i) {
    const int c = i % 20 == 0 ? 255 : place(random); // edges, too
    const int r = i % 30 == 0 ? 0 : place(random);
    const double azimuth = i % 5 == 0 ? 45.0 * (i / 5 % 8) : turn(random);
    const double exact = ExactHorizon(*rough.terrain, {double(c), double(r)},
                                      rough.heights[std::size_t(r) * 256 + c], azimuth);
    // 0.1 mm of lift over the first crossing, up to a post away; float heights.
    EXPECT_NEAR(SweptHorizon(sweep, 0, c, r, azimuth).first, exact, 0.02)
        << c << ", " << r << " to " << azimuth;
  }
}

TEST(HorizonSweep, AcrossLevelsItIsThatOfExactRaysWithinTheBound) {
  RoughPlane rough(2048, 2.0, 0.3, 0.0); // slopes of 16 degrees in the mean
  HorizonOptions options;
  options.heights = rough.terrain->HeightRange();
  const HorizonSweep sweep(rough.terrain->Pyramid(), rough.terrain->Placement(), options);
  std::mt19937 random(5);
  std::uniform_int_distribution<int> place(0, 2047);
  std::uniform_real_distribution<double> turn(0.0, 360.0);
  Errors errors;
  for (int i = 0; i < 500; ++i) {
    const int c = place(random);
    const int r = place(random);
    const double azimuth = turn(random);
    const double exact = ExactHorizon(*rough.terrain, {double(c), double(r)},
                                      rough.heights[std::size_t(r) * 2048 + c], azimuth);
    errors.all.push_back(std::abs(SweptHorizon(sweep, 0, c, r, azimuth).first - exact));
  }
  std::printf("levels: mean %.5f, 99 %% %.4f, most %.4f deg\n", errors.Mean(), errors.At(0.99),
              errors.At(1.0));
  EXPECT_LT(errors.Mean(), 0.01);
  EXPECT_LT(errors.At(0.99), 0.05); // a tenth of the Sun's disc
  EXPECT_LT(errors.At(1.0), 0.2);
}

// Distant ground is what is left when the near zone is cut out of the raster: triangles go with any
// of their posts, hence a little more or a little less than the zone.
TEST(HorizonSweep, DistantGroundIsWhatIsLeftWithoutTheNearZone) {
  const RoughPlane rough(128, 2.0, 1.0, 0.0);
  HorizonOptions options;
  options.heights = rough.terrain->HeightRange();
  const HorizonSweep sweep(rough.terrain->Pyramid(), rough.terrain->Placement(), options);
  const TemporaryFolder folder;
  std::mt19937 random(6);
  std::uniform_int_distribution<int> place(30, 97);
  std::uniform_real_distribution<double> turn(0.0, 360.0);
  int nearer = 0;
  for (int i = 0; i < 12; ++i) {
    const int c = place(random);
    const int r = place(random);
    std::array<std::shared_ptr<StreamedTerrain>, 2> cut; // by more than 16 posts, by less
    for (int k = 0; k < 2; ++k) {
      RasterFile file;
      file.width = file.height = 128;
      file.type = GDT_Float32;
      file.noData = -9999.0;
      file.geotransform = std::array<double, 6>{0, 2, 0, 0, 0, -2};
      file.value = [&](int x, int y, int) {
        return std::hypot(x - c, y - r) < (k == 0 ? 16.0 : 14.5)
                   ? -9999.0
                   : double(rough.heights[std::size_t(y) * 128 + x]);
      };
      cut[std::size_t(k)] = StreamedTerrain::Open(
          file.Write(folder / ("cut" + std::to_string(i) + std::to_string(k) + ".tif")));
    }
    for (int j = 0; j < 10; ++j) {
      const double azimuth = turn(random);
      const double height = rough.heights[std::size_t(r) * 128 + c];
      const auto [all, distant] = SweptHorizon(sweep, 0, c, r, azimuth);
      EXPECT_GE(distant, ExactHorizon(*cut[0], {double(c), double(r)}, height, azimuth) - 1e-3);
      EXPECT_LE(distant, ExactHorizon(*cut[1], {double(c), double(r)}, height, azimuth) + 1e-3);
      nearer += distant < all - 0.1;
    }
  }
  EXPECT_GT(nearer, 60); // the near zone matters
}

TEST(HorizonSweep, HolesAreNoOccludersAndHaveNoHorizon) {
  RoughPlane rough(200, 2.0, 1.0, 0.05);
  HorizonOptions options;
  options.heights = rough.terrain->HeightRange();
  const HorizonSweep sweep(rough.terrain->Pyramid(), rough.terrain->Placement(), options);
  std::mt19937 random(5);
  std::uniform_int_distribution<int> place(0, 199);
  std::uniform_real_distribution<double> turn(0.0, 360.0);
  int holes = 0;
  int differ = 0;
  for (int i = 0; i < 500; ++i) {
    const int c = place(random);
    const int r = place(random);
    const double azimuth = turn(random);
    const float h = rough.heights[std::size_t(r) * 200 + c];
    const auto [all, distant] = SweptHorizon(sweep, 0, c, r, azimuth);
    if (h == -9999.0f) {
      ++holes;
      EXPECT_TRUE(std::isnan(all));
      EXPECT_TRUE(std::isnan(distant));
      continue;
    }
    const double exact = ExactHorizon(*rough.terrain, {double(c), double(r)}, h, azimuth);
    EXPECT_LE(distant, all);
    // An edge between two holes is one of no triangle and still counts; rays slip under it.
    differ += std::abs(all - exact) > 0.02;
  }
  EXPECT_GT(holes, 10);
  EXPECT_LE(differ, 5);
}

// Any block of posts has what each post has alone, also where blocks are cut, at ends of levels.
TEST(HorizonSweep, ABlockIsItsPosts) {
  RoughPlane rough(300, 2.0, 1.0, 0.01);
  HorizonOptions options;
  options.heights = rough.terrain->HeightRange();
  options.posts = 64;
  const HorizonSweep sweep(rough.terrain->Pyramid(), rough.terrain->Placement(), options);
  const PostLattice& lattice = rough.terrain->Pyramid()->Lattice();
  for (const int level : {0, 1}) {
    const int columns = int(lattice.ColumnsAt(level));
    const PostBlock block{level, columns - 40, -3, 45, 39};
    for (const double azimuth : {0.0, 90.0, 200.5, 333.25}) {
      std::vector<float> all(std::size_t(block.width) * block.height);
      std::vector<float> distant(all.size());
      std::vector<float> alone(all.size());
      sweep.Sweep(block, azimuth, all.data(), distant.data());
      sweep.Sweep(block, azimuth, alone.data(), nullptr);
      for (int j = 0; j < block.height; j += 7) {
        for (int i = 0; i < block.width; i += 3) {
          const std::size_t at = std::size_t(j) * block.width + i;
          float one = 0.0f, far = 0.0f;
          sweep.Sweep({level, block.column + i, block.row + j, 1, 1}, azimuth, &one, &far);
          if (std::isnan(one)) {
            EXPECT_TRUE(std::isnan(all[at])) << i << ", " << j;
            continue;
          }
          EXPECT_NEAR(all[at], one, 1e-5 * (1.0 + std::abs(one))) << i << ", " << j;
          EXPECT_NEAR(distant[at], far, 1e-5 * (1.0 + std::abs(far))) << i << ", " << j;
          EXPECT_EQ(all[at], alone[at]) << i << ", " << j;
        }
      }
      EXPECT_TRUE(std::isnan(all[0])); // above the lattice
      EXPECT_TRUE(std::isnan(all.back()));
    }
  }
}

Globe RoughGlobe() {
  Globe globe;
  globe.width = 1440;
  globe.radius = MoonRadius;
  globe.height = [](double lon, double lat) {
    const double x = lon * Degree;
    const double y = lat * Degree;
    return Bulges(lon, lat) + std::cos(y) * (700.0 * std::sin(80.0 * x + 3.0 * std::sin(20.0 * y)) +
                                             250.0 * std::cos(200.0 * y) * std::sin(200.0 * x));
  };
  return globe;
}

// The chart of a pole: its posts lie on the body's surface, its triangles nearly so.
TEST(HorizonSweep, InAPolesChartItIsThatOfExactRays) {
  const TemporaryFolder folder;
  StreamedTerrainOptions onBody;
  onBody.onBody = true;
  const auto terrain =
      StreamedTerrain::Open(RoughGlobe().File().Write(folder / "globe.tif"), onBody);
  HorizonOptions options;
  options.heights = {-8000.0, 8000.0};
  for (const bool south : {false, true}) {
    const PostLattice& grid = terrain->Pyramid()->Lattice();
    int complete = terrain->FullLevel();
    while (complete < grid.levels - 1 && grid.ColumnsAt(complete) > 65536) {
      ++complete;
    }
    const auto posts = std::make_shared<PolarPosts>(terrain->BarePosts(), terrain->Placement(),
                                                    complete, south, 60);
    const PostPlacement& placement = posts->Placement();
    const HorizonSweep sweep(std::make_shared<ElevationPyramid>(posts), placement, options);
    std::mt19937 random(8);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    Errors errors;
    for (int i = 0; i < 60; ++i) {
      const double away = 0.25 * unit(random) / placement.PlaneStep(); // to 28 degrees
      const double turn = 2.0 * M_PI * unit(random);
      const Eigen::Vector2d post =
          (placement.Pole() +
           (i == 0 ? 0.0 : away) * Eigen::Vector2d(std::cos(turn), std::sin(turn)))
              .array()
              .round();
      const double azimuth = 360.0 * unit(random);
      float height = 0.0f;
      posts->Read({0, std::int64_t(post.x()), std::int64_t(post.y()), 1, 1}, &height);
      const double exact = ExactHorizon(*terrain, post, double(height), azimuth, 0.05, &placement);
      errors.all.push_back(std::abs(
          SweptHorizon(sweep, 0, std::int64_t(post.x()), std::int64_t(post.y()), azimuth).first -
          exact));
    }
    std::printf("chart: mean %.5f, 95 %% %.4f, most %.4f deg\n", errors.Mean(), errors.At(0.95),
                errors.At(1.0));
    EXPECT_LT(errors.Mean(), 0.02);
    EXPECT_LT(errors.At(0.95), 0.05);
  }
}

// Bulges of kilometres on a globe: across the date line and at the poles, against exact rays.
TEST(HorizonSweep, OnABodyItIsThatOfExactRays) {
  const TemporaryFolder folder;
  const Globe globe = RoughGlobe();
  StreamedTerrainOptions onBody;
  onBody.onBody = true;
  const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), onBody);
  HorizonOptions options;
  options.heights = {-8000.0, 8000.0};
  const HorizonSweep sweep(terrain->Pyramid(), terrain->Placement(), options);
  const PostLattice& lattice = terrain->Pyramid()->Lattice();
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Errors errors;
  Errors polar;
  for (int i = 0; i < 400; ++i) {
    const bool pole = i % 4 == 0;
    const auto c = i % 3 == 0 ? std::int64_t(unit(random) * 20.0) // about the date line
                              : std::int64_t(unit(random) * double(lattice.columns));
    auto r = std::int64_t(unit(random) * double(lattice.rows));
    if (pole) { // from 4 to 0.2 degrees; nearer ones have columns of the size of floats' steps
      r = std::int64_t((0.05 + 0.95 * unit(random)) * double(lattice.rows) / 45.0);
      r = i % 8 == 0 ? lattice.rows - 1 - r : r;
    }
    const double azimuth = 360.0 * unit(random);
    float height = 0.0f;
    terrain->Pyramid()->Read({0, c, r, 1, 1}, &height);
    // The lift may see a centimetre farther: posts are some 59 m apart.
    const double exact =
        ExactHorizon(*terrain, {double(c), double(r)}, double(height), azimuth, 1e-3);
    const double error = std::abs(SweptHorizon(sweep, 0, c, r, azimuth).first - exact);
    (pole ? polar : errors).all.push_back(error);
  }
  std::printf(
      "body: mean %.5f, 99 %% %.4f, most %.4f deg; poles: mean %.5f, 99 %% %.4f, most %.4f\n",
      errors.Mean(), errors.At(0.99), errors.At(1.0), polar.Mean(), polar.At(0.99), polar.At(1.0));
  EXPECT_LT(errors.Mean(), 0.01);
  EXPECT_LT(errors.At(1.0), 0.1);
  EXPECT_LT(polar.Mean(), 0.02);
  EXPECT_LT(polar.At(1.0), 0.13);
}

// Every third post has the horizon that it has among its neighbours, whether the ground is read or
// held in memory.
TEST(HorizonSweep, PostsApartAreSweptAsNeighboursAre) {
  constexpr int Every = 3;
  constexpr int Width = 37;
  constexpr int Height = 5;
  HorizonSweep sweep = SweepOf(301, 2.0,
                               [](double c, double r) {
                                 return 12.0 * std::sin(0.31 * c) * std::cos(0.23 * r) +
                                        3.0 * std::sin(1.7 * c + 0.9 * r);
                               },
                               {-15.0, 15.0});
  const std::vector<double> azimuths = {0.0, 37.0, 90.0, 200.5, 285.0};
  std::vector<std::vector<float>> read;
  for (const double azimuth : azimuths) {
    std::vector<float> neighbours(std::size_t(Width * Every) * (Height * Every));
    sweep.Sweep({0, 100, 140, Width * Every, Height * Every}, azimuth, neighbours.data(), nullptr);
    read.emplace_back(std::size_t(Width) * Height);
    sweep.SweepEvery({0, 100, 140, Width, Height}, Every, azimuth, read.back().data());
    for (int j = 0; j < Height; ++j) {
      for (int i = 0; i < Width; ++i) {
        EXPECT_NEAR(read.back()[std::size_t(j * Width + i)],
                    neighbours[std::size_t((j * Width * Every + i) * Every)], 1e-5)
            << azimuth << " at " << i << ", " << j;
      }
    }
  }
  sweep.Hold(HeldPosts::Read(*sweep.Pyramid(), Every, HorizonLanes * Every, {}));
  for (std::size_t k = 0; k < azimuths.size(); ++k) {
    std::vector<float> held(read[k].size());
    sweep.SweepEvery({0, 100, 140, Width, Height}, Every, azimuths[k], held.data());
    for (std::size_t i = 0; i < held.size(); ++i) {
      EXPECT_NEAR(held[i], read[k][i], 1e-6) << azimuths[k] << " at " << i;
    }
  }
}

TEST(HorizonSweep, RejectsWhatIsNotAccepted) {
  const auto flat = [](double, double) { return 0.0; };
  const auto make = [&](int near, int posts, double low) {
    HorizonOptions options;
    options.near = near;
    options.posts = posts;
    options.heights = {low, 1.0};
    return HorizonSweep(
        std::make_shared<ElevationPyramid>(std::make_shared<FormulaPosts>(200, 200, false, flat)),
        Plane(1.0), options);
  };
  EXPECT_THROW(make(0, 256, 0.0), Error);
  EXPECT_THROW(make(129, 256, 0.0), Error);
  EXPECT_THROW(make(16, 100, 0.0), Error);
  EXPECT_THROW(make(16, 32, 0.0), Error);
  EXPECT_THROW(make(16, 256, 2.0), Error);
  EXPECT_THROW(make(16, 256, std::nan("")), Error);
  const HorizonSweep sweep = make(16, 256, 0.0);
  float out = 7.0f;
  EXPECT_THROW(sweep.Sweep({0, 0, 0, 1, 1}, std::nan(""), &out, nullptr), Error);
  EXPECT_THROW(sweep.Sweep({0, 0, 0, 0, 1}, 0.0, &out, nullptr), Error);
  EXPECT_THROW(sweep.Sweep({99, 0, 0, 1, 1}, 0.0, &out, nullptr), Error);
  EXPECT_THROW(sweep.SweepEvery({0, 0, 0, 1, 1}, 0, 0.0, &out), Error);
  EXPECT_THROW(sweep.SweepEvery({0, 0, 0, 1, 1}, 65, 0.0, &out), Error);
  EXPECT_THROW(sweep.SweepEvery({1, 0, 0, 1, 1}, 2, 0.0, &out), Error);
  EXPECT_EQ(out, 7.0f);
}

} // namespace
