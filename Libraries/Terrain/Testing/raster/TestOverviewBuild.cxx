// Overviews that are built in the background of an open terrain.
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>
#include <pthread.h>

#include <dspace/clipmap/PoleCharts.h>
#include <dspace/raster/ElevationCache.h>
#include <dspace/raster/OverviewBuild.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Globe.h"

namespace {

using namespace dspace;
using dspace::testing::Globe;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;
namespace fs = std::filesystem;

void AwaitEnd(const OverviewBuild& build) {
  for (int i = 0; i < 60000 && build.GetState() == OverviewBuild::State::Building; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

// Columns by turns 0 and 90 m: their mean is 45 m, whereas every n-th has one of the two.
RasterFile Stripes(int side) {
  RasterFile file;
  file.width = file.height = side;
  file.type = GDT_Int16;
  file.geotransform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
  file.crs = "+proj=eqc +R=1737400 +type=crs";
  file.value = [](int c, int, int) { return c % 2 ? 90.0 : 0.0; };
  return file;
}

// As large as is asked for, without data and without a file of that size.
std::string Endless(const std::string& path) {
  std::ofstream(path) << "<VRTDataset rasterXSize=\"100000\" rasterYSize=\"100000\">"
                         "<GeoTransform>0, 1, 0, 0, 0, -1</GeoTransform>"
                         "<VRTRasterBand dataType=\"Int16\" band=\"1\">"
                         "<NoDataValue>-1</NoDataValue></VRTRasterBand></VRTDataset>";
  return path;
}

std::vector<float> Posts(ElevationPyramid& pyramid, int level) {
  std::vector<float> heights(16 * 16);
  pyramid.Read({level, 4, 4, 16, 16}, heights.data());
  return heights;
}

TEST(OverviewBuild, FarGroundIsTheMeanOnceTheyAreThere) {
  const TemporaryFolder folder;
  StreamedTerrainOptions options;
  options.elevation.overviewCache = folder / "cache";
  const std::string path = Stripes(2304).Write(folder / "stripes.tif");
  const auto terrain = StreamedTerrain::Open(path, options);
  ElevationPyramid& pyramid = *terrain->Pyramid();
  EXPECT_TRUE(OverviewBuild::Wanted(terrain->Info()));
  EXPECT_EQ(terrain->LoadOverviews(), 0) << "there are none yet";
  for (const float height : Posts(pyramid, 4)) {
    EXPECT_TRUE(height == 0.0f || height == 90.0f) << height;
  }
  const std::vector<float> near = Posts(pyramid, 0);
  const std::vector<float> mean = Posts(pyramid, 3); // of every pixel already
  const std::uint64_t before = pyramid.Changes(0).stamp;
  std::atomic<int> levels{0};
  {
    const OverviewBuild build(folder / "cache", path, options.elevation,
                              [&] { levels = terrain->LoadOverviews(); });
    AwaitEnd(build);
    EXPECT_EQ(build.GetState(), OverviewBuild::State::Built) << build.Failure();
    EXPECT_EQ(build.Progress(), 1.0);
  }
  EXPECT_EQ(levels, 4); // 1152, 576, 288 and 144 columns
  const PyramidChanges changes = pyramid.Changes(before);
  ASSERT_EQ(changes.rectangles.size(), 1u);
  EXPECT_EQ(changes.rectangles[0].from, 4);
  // Coarse tiles are read again, fine ones are still there.
  std::vector<float> heights(16 * 16);
  EXPECT_TRUE(pyramid.TryRead({0, 4, 4, 16, 16}, heights.data()));
  EXPECT_EQ(heights, near);
  EXPECT_TRUE(pyramid.TryRead({3, 4, 4, 16, 16}, heights.data()));
  EXPECT_EQ(heights, mean);
  for (const float height : Posts(pyramid, 4)) {
    EXPECT_NEAR(height, 45.0f, 1e-3f);
  }
  const auto next = StreamedTerrain::Open(path, options);
  EXPECT_TRUE(next->Info().overviewsAreCached);
  EXPECT_FALSE(OverviewBuild::Wanted(next->Info()));
}

// Around a pole the ground is drawn from tiles of its own, and a pole's height is kept.
TEST(OverviewBuild, PolesTakeThemToo) {
  const TemporaryFolder folder;
  Globe globe;
  globe.width = 1920;
  globe.height = [&](double lon, double) {
    return int(std::floor((lon + 180.0) / globe.Step())) % 2 ? 90.0 : 0.0;
  };
  StreamedTerrainOptions options;
  options.onBody = true;
  options.elevation.overviewCache = folder / "cache";
  const std::string path = globe.File().Write(folder / "globe.tif");
  const auto terrain = StreamedTerrain::Open(path, options);
  std::vector<std::shared_ptr<ElevationPyramid>> charts;
  for (const ClipmapChart& chart : PoleChartsOf(*terrain, options.cells)) {
    charts.push_back(chart.pyramid);
  }
  ASSERT_EQ(charts.size(), 2u);
  const int level = charts[0]->Lattice().levels - 1;
  ASSERT_GE(level, 4 + terrain->Subdivisions());
  const PostBlock middle{level, charts[0]->Lattice().ColumnsAt(level) / 2 - 2,
                         charts[0]->Lattice().RowsAt(level) / 2 - 2, 5, 5};
  const auto furthest = [&] { // from the mean
    float most = 0.0f;
    for (const auto& chart : charts) {
      std::vector<float> heights(25);
      chart->Read(middle, heights.data());
      for (const float height : heights) {
        most = std::max(most, std::abs(height - 45.0f));
      }
    }
    return most;
  };
  EXPECT_GT(furthest(), 40.0f);
  const OverviewBuild build(folder / "cache", path, options.elevation,
                            [&] { terrain->LoadOverviews(charts); });
  AwaitEnd(build);
  ASSERT_EQ(build.GetState(), OverviewBuild::State::Built) << build.Failure();
  EXPECT_LT(furthest(), 1e-3f);
}

TEST(OverviewBuild, EndsWithWhatWantsIt) {
  const TemporaryFolder folder;
  const std::string path = Endless(folder / "endless.vrt");
  std::atomic<int> calls{0};
  {
    const OverviewBuild build(folder / "cache", path, {}, [&] { ++calls; });
    while (build.GetState() == OverviewBuild::State::Building && build.Progress() == 0.0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2)); // until it is under way
    }
    ASSERT_EQ(build.GetState(), OverviewBuild::State::Building) << build.Failure();
    EXPECT_LT(build.Progress(), 0.5);
  }
  EXPECT_EQ(calls, 0);
  EXPECT_TRUE(fs::is_empty(folder / "cache")) << "something half-made was left";
  const OverviewBuild atOnce(folder / "cache", path, {}, [&] { ++calls; });
}

TEST(OverviewBuild, AFailureIsToldAndTheGroundStaysAsItWas) {
  const TemporaryFolder folder;
  StreamedTerrainOptions options;
  const std::string path = Stripes(900).Write(folder / "stripes.tif");
  options.elevation.overviewCache = path + "/cache"; // in a file
  const auto terrain = StreamedTerrain::Open(path, options);
  const std::vector<float> before = Posts(*terrain->Pyramid(), 4);
  const OverviewBuild build(options.elevation.overviewCache, path, {},
                            [&] { terrain->LoadOverviews(); });
  AwaitEnd(build);
  EXPECT_EQ(build.GetState(), OverviewBuild::State::Failed);
  EXPECT_NE(build.Failure().find(path + "/cache"), std::string::npos) << build.Failure();
  EXPECT_EQ(Posts(*terrain->Pyramid(), 4), before);

  const OverviewBuild absent(folder / "cache", folder / "absent.tif", {}, [] {});
  AwaitEnd(absent);
  EXPECT_EQ(absent.GetState(), OverviewBuild::State::Failed);
  EXPECT_NE(absent.Failure().find("absent.tif"), std::string::npos) << absent.Failure();
}

#ifdef __GLIBC__
// Threads with more stack than there are addresses cannot be started.
TEST(OverviewBuild, AThreadThatCannotBeStartedIsAFailure) {
  const TemporaryFolder folder;
  pthread_attr_t usual;
  pthread_attr_t greedy;
  ASSERT_EQ(pthread_getattr_default_np(&usual), 0);
  ASSERT_EQ(pthread_getattr_default_np(&greedy), 0);
  ASSERT_EQ(pthread_attr_setstacksize(&greedy, std::size_t(1) << 50), 0);
  ASSERT_EQ(pthread_setattr_default_np(&greedy), 0);
  std::atomic<int> calls{0};
  const auto build = [&]() -> std::unique_ptr<OverviewBuild> {
    try {
      return std::make_unique<OverviewBuild>(folder / "cache", folder / "any.tif",
                                             ElevationOptions{}, [&] { ++calls; });
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
      return nullptr;
    }
  }();
  ASSERT_EQ(pthread_setattr_default_np(&usual), 0);
  pthread_attr_destroy(&usual);
  pthread_attr_destroy(&greedy);
  ASSERT_TRUE(build);
  EXPECT_EQ(build->GetState(), OverviewBuild::State::Failed);
  EXPECT_NE(build->Failure().find("thread"), std::string::npos) << build->Failure();
  EXPECT_EQ(calls, 0);
}
#endif

TEST(OverviewBuild, TwoAtOnceLeaveOne) {
  const TemporaryFolder folder;
  const std::string path = Stripes(1500).Write(folder / "stripes.tif");
  std::atomic<int> calls{0};
  const OverviewBuild one(folder / "cache", path, {}, [&] { ++calls; });
  const OverviewBuild two(folder / "cache", path, {}, [&] { ++calls; });
  AwaitEnd(one);
  AwaitEnd(two);
  EXPECT_EQ(one.GetState(), OverviewBuild::State::Built) << one.Failure();
  EXPECT_EQ(two.GetState(), OverviewBuild::State::Built) << two.Failure();
  EXPECT_EQ(calls, 2);
  const ElevationCache cache(folder / "cache");
  ASSERT_EQ(cache.Entries().size(), 1u);
  EXPECT_NO_THROW(ElevationCache::Verify(cache.Entries()[0]));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "cache"), fs::directory_iterator()), 1);
}

TEST(OverviewBuild, IsWantedOfLargeLocalRastersWithoutAny) {
  ElevationInfo info;
  info.window = {0, 0, 2001, 2000};
  EXPECT_TRUE(OverviewBuild::Wanted(info));
  ElevationInfo other = info;
  other.remote = true;
  EXPECT_FALSE(OverviewBuild::Wanted(other));
  other = info;
  other.overviews = 2; // its own
  EXPECT_FALSE(OverviewBuild::Wanted(other));
  other.overviewsAreCached = true;
  EXPECT_FALSE(OverviewBuild::Wanted(other));
  other = info;
  other.window.width = 2000; // as many as small ones have
  EXPECT_FALSE(OverviewBuild::Wanted(other));
}

} // namespace
