// Streamed terrains on a plane: against GridTerrain, and what only they can be asked.
#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/surface/GridTerrain.h>
#include <dspace/surface/StreamedTerrain.h>

#include "RasterFile.h"
#include "TestData.h"

namespace {

using namespace dspace;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

double Hills(double c, double r) {
  return 80.0 * std::sin(0.031 * c) * std::cos(0.027 * r) + 9.0 * std::sin(0.21 * c + 0.17 * r) +
         1.5 * std::sin(0.9 * c) * std::sin(0.8 * r);
}

StreamedTerrainOptions Streamed(const GridTerrainOptions& options) {
  StreamedTerrainOptions streamed;
  streamed.elevation = options.elevation;
  streamed.origin = options.origin;
  streamed.originHeight = options.originHeight;
  return streamed;
}

// Everything that both can be asked, at random places in and around the data.
void ExpectSame(const std::string& path, const GridTerrainOptions& options = {}) {
  const auto grid = GridTerrain::Load(path, options);
  const auto streamed = StreamedTerrain::Open(path, Streamed(options));
  EXPECT_EQ(grid->GetWarnings(), streamed->GetWarnings());
  const TerrainBounds a = grid->GetBounds();
  const TerrainBounds b = streamed->GetBounds();
  const double size = a.scene.sizes().norm();
  EXPECT_TRUE(a.scene.isApprox(b.scene, 1e-9)) << path;
  EXPECT_TRUE(a.map.isApprox(b.map, 1e-9)) << path;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-0.05, 1.05);
  constexpr int Count = 3000;
  Rows3 points(Count, 3);
  Rows2 map(Count, 2);
  for (int i = 0; i < Count; ++i) {
    const Eigen::Vector3d share(unit(random), unit(random), unit(random));
    points.row(i) = a.scene.min() + share.cwiseProduct(a.scene.sizes());
    map.row(i) = streamed->SceneToMap(points.row(i)).head<2>();
  }
  Eigen::VectorXd heights(Count);
  Eigen::VectorXd heightsMap(Count);
  streamed->Heights(points, heights);
  streamed->HeightsMap(map, heightsMap);
  int valid = 0;
  for (int i = 0; i < Count; ++i) {
    const SurfaceSample s = grid->Sample(points.row(i));
    const SurfaceSample t = streamed->Sample(points.row(i));
    ASSERT_EQ(s.valid, t.valid) << path << " at " << points.row(i);
    ASSERT_EQ(std::isnan(heights[i]), !s.valid);
    if (!s.valid) {
      continue;
    }
    ++valid;
    // Floats of up to 8192 m are within 0.25 mm.
    EXPECT_NEAR(s.height, t.height, 1e-3);
    EXPECT_EQ(t.height, heights[i]);
    EXPECT_NEAR(heights[i], heightsMap[i], 1e-6);
    EXPECT_LT((s.position_S - t.position_S).norm(), 1e-3);
    EXPECT_LT((s.normal_S - t.normal_S).norm(), 1e-3);
    EXPECT_NEAR(s.slope_deg, t.slope_deg, 0.05);
    EXPECT_EQ(t.level, 0);
  }
  EXPECT_GT(valid, Count / 4) << path << " of size " << size;
  // At the very posts, on the rims of holes too.
  const HeightGrid& posts = grid->Grid();
  for (int r = 0; r < posts.GetRows(); r += 1 + posts.GetRows() / 200) {
    for (int c = 0; c < posts.GetColumns(); ++c) {
      const Eigen::Vector2d at = grid->PixelToMap() * Eigen::Vector2d(c + 0.5, r + 0.5);
      const SurfaceSample s = grid->SampleMap(at);
      const SurfaceSample t = streamed->SampleMap(at);
      ASSERT_EQ(s.valid, t.valid) << path << ": " << c << ", " << r;
      ASSERT_TRUE(!s.valid || std::abs(s.height - t.height) < 1e-3)
          << path << ": " << c << ", " << r;
    }
  }
  // Rays of all kinds: down, up from below, grazing, from far away and from within.
  int hits = 0;
  for (int i = 0; i < Count; ++i) {
    Eigen::Vector3d from = points.row(i);
    const Eigen::Vector3d to = points.row((i * 7 + 1) % Count);
    if (i % 3 == 0) {
      from.z() += (i % 2 == 0 ? 1.0 : -1.0) * size;
    }
    const double most = i % 5 == 0 ? 0.4 * size : std::numeric_limits<double>::infinity();
    const Eigen::Vector3d along =
        i % 17 == 0 ? Eigen::Vector3d(0, 0, i % 2 == 0 ? -1 : 1) : Eigen::Vector3d(to - from);
    const RayHit g = grid->Intersect(from, along, most);
    const RayHit h = streamed->Intersect(from, along, most);
    // Where the two surfaces, a rounding apart, are met at a grazing angle they may be told apart.
    const double steep = g.hit ? std::abs(g.normal_S.dot(along.normalized())) : 1.0;
    ASSERT_TRUE(g.hit == h.hit || steep < 1e-3) << path << " ray " << i;
    if (!g.hit || !h.hit || steep < 1e-3) {
      continue;
    }
    ++hits;
    EXPECT_NEAR(g.distance, h.distance, 1e-3 / steep) << path << " ray " << i;
    EXPECT_EQ(g.fromBelow, h.fromBelow);
    if (std::abs(g.distance - h.distance) < 1e-3) {
      EXPECT_LT((g.position_S - h.position_S).norm(), 1e-2);
    }
    // It lies on its own surface.
    const SurfaceSample s = streamed->Sample(h.position_S);
    if (s.valid) {
      EXPECT_NEAR(s.position_S.z(), h.position_S.z(), 1e-6 + 1e-12 * size);
    }
  }
  EXPECT_GT(hits, Count / 4) << path;
}

TEST(StreamedTerrain, OnAPlaneItIsTheGrid) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 411;
  file.height = 303;
  file.noData = -9999.0;
  file.geotransform = std::array<double, 6>{1000, 2, 0, 5000, 0, -2};
  file.value = [](int c, int r, int) {
    return (c - 200) * (c - 200) + (r - 90) * (r - 90) < 900 ? -9999.0 : Hills(c, r);
  };
  ExpectSame(file.Write(folder / "plain.tif"));
  file.geotransform = std::array<double, 6>{1000, 2, 0.6, 5000, 0.3, -1.5};
  ExpectSame(file.Write(folder / "sheared.tif"));
  file.geotransform = std::array<double, 6>{1000, 2, 0, 5000, 0, 2};
  GridTerrainOptions options;
  options.origin = Eigen::Vector2d(1100.0, 5200.0);
  options.originHeight = 250.0;
  ExpectSame(file.Write(folder / "south-up.tif"), options);
  options = {};
  file.geotransform = std::array<double, 6>{100, 1e-4, 0, -4, 0, -1e-4};
  file.crs = "+proj=longlat +R=3396190 +no_defs";
  ExpectSame(file.Write(folder / "degrees.tif"));
  file.width = 3;
  file.height = 2;
  ExpectSame(file.Write(folder / "small.tif"));
}

TEST(StreamedTerrain, RealDataOnAPlaneAreTheGrid) {
  for (const char* name :
       {"terrain/moon_npole_stereo_33.tif", "terrain/earth_california_ned_1arcsec_129.tif",
        "terrain/earth_sfbay_200x125.tif", "terrain/moon_ulcn2005_spole_250.cub",
        "terrain/mars_gale_mola_128ppd_m.tif"}) {
    DSPACE_REAL_DATA(path, name);
    ExpectSame(path);
  }
}

TEST(StreamedTerrain, ALargeRasterIsReadAsItIsAsked) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 2150;
  file.height = 1900;
  file.type = GDT_Float32;
  file.geotransform = std::array<double, 6>{0, 2, 0, 0, 0, -2};
  file.value = [](int c, int r, int) { return float(Hills(c, r)); };
  const std::string path = file.Write(folder / "large.tif");
  const auto streamed = StreamedTerrain::Open(path);
  EXPECT_FALSE(streamed->HeightRangeIsExact());
  EXPECT_LT(streamed->Pyramid()->Statistics().loads, 4u); // its coarsest level only
  EXPECT_NE(streamed->ResidentLevel({2000.0, -2000.0}), 0);
  streamed->SampleMap({2000.0, -2000.0});
  EXPECT_EQ(streamed->ResidentLevel({2000.0, -2000.0}), 0);
  EXPECT_EQ(streamed->ResidentLevel({-10.0, -2000.0}), -1);
  const auto grid = GridTerrain::Load(path);
  EXPECT_LT(streamed->HeightRange()[0], grid->Grid().GetMinimum());
  EXPECT_GT(streamed->HeightRange()[1], grid->Grid().GetMaximum());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(-1850.0, 1850.0);
  int hits = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d from(x(random), x(random), i % 2 == 0 ? 95.0 : 3e6);
    const Eigen::Vector3d to(x(random), x(random), -20.0);
    const RayHit a = grid->Intersect(from, to - from);
    const RayHit b = streamed->Intersect(from, to - from);
    ASSERT_EQ(a.hit, b.hit);
    if (a.hit) {
      ++hits;
      const double steep = std::abs(a.normal_S.dot((to - from).normalized()));
      EXPECT_NEAR(a.distance, b.distance, 1e-6 / std::max(1e-3, steep));
    }
    EXPECT_EQ(grid->Sample(to).height, streamed->Sample(to).height);
  }
  EXPECT_GT(hits, 300);
}

// Rounding may put such places to either side of an edge: none may be missed.
TEST(StreamedTerrain, RaysAimedAtEdgesMeetThem) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 300;
  file.height = 200;
  file.geotransform = std::array<double, 6>{0.1, 0.7, 0, 0.3, 0, -0.7};
  file.value = [](int c, int r, int) { return double(float(0.05 * Hills(c, r))); };
  const auto terrain = StreamedTerrain::Open(file.Write(folder / "edges.tif"));
  const Eigen::AlignedBox2d map = terrain->GetBounds().map;
  std::mt19937 random(5);
  std::uniform_int_distribution<int> column(10, 289);
  std::uniform_int_distribution<int> row(10, 189);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 20000; ++i) {
    Eigen::Vector2d g(column(random), row(random)); // a post
    if (i % 4 == 1) {
      g.x() += unit(random);
    } else if (i % 4 == 2) {
      g.y() += unit(random);
    } else if (i % 4 == 3) {
      g += Eigen::Vector2d::Constant(unit(random));
    }
    const Eigen::Vector2d at(map.min().x() + 0.7 * g.x(), map.max().y() - 0.7 * g.y());
    const Eigen::Vector3d to = terrain->SampleMap(at).position_S;
    const Eigen::Vector3d from =
        to + Eigen::Vector3d(3.0 * unit(random), 3.0 * unit(random), i % 2 == 0 ? 40.0 : -40.0);
    const RayHit hit = terrain->Intersect(from, to - from);
    ASSERT_TRUE(hit.hit) << i;
    ASSERT_LT(hit.distance, (to - from).norm() + 1e-6) << i;
    ASSERT_EQ(hit.fromBelow, i % 2 == 1) << i;
  }
}

TEST(StreamedTerrain, AnswersAreTheSameFromSeveralThreads) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 700;
  file.height = 600;
  file.geotransform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
  file.value = [](int c, int r, int) { return Hills(c, r); };
  StreamedTerrainOptions options;
  options.pyramid.byteBudget = std::size_t(4) << 20;
  const auto terrain = StreamedTerrain::Open(file.Write(folder / "threads.tif"), options);
  constexpr int Count = 2000;
  Rows3 points(Count, 3);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> x(-290.0, 290.0);
  for (int i = 0; i < Count; ++i) {
    points.row(i) << x(random), x(random), 120.0;
  }
  const Rows3 down = Eigen::RowVector3d(0.3, 0.1, -1.0).replicate(Count, 1);
  std::array<Eigen::VectorXd, 4> heights;
  std::array<Eigen::VectorXd, 4> distances;
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k) {
    heights[k].resize(Count);
    distances[k].resize(Count);
    threads.emplace_back([&, k] {
      terrain->Heights(points, heights[k]);
      terrain->Intersect(points, down, 1e4, distances[k]);
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_FALSE(heights[0].array().isNaN().any());
  for (int k = 1; k < 4; ++k) {
    EXPECT_EQ(heights[0], heights[k]);
    EXPECT_EQ(distances[0], distances[k]);
  }
}

// Azimuths of descent of a plane, by hand.
TEST(StreamedTerrain, AspectPointsDownhill) {
  const TemporaryFolder folder;
  const auto azimuthOf = [&](double east, double north) {
    RasterFile file;
    file.width = 9;
    file.height = 9;
    file.geotransform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
    file.value = [&](int c, int r, int) { return east * c - north * r; }; // rises so per metre
    const auto terrain = StreamedTerrain::Open(file.Write(folder / "plane.tif"));
    const Rows3 point = Rows3::Zero(1, 3);
    Eigen::VectorXd aspect(1);
    terrain->Aspects(point, aspect);
    return aspect[0];
  };
  EXPECT_NEAR(azimuthOf(0.0, -1.0), 0.0, 1e-9);
  EXPECT_NEAR(azimuthOf(-1.0, 0.0), 90.0, 1e-9);
  EXPECT_NEAR(azimuthOf(0.0, 1.0), 180.0, 1e-9);
  EXPECT_NEAR(azimuthOf(1.0, 0.0), 270.0, 1e-9);
  EXPECT_NEAR(azimuthOf(-0.5, -0.5), 45.0, 1e-9);
  EXPECT_TRUE(std::isnan(azimuthOf(0.0, 0.0)));
}

TEST(StreamedTerrain, RoughnessIsWhatIsLeftOfAPlane) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 120;
  file.height = 100;
  file.noData = -9999.0;
  file.geotransform = std::array<double, 6>{0, 2, 0, 0, 0, -2};
  // A plane, and half a metre up and down by turns.
  file.value = [](int c, int r, int) {
    return c < 20 ? -9999.0 : 0.3 * c - 0.2 * r + ((c + r) % 2 == 0 ? 0.5 : -0.5);
  };
  const auto terrain = StreamedTerrain::Open(file.Write(folder / "rough.tif"));
  Rows3 points(4, 3);
  points << 0, 0, 0, 1.0, 1.0, 7.0, -119.0, 0, 0, 500, 500, 0;
  Eigen::VectorXd roughness(4);
  terrain->Roughness(points, 31.0, roughness);
  EXPECT_NEAR(roughness[0], 0.5, 2e-3); // a plane takes next to nothing of a chessboard
  EXPECT_NEAR(roughness[1], 0.5, 2e-3);
  EXPECT_TRUE(std::isnan(roughness[2])); // most of it is a hole
  EXPECT_TRUE(std::isnan(roughness[3])); // outside
  // Five pixels about the middle one: residuals of 1, -1, -1, -1, -1 halves about their mean.
  const Rows3 pixel = Eigen::RowVector3d(1.0, 1.0, 0.0);
  Eigen::VectorXd one(1);
  terrain->Roughness(pixel, 2.5, one);
  EXPECT_NEAR(one[0], 0.4, 1e-6); // values 0.5 and four -0.5: mean -0.3, sqrt((0.64 + 4 0.04) / 5)
  terrain->Roughness(pixel, 1.5, one);
  EXPECT_TRUE(std::isnan(one[0])); // one pixel is no plane
  EXPECT_THROW(terrain->Roughness(pixel, 0.0, one), Error);
  EXPECT_THROW(terrain->Roughness(points, 1.0, one), Error);
}

TEST(StreamedTerrain, WhatIsAskedWronglyIsRejected) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 20;
  file.height = 20;
  file.geotransform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
  file.value = [](int, int, int) { return 1.0; };
  const std::string path = file.Write(folder / "flat.tif");
  StreamedTerrainOptions options;
  options.deadline = 0.0;
  EXPECT_THROW(StreamedTerrain::Open(path, options), Error);
  options = {};
  options.cells = 13;
  EXPECT_THROW(StreamedTerrain::Open(path, options), Error);
  EXPECT_THROW(StreamedTerrain::Open(folder / "none.tif"), Error);
  file.noData = 1.0;
  EXPECT_THROW(StreamedTerrain::Open(file.Write(folder / "empty.tif")), Error);
  file.noData = -1.0;
  file.value = [](int c, int, int) { return c == 3 ? 1e30 : 1.0; };
  EXPECT_THROW(StreamedTerrain::Open(file.Write(folder / "high.tif")), Error);
}

// One that is small is rejected; of one that is large not every pixel is looked at.
TEST(StreamedTerrain, ALargeRasterThatSeemsEmptyIsWarnedOf) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 2001;
  file.height = 2000;
  file.type = GDT_Byte;
  file.noData = 1.0;
  file.geotransform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
  for (const bool empty : {true, false}) {
    file.value = [empty](int c, int, int) { return empty || c < 1900 ? 1.0 : 7.0; };
    const auto warnings = StreamedTerrain::Open(file.Write(folder / "large.tif"))->GetWarnings();
    EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(),
                            [](const std::string& text) {
                              return text.find("2001 x 2000 pixels") != std::string::npos &&
                                     text.find("no data") != std::string::npos;
                            }),
              empty ? 1 : 0);
  }
}

} // namespace
