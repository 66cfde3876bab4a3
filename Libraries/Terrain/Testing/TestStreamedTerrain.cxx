// Streamed terrains: on a plane against GridTerrain, on a body against closed forms.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/terrain/GridTerrain.h>
#include <dspace/terrain/StreamedTerrain.h>

#include "RasterFile.h"
#include "TestData.h"

namespace {

using namespace dspace;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

constexpr double Degree = M_PI / 180.0;

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

} // namespace
