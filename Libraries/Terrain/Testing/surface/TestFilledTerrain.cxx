// Terrains with filled holes: under patches, while overviews come, before wheels, and without end.
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <dspace/raster/OverviewBuild.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Globe.h"

namespace {

using namespace dspace;
using dspace::testing::Globe;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

constexpr double Missing = -9999.0;
constexpr double All = std::numeric_limits<double>::infinity();

// Pixels of 1 m from (0, 0) to (side, -side), none of them in a square in the middle.
RasterFile Holed(int side, int hole, std::function<double(int c, int r)> height) {
  RasterFile file;
  file.width = file.height = side;
  file.type = GDT_Float32;
  file.noData = Missing;
  file.unit = "m";
  file.verticalDatum = "sphere";
  file.geotransform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
  file.crs = "+proj=eqc +R=1737400 +type=crs";
  file.value = [=](int c, int r, int) {
    const int first = (side - hole) / 2;
    const bool none = std::min(c, r) >= first && std::max(c, r) < first + hole;
    return none ? Missing : height(c, r);
  };
  return file;
}

Rows3 Scattered(int count, double half, int seed) {
  Rows3 points(count, 3);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-half, half);
  for (int i = 0; i < count; ++i) {
    points.row(i) << unit(random), unit(random), 0.0;
  }
  return points;
}

// The base is at 100 m, and so is what is made up of it; the patch, over a half of the hole and
// ground to either side, at 0 m. Whatever is told to be no fill is one or, over ground, a blend.
TEST(FilledTerrain, APatchIsNotMixedWithWhatIsMadeUp) {
  const TemporaryFolder folder;
  const double middle = 0.5 * 121;
  const double half = 0.5 * 40;                // of the hole
  const double edge = 60.0 - 3 * 0.5 - middle; // within which the patch counts
  const std::string path =
      Holed(121, 40, [](int, int) { return 100.0; }).Write(folder / "base.tif");
  RasterFile over = Holed(120, 0, [](int, int) { return 0.0; }); // to x = 60, y = -30 to -90
  over.geotransform = std::array<double, 6>{0, 0.5, 0, -30, 0, -0.5};
  StreamedTerrainOptions options;
  options.origin = Eigen::Vector2d(middle, -middle);
  options.fillHoles = All;
  TerrainPatch patch;
  patch.path = over.Write(folder / "patch.tif");
  patch.margin = 20.0;
  options.patches = {patch};
  const auto terrain = StreamedTerrain::Open(path, options);
  ASSERT_TRUE(terrain->Group()->patches[0].used);
  constexpr int Count = 20000;
  const Rows3 points = Scattered(Count, 55.0, 3);
  Eigen::VectorXd heights(Count);
  Eigen::VectorXd filled(Count);
  terrain->Heights(points, heights);
  terrain->Filled(points, filled);
  int alone = 0;
  int made = 0;
  int blended = 0;
  for (int i = 0; i < Count; ++i) {
    const double within = points.row(i).head<2>().cwiseAbs().maxCoeff();
    if (within < half - 1.0) {
      if (filled[i] == 0.0 || points(i, 0) < edge - 1.0 || points(i, 0) > edge + 1.0) {
        ASSERT_NEAR(heights[i], filled[i] == 1.0 ? 100.0 : 0.0, 1e-3) << points.row(i);
      }
      ++(filled[i] == 1.0 ? made : alone);
    } else if (within > half + 1.0) {
      ASSERT_EQ(filled[i], 0.0);
      blended += heights[i] > 1.0 && heights[i] < 99.0;
    }
  }
  EXPECT_GT(alone, 500);
  EXPECT_GT(made, 500);
  EXPECT_GT(blended, 500);
}

// Columns by turns 0 and 90 m: overviews have 45 m where every n-th pixel is one of the two.
TEST(FilledTerrain, OverviewsThatComeChangeNothing) {
  const TemporaryFolder folder;
  StreamedTerrainOptions options;
  options.fillHoles = All;
  const std::string path =
      Holed(2304, 700, [](int c, int) { return c % 2 ? 90.0 : 0.0; }).Write(folder / "stripes.tif");
  const auto posts = [](const StreamedTerrain& of) { // of the levels that overviews would change
    std::vector<float> all;
    const PostLattice& lattice = of.Pyramid()->Lattice();
    for (int level = 4; level < lattice.levels; ++level) {
      const PostBlock block{level, 0, 0, int(lattice.ColumnsAt(level)), int(lattice.RowsAt(level))};
      std::vector<float> heights(std::size_t(block.width) * block.height);
      of.Pyramid()->Read(block, heights.data());
      all.insert(all.end(), heights.begin(), heights.end());
    }
    return all;
  };
  const std::vector<float> without = posts(*StreamedTerrain::Open(path, options));
  ASSERT_FALSE(without.empty());
  options.elevation.overviewCache = folder / "cache";
  const auto terrain = StreamedTerrain::Open(path, options);
  std::atomic<int> levels{-1};
  const OverviewBuild build(folder / "cache", path, options.elevation,
                            [&] { levels = terrain->LoadOverviews(); });
  while (build.GetState() == OverviewBuild::State::Building) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ASSERT_EQ(build.GetState(), OverviewBuild::State::Built) << build.Failure();
  EXPECT_EQ(levels, 0);
  EXPECT_EQ(posts(*terrain), without);
  const auto next = StreamedTerrain::Open(path, options);
  EXPECT_TRUE(next->Info().overviewsAreCached);
  EXPECT_NE(posts(*next), without);
}

TEST(FilledTerrain, TheGroundBeforeWheelsIsAsRoughAndAsMadeUp) {
  const TemporaryFolder folder;
  StreamedTerrainOptions options;
  options.fillHoles = All;
  const auto terrain = StreamedTerrain::Open(
      Holed(101, 30, [](int c, int r) { return 0.1 * ((c * 7 + r * 13) % 11); })
          .Write(folder / "rough.tif"),
      options);
  const StreamedTerrain& before = terrain->Undisturbed();
  ASSERT_NE(&before, terrain.get());
  EXPECT_TRUE(before.FillsHoles());
  constexpr int Count = 400;
  Rows3 points = Scattered(Count, 45.0, 4);
  points.row(0).setZero(); // in the hole, further from its rim than the radius
  Eigen::VectorXd roughness(Count);
  Eigen::VectorXd bare(Count);
  const auto compare = [&] {
    for (int i = 0; i < Count; ++i) {
      ASSERT_TRUE(bare[i] == roughness[i] || (std::isnan(bare[i]) && std::isnan(roughness[i])))
          << points.row(i) << ": " << bare[i] << ", " << roughness[i];
    }
  };
  terrain->Roughness(points, 4.0, roughness);
  before.Roughness(points, 4.0, bare);
  compare();
  EXPECT_TRUE(std::isnan(bare[0]));
  terrain->Filled(points, roughness);
  before.Filled(points, bare);
  compare();
  EXPECT_EQ(bare[0], 1.0);
}

long PeakMemory() { // [MiB]
  rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

// A reach beyond all of a raster is no reach at all, and costs no more.
TEST(FilledTerrain, AReachBeyondTheRasterFillsAllAndIsCheap) {
  const TemporaryFolder folder;
  const auto same = [](const std::string& path, bool onBody, const Rows3& points) {
    StreamedTerrainOptions options;
    options.onBody = onBody;
    options.fillHoles = All;
    Eigen::VectorXd all(points.rows());
    StreamedTerrain::Open(path, options)->Heights(points, all);
    ASSERT_TRUE(all.allFinite());
    for (const double reach : {1e6, 1e18}) {
      options.fillHoles = reach;
      Eigen::VectorXd heights(points.rows());
      const long before = PeakMemory();
      StreamedTerrain::Open(path, options)->Heights(points, heights);
      EXPECT_LT(PeakMemory() - before, 150);
      EXPECT_EQ(heights, all) << reach;
    }
  };
  same(Holed(401, 90, [](int c, int r) { return 0.1 * c + 3.0 * std::sin(0.1 * r); })
           .Write(folder / "plane.tif"),
       false, Scattered(2000, 195.0, 5));
  Globe globe;
  globe.height = [](double lon, double lat) { // a hole across the date line
    return std::abs(lon) > 165.0 && std::abs(lat) < 12.0 ? Missing : 10.0 * lat;
  };
  RasterFile file = globe.File();
  file.noData = Missing;
  Rows3 points(2000, 3);
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (int i = 0; i < points.rows(); ++i) {
    points.row(i) = 2e6 * Eigen::RowVector3d(-2.0 + 0.5 * normal(random), 0.5 * normal(random),
                                             0.3 * normal(random))
                              .normalized();
  }
  same(file.Write(folder / "globe.tif"), true, points);
}

} // namespace
