// Overviews in a cache folder against means summed pixel by pixel.
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/posts/RasterPosts.h>

#include "CachedRaster.h"
#include "MisbehavingServer.h"

namespace {

using namespace dspace;
using namespace dspace::testing;
using Cache = CachedRaster;

TEST_F(Cache, CellsAreMeansOfTheirPixels) {
  const std::string path = this->File().Write(this->Folder / "plain.tif");
  double last = -1.0;
  const auto file = this->Builder.Build(path, {}, [&](double part) {
    EXPECT_GT(part, last);
    EXPECT_LE(part, 1.0);
    last = part;
    return true;
  });
  ASSERT_TRUE(file);
  EXPECT_GT(last, 0.5);
  EXPECT_EQ(this->Files(this->Overviews), 1);
  const ElevationSource source(path, this->Cached());
  EXPECT_TRUE(source.Info().overviewsAreCached);
  EXPECT_EQ(source.Info().overviews, 3); // 551, 276 and 138 columns
  EXPECT_EQ(WrongCells(source), 0);
  EXPECT_EQ(WrongCells(source, {512, 256, 333, 480}, 8), 0);
  EXPECT_EQ(WrongCells(source, {1096, 824, 5, 6}, 4), 0); // the last cells are narrower
  // Without the cache it is single pixels.
  EXPECT_GT(WrongCells(ElevationSource(path)), 100000);
  EXPECT_EQ(source.Read({5, 7, 1, 1})[0], Value(5, 7) * 0.5 + 3.0);
  EXPECT_EQ(source.Info().driver, "GTiff");
  EXPECT_EQ(source.Info().path, path);
}

TEST_F(Cache, PostsOfAPlaneLieOnItAtEveryLevel) {
  RasterFile file = this->File();
  file.type = GDT_Float64;
  file.width = 3001;
  file.height = 2049;
  file.scale.reset();
  file.offset = 1737400.0; // radii: their means are kept in doubles
  file.value = [](int c, int r, int) { return 0.5 * c - 0.25 * r; };
  const std::string path = file.Write(this->Folder / "plane.tif");
  ASSERT_TRUE(ElevationCache::Needs(ElevationSource(path).Info()));
  ASSERT_TRUE(this->Builder.Build(path));
  const auto source = std::make_shared<ElevationSource>(path, this->Cached());
  EXPECT_EQ(source->Info().verticalDatum.kind, VerticalDatum::Kind::Radius);
  RasterPostsOptions options;
  options.levels = 8;
  const RasterPosts posts(source, options);
  for (int level = 1; level < 8; ++level) {
    const PostLattice& lattice = posts.GetLattice();
    const auto columns = lattice.ColumnsAt(level);
    const auto rows = lattice.RowsAt(level);
    std::vector<float> heights(columns * rows);
    posts.Read({level, 0, 0, int(columns), int(rows)}, heights.data());
    for (std::int64_t r = 1; r + 2 < rows; ++r) {
      for (std::int64_t c = 1; c + 2 < columns; ++c) {
        ASSERT_NEAR(heights[r * columns + c], std::ldexp(0.5 * c - 0.25 * r, level), 2e-3)
            << level << ": " << c << ", " << r;
      }
    }
  }
}

TEST_F(Cache, WindowsBeginAtACellOrAreReadWithoutIt) {
  const std::string path = this->File().Write(this->Folder / "window.tif");
  this->Builder.Build(path);
  ElevationOptions options = this->Cached();
  options.window = {16, 24, 900, 700};
  const std::vector<double> inside = ElevationSource(path, options).ReadReduced({0, 0, 64, 64}, 8);
  EXPECT_EQ(inside, ElevationSource(path, this->Cached()).ReadReduced({16, 24, 64, 64}, 8));
  options.window = {17, 24, 900, 700};
  const ElevationSource with(path, options);
  options.overviewCache.clear();
  const ElevationSource without(path, options);
  EXPECT_EQ(with.ReadReduced({0, 0, 32, 32}, 4)[5], without.ReadReduced({0, 0, 32, 32}, 4)[5]);
  EXPECT_EQ(with.ReadReduced({0, 0, 33, 33}, 3)[5], without.ReadReduced({0, 0, 33, 33}, 3)[5]);
}

TEST_F(Cache, BandsOptionsAndWhollyEmptyRasters) {
  RasterFile file = this->File();
  file.bands = 2;
  file.value = [](int c, int r, int band) { return band == 1 ? NoData : Value(c, r); };
  const std::string path = file.Write(this->Folder / "two.tif");
  ElevationOptions second;
  second.band = 2;
  ASSERT_TRUE(this->Builder.Build(path, second));
  EXPECT_FALSE(ElevationSource(path, this->Cached()).Info().overviewsAreCached);
  ASSERT_TRUE(this->Builder.Build(path));
  EXPECT_EQ(this->Files(this->Overviews), 2);
  EXPECT_EQ(WrongCells(ElevationSource(path, this->Cached())), 0);
  second.overviewCache = this->Overviews;
  for (const double h : ElevationSource(path, second).ReadReduced({0, 0, Width, Height}, 8)) {
    EXPECT_TRUE(std::isnan(h));
  }
  // Scale and offset by hand are those of the values.
  ElevationOptions hand = this->Cached();
  hand.verticalScale = 5.0;
  hand.verticalOffset = 30.0;
  const double h = ElevationSource(path, hand).ReadReduced({800, 0, 8, 8}, 8)[0];
  EXPECT_NEAR(h, 10.0 * MeanByHand(100, 0, 8, Value), 1e-2);
}

TEST_F(Cache, RastersWithOverviewsNeedNone) {
  const std::string path = this->File().Write(this->Folder / "own.tif");
  auto* dataset = GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_UPDATE);
  int factor = 4;
  dataset->BuildOverviews("AVERAGE", 1, &factor, 0, nullptr, nullptr, nullptr);
  GDALClose(dataset);
  EXPECT_FALSE(this->Builder.Build(path));
  EXPECT_FALSE(fs::exists(this->Overviews));
  EXPECT_FALSE(ElevationCache::Needs(ElevationSource(path).Info()));
  EXPECT_THROW(this->Builder.Build(this->Folder / "absent.tif"), Error);
}

// A single changed byte, wherever it is, is never read as heights.
TEST_F(Cache, ClearRemovesItsOwnFilesOnly) {
  const std::string path = this->File().Write(this->Folder / "a.tif");
  EXPECT_TRUE(this->Builder.Entries().empty());
  this->Builder.Clear(); // of a folder that is absent
  const std::string file = *this->Builder.Build(path);
  std::ofstream(this->Overviews + "/notes.txt") << "mine";
  std::ofstream(this->Overviews + "/.x.overviews.0123456789abcdef.part") << "a killed build's";
  ASSERT_EQ(this->Builder.Entries().size(), 1u);
  EXPECT_EQ(this->Builder.Entries()[0].path, path);
  EXPECT_EQ(this->Builder.Entries()[0].file, file);
  EXPECT_EQ(this->Builder.SizeBytes(), fs::file_size(file));
  this->Builder.Clear();
  EXPECT_EQ(this->Files(this->Overviews), 1);
  EXPECT_TRUE(fs::exists(this->Overviews + "/notes.txt"));
  // Nothing stands beside the raster.
  EXPECT_EQ(this->Files(fs::path(path).parent_path().string()), 2);
}

TEST_F(Cache, TheDefaultFolderIsTheUsersCache) {
  const auto keep = [](const char* name) {
    const char* value = std::getenv(name);
    return value ? std::string(value) : std::string();
  };
  const std::string cache = keep("XDG_CACHE_HOME");
  ::setenv("XDG_CACHE_HOME", "/somewhere/cache", 1);
  EXPECT_EQ(ElevationCache::DefaultFolder(), "/somewhere/cache/dspace/terrain");
  ::unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(ElevationCache::DefaultFolder(), keep("HOME") + "/.cache/dspace/terrain");
  if (!cache.empty()) {
    ::setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  }
}

TEST_F(Cache, ARasterOnAServerHasOverviewsHere) {
  const std::string path = this->File().Write(this->Folder / "served.tif");
  dspace::testing::MisbehavingServer server(path);
  const std::string url = server.Url("served.tif");
  ASSERT_TRUE(this->Builder.Build(url));
  const ElevationSource source(url, this->Cached());
  ASSERT_TRUE(source.Info().overviewsAreCached);
  EXPECT_EQ(WrongCells(source), 0);
  // Far ground needs no server.
  server.mode = dspace::testing::MisbehavingServer::Mode::Broken;
  EXPECT_EQ(WrongCells(source), 0);
}

} // namespace
