// Horizon maps against exact rays over the same triangles, and their files.
#include <atomic>
#include <cmath>
#include <filesystem>

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <dspace/Error.h>

#include "FormulaPosts.h"
#include "Grids.h"
#include "MapTestSupport.h"

namespace dspace::testing {
namespace {

HorizonMap Written(const MapGround& ground, const HorizonMapOptions& options,
                   const std::string& path) {
  EXPECT_TRUE(WriteHorizonMap(ground, options, path));
  return HorizonMap(path);
}

// Median and 99.9 % of the errors.
void ExpectExact(const std::vector<double>& errors, const std::string& about) {
  std::printf("%s: median %.2e, 99.9 %% %.2e, most %.2e deg of %zu\n", about.c_str(),
              Share(errors, 0.5), Share(errors, 0.999), errors.back(), errors.size());
  EXPECT_LE(Share(errors, 0.5), 0.001) << about;
  EXPECT_LE(Share(errors, 0.999), 0.01) << about;
}

TEST(HorizonMap, APlaneAgreesWithRays) {
  const TemporaryFolder folder;
  const auto ground = Rough(90, 70, 5);
  const MapGround map = MapGroundOf(*ground);
  for (const auto& [height, every] : {std::pair(0.0, 1), std::pair(1.7, 3)}) {
    HorizonMapOptions options;
    options.cells = FindCells(map, std::nullopt, 0.7 * every);
    EXPECT_EQ(options.cells.every, every);
    options.height = height;
    options.azimuths = 36;
    const HorizonMap written =
        Written(map, options, (folder.Path() / (std::to_string(every) + ".tif")).string());
    ExpectExact(ErrorsOf(written, map, options.cells, *ground, 60, 3),
                "plane, every " + std::to_string(every));
  }
}

// From masts over a swell, past whose near crests hundreds of posts are seen.
TEST(HorizonMap, FarGroundOfAPlaneAgreesWithRays) {
  const TemporaryFolder folder;
  const auto ground = Rough(900, 70, 6);
  const MapGround map = MapGroundOf(*ground);
  HorizonMapOptions options;
  options.cells = FindCells(map, std::nullopt, 0.7);
  options.height = 8.0;
  options.azimuths = 72;
  const HorizonMap written = Written(map, options, (folder.Path() / "far.tif").string());
  ExpectExact(ErrorsOf(written, map, options.cells, *ground, 200, 7), "far");
}

// Slopes of up to 0.3: half a degree; and no map is both.
TEST(HorizonMap, TheFastModeAgreesToHalfADegree) {
  const TemporaryFolder folder;
  const double metres = 1737400.0 * Degree;
  const auto terrain = OnBody(WriteDegrees(
      folder, "hills.tif", 1737400.0, 400, 300, 30.0, 25.0, 0.008, [&](double lon, double lat) {
        return Hills(lon * metres * 0.93, lat * metres, 2000.0, 60000.0, 0.08);
      }));
  const MapGround ground = MapGroundOf(*terrain);
  HorizonMapOptions options;
  options.cells = FindCells(ground, std::array<double, 4>{31.0, 24.0, 31.6, 23.5}, 0.0);
  options.height = 2.0;
  options.azimuths = 36;
  options.fast = true;
  const std::string path = (folder.Path() / "fast.tif").string();
  const HorizonMap fast = Written(ground, options, path);
  EXPECT_TRUE(fast.Fast());
  const std::vector<double> errors = ErrorsOf(fast, ground, options.cells, *terrain, 150, 9);
  std::printf("fast: median %.2e, 99.9 %% %.2e, most %.2e deg of %zu\n", Share(errors, 0.5),
              Share(errors, 0.999), errors.back(), errors.size());
  EXPECT_LE(Share(errors, 0.5), 0.05);
  EXPECT_LE(Share(errors, 0.999), 0.5);
  EXPECT_GT(Share(errors, 0.999), 0.01); // it is another one than the exact
  options.fast = false;
  options.parts = {path};
  EXPECT_THROW(WriteHorizonMap(ground, options, (folder.Path() / "exact.tif").string()), Error);
  options.parts.clear();
  const HorizonMap exact = Written(ground, options, (folder.Path() / "exact.tif").string());
  EXPECT_FALSE(exact.Fast());
  EXPECT_NE(exact.InputHash(), fast.InputHash());
}

TEST(HorizonMap, ABodyAgreesWithRays) {
  const TemporaryFolder folder;
  const double metres = 1737400.0 * Degree;
  const auto terrain = OnBody(WriteDegrees(
      folder, "hills.tif", 1737400.0, 400, 300, 30.0, 25.0, 0.008, [&](double lon, double lat) {
        return Hills(lon * metres * 0.93, lat * metres, 700.0, 60000.0, 0.08);
      }));
  const MapGround ground = MapGroundOf(*terrain);
  for (const double height : {0.0, 2.0}) {
    HorizonMapOptions options;
    options.cells = FindCells(ground, std::array<double, 4>{31.0, 24.0, 31.2, 23.9}, 0.0);
    EXPECT_EQ(options.cells.every, ground.postsAPixel);
    options.height = height;
    options.azimuths = 24;
    const HorizonMap written =
        Written(ground, options, (folder.Path() / (std::to_string(int(height)) + ".tif")).string());
    EXPECT_TRUE(written.Placement().OnBody());
    const Eigen::Vector2d first = ground.placement.Angles(options.cells.Post(0, 0)) / Degree;
    EXPECT_NEAR((written.Placement().Angles(written.Cells().Post(0, 0)) / Degree - first).norm(),
                0.0, 1e-12);
    EXPECT_NEAR((written.CellToMap() * Eigen::Vector2d(0.5, 0.5) - first).norm(), 0.0, 1e-9);
    ExpectExact(ErrorsOf(written, ground, options.cells, *terrain, 40, 4),
                "body, height " + std::to_string(int(height)));
  }
}

TEST(HorizonMap, CellsAboutAPoleAgreeWithRays) {
  const TemporaryFolder folder;
  const double radius = 3000.0; // posts must be so close that a chord lies within a millimetre
  // A cap of 30 degrees about the south pole, with hills that know nothing of the pole.
  const auto terrain = OnBody(WriteDegrees(
      folder, "cap.tif", radius, 360, 30, -180.0, -60.0, 1.0, [&](double lon, double lat) {
        const double away = (90.0 + lat) * Degree * radius;
        return Hills(away * std::sin(lon * Degree), away * std::cos(lon * Degree), 200.0, 3000.0,
                     0.08);
      }));
  const MapGround ground = MapGroundOf(*terrain);
  HorizonMapOptions options;
  options.cells = FindCells(ground, std::array<double, 4>{-30.0, -85.0, 20.0, -89.9}, 0.0);
  options.height = 2.0;
  options.azimuths = 24;
  const HorizonMap written = Written(ground, options, (folder.Path() / "map.tif").string());
  ExpectExact(ErrorsOf(written, ground, options.cells, *terrain, 40, 5), "pole");
}

// Every edge of the ground by hand, in each azimuth.
TEST(HorizonMap, CellsBesideHolesAgreeWithEveryEdge) {
  const TemporaryFolder folder;
  const auto ground = Rough(40, 36, 12, 0.03);
  const MapGround map = MapGroundOf(*ground);
  HorizonMapOptions options;
  options.cells = FindCells(map, std::nullopt, 0.0);
  options.azimuths = 7;
  options.height = 0.5;
  const HorizonMap written = Written(map, options, (folder.Path() / "map.tif").string());
  const HeightGrid& grid = ground->Grid();
  std::vector<char> has;
  for (int r = 0; r < 36; ++r) {
    for (int c = 0; c < 40; ++c) {
      has.push_back(grid.HasPost(c, r) ? 1 : 0);
    }
  }
  int holes = 0;
  for (int i = 0; i < 200; ++i) {
    const int c = (i * 17) % 40;
    const int r = (i * 23) % 36;
    const std::vector<float> mapped = written.Read(c, r, 1, 1);
    if (!grid.HasPost(c, r)) {
      ++holes;
      EXPECT_TRUE(std::isnan(mapped[0]));
      continue;
    }
    for (int k = 0; k < options.azimuths; ++k) {
      const double azimuth = 2.0 * M_PI * k / options.azimuths;
      const double right = std::sin(azimuth); // columns
      const double down = -std::cos(azimuth); // rows
      double best = -1e9;
      for (int b = 0; b < 36; ++b) {
        for (int a = 0; a < 40; ++a) {
          for (const auto& [da, db] : {std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
            if (a + da >= 40 || b + db >= 36 || !has[std::size_t(b * 40 + a)] ||
                !has[std::size_t((b + db) * 40 + a + da)]) {
              continue;
            }
            // Where the line from (c, r) meets the edge: t along - s (da, db) = (a - c, b - r).
            const double determinant = right * -db + da * down;
            if (std::abs(determinant) < 1e-9) {
              continue;
            }
            const double t = ((a - c) * -db + da * (b - r)) / determinant;
            const double s = (right * (b - r) - down * (a - c)) / determinant;
            if (t > 1e-6 && s > -1e-9 && s < 1.0 + 1e-9) {
              const double h = grid.At(a, b) + s * (grid.At(a + da, b + db) - grid.At(a, b));
              best = std::max(best, (h - grid.At(c, r) - 0.5) / (0.7 * t));
            }
          }
        }
      }
      const double expected = best == -1e9 ? -90.0 : std::atan(best) / Degree;
      EXPECT_NEAR(mapped[std::size_t(k)], expected, 1e-3) << c << " " << r << " " << k;
    }
  }
  EXPECT_GT(holes, 2);
}

// The wall of the closed form in TestHorizonScan about the pole, as four straight walls whose
// middles are that far from the pole.
TEST(HorizonMap, ARingWallIsAtTheElevationOfItsGeometry) {
  const TemporaryFolder folder;
  const double radius = 6371000.0;
  constexpr int Half = 250; // posts
  for (const auto& [angle, expected] : {std::pair(std::asin(5000.04 / (radius + 1000.0)), 0.197017),
                                        std::pair(5000.0 / radius, 0.196988)}) {
    MapGround ground;
    ground.name = "ring";
    ground.pyramid = std::make_shared<ElevationPyramid>(
        std::make_shared<FormulaPosts>(2 * Half + 41, 2 * Half + 41, false, [](double c, double r) {
          const double away = std::max(std::abs(c - Half - 20), std::abs(r - Half - 20));
          return away == Half ? 1000.0 : 0.0;
        }));
    ground.placement = PostPlacement::OnPole(false, 2.0 * radius * std::tan(0.5 * angle) / Half,
                                             Half + 20.0, radius);
    HorizonMapOptions options;
    options.cells.column = options.cells.row = Half + 20;
    options.cells.columns = options.cells.rows = 1;
    options.azimuths = 4;
    const std::string path = (folder.Path() / (std::to_string(expected) + ".tif")).string();
    for (const float elevation : Written(ground, options, path).Read(0, 0, 1, 1)) {
      EXPECT_NEAR(elevation * Degree, expected, 1e-6);
    }
  }
}

class MapFiles : public ::testing::Test {
protected:
  MapFiles() {
    this->Options_.cells = FindCells(this->Ground_, std::nullopt, 0.0);
    this->Options_.azimuths = 48;
  }
  std::string Path(const std::string& name) const { return (this->Folder_.Path() / name).string(); }
  // Ends the work before its first tile, on a machine of any speed.
  static std::function<bool(const MapProgress&)> Begun(const std::string& path) {
    return [path](const MapProgress&) { return !std::filesystem::exists(path + ".part.done"); };
  }

  TemporaryFolder Folder_;
  std::shared_ptr<const GridTerrain> Grid_ = Rough(150, 140, 8); // 3 x 3 tiles
  MapGround Ground_ = MapGroundOf(*Grid_);
  HorizonMapOptions Options_;
};

TEST_F(MapFiles, AResumedMapEqualsAnUninterruptedOne) {
  const std::string whole = this->Path("whole.tif");
  MapControl one;
  one.threads = 1;
  ASSERT_TRUE(WriteHorizonMap(this->Ground_, this->Options_, whole, one));
  const std::string path = this->Path("resumed.tif");
  MapControl stop;
  stop.progress = Begun(path);
  ASSERT_FALSE(WriteHorizonMap(this->Ground_, this->Options_, path, stop));
  ASSERT_TRUE(std::filesystem::exists(path + ".part"));
  int runs = 1;
  for (bool done = false; !done && runs < 50; ++runs) {
    double begun = -1.0;
    MapControl control;
    control.threads = 1 + runs % 3;
    control.progress = [&](const MapProgress& progress) { // at least one more tile a run
      if (progress.elapsed == 0.0) {
        return true; // before the tiles
      }
      begun = begun < 0.0 ? progress.fraction : begun;
      return progress.fraction <= begun || progress.fraction == 1.0;
    };
    done = WriteHorizonMap(this->Ground_, this->Options_, path, control);
    EXPECT_EQ(std::filesystem::exists(path), done);
  }
  EXPECT_TRUE(BytesOf(path) == BytesOf(whole)) << runs << " runs";
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  EXPECT_FALSE(std::filesystem::exists(path + ".part.done"));
}

TEST_F(MapFiles, APartOfOtherInputsIsRefused) {
  const std::string path = this->Path("map.tif");
  MapControl stop;
  stop.progress = Begun(path);
  ASSERT_FALSE(WriteHorizonMap(this->Ground_, this->Options_, path, stop));
  ASSERT_TRUE(std::filesystem::exists(path + ".part"));
  HorizonMapOptions other = this->Options_;
  other.height = 1.0;
  const auto rejected = [&](const MapGround& ground, const HorizonMapOptions& options) {
    try {
      WriteHorizonMap(ground, options, path);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("other inputs"), std::string::npos) << error.what();
      return error.GetKind() == Error::Kind::AlreadyExists;
    }
    return false;
  };
  EXPECT_TRUE(rejected(this->Ground_, other));
  const auto elsewhere = Rough(150, 140, 9); // one seed apart
  EXPECT_TRUE(rejected(MapGroundOf(*elsewhere), this->Options_));
  EXPECT_THROW(HorizonMap{path}, Error);
  EXPECT_TRUE(WriteHorizonMap(this->Ground_, this->Options_, path));
  EXPECT_THROW(WriteHorizonMap(this->Ground_, this->Options_, path), Error); // it exists
}

TEST_F(MapFiles, CellsOfPartsAreCopied) {
  const std::string whole = this->Path("whole.tif");
  ASSERT_TRUE(WriteHorizonMap(this->Ground_, this->Options_, whole));
  const MapCells& cells = this->Options_.cells;
  HorizonMapOptions half = this->Options_;
  half.cells.rows = 2 * TileFile::Side; // 2 x 3 tiles
  const std::string upper = this->Path("upper.tif");
  ASSERT_TRUE(WriteHorizonMap(this->Ground_, half, upper));
  HorizonMapOptions corner = this->Options_;
  corner.cells.column += 2 * TileFile::Side;
  corner.cells.row += 2 * TileFile::Side;
  corner.cells.columns -= 2 * TileFile::Side;
  corner.cells.rows -= 2 * TileFile::Side;
  const std::string last = this->Path("last.tif");
  ASSERT_TRUE(WriteHorizonMap(this->Ground_, corner, last));
  HorizonMapOptions joined = this->Options_;
  joined.parts = {upper, last};
  const std::string path = this->Path("joined.tif");
  ASSERT_TRUE(WriteHorizonMap(this->Ground_, joined, path));
  EXPECT_TRUE(BytesOf(path) == BytesOf(whole));

  // They are copied, not computed: changed values arrive, in their cells alone.
  {
    auto* dataset =
        static_cast<GDALDataset*>(GDALOpen(last.c_str(), GA_Update)); // NOLINT: GDAL owns it
    float value = 77.0f;
    ASSERT_EQ(dataset->GetRasterBand(5)->RasterIO(GF_Write, 3, 2, 1, 1, &value, 1, 1, GDT_Float32,
                                                  0, 0, nullptr),
              CE_None);
    GDALClose(dataset);
  }
  MapControl replace;
  replace.replace = true;
  ASSERT_TRUE(WriteHorizonMap(this->Ground_, joined, path, replace));
  const HorizonMap changed(path);
  const HorizonMap before(whole);
  for (int r = 0; r < cells.rows; ++r) {
    for (int c = 0; c < cells.columns; ++c) {
      const bool there = c == 2 * TileFile::Side + 3 && r == 2 * TileFile::Side + 2;
      const float expected = there ? 77.0f : before.Read(c, r, 1, 1)[4];
      ASSERT_EQ(changed.Read(c, r, 1, 1)[4], expected) << c << ' ' << r;
    }
  }

  joined.height = 1.0;
  try {
    WriteHorizonMap(this->Ground_, joined, this->Path("other.tif"));
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument);
    EXPECT_NE(std::string(error.what()).find("a part of another horizon map"), std::string::npos);
  }
  EXPECT_FALSE(std::filesystem::exists(this->Path("other.tif.part")));
}

TEST_F(MapFiles, BadInputIsRejected) {
  EXPECT_THROW(FindCells(this->Ground_, std::array<double, 4>{0.0, 1.0, 1.0, 0.0}, 0.0), Error);
  EXPECT_THROW(FindCells(this->Ground_, std::nullopt, -1.0), Error);
  EXPECT_THROW(FindCells(this->Ground_, std::nullopt, 0.7 * 65), Error);
  HorizonMapOptions bad = this->Options_;
  bad.azimuths = 0;
  EXPECT_THROW(WriteHorizonMap(this->Ground_, bad, this->Path("bad.tif")), Error);
  bad = this->Options_;
  bad.height = -1.0;
  EXPECT_THROW(WriteHorizonMap(this->Ground_, bad, this->Path("bad.tif")), Error);
  EXPECT_THROW(WriteHorizonMap(this->Ground_, this->Options_, this->Path("none/bad.tif")), Error);
  // What does not fit the disk is said before anything is written.
  bad = this->Options_;
  bad.cells.columns = 1 << 22;
  bad.cells.rows = 1 << 22;
  try {
    WriteHorizonMap(this->Ground_, bad, this->Path("bad.tif"));
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Resource) << error.what();
  }
  EXPECT_FALSE(std::filesystem::exists(this->Path("bad.tif.part")));
  std::ofstream(this->Path("text.tif")) << "text";
  EXPECT_THROW(HorizonMap{this->Path("text.tif")}, Error);
}

} // namespace
} // namespace dspace::testing
