// Holes that are filled: against planes and curved ground in closed form.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/clipmap/PoleCharts.h>
#include <dspace/pyramid/FilledPosts.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Globe.h"

namespace {

using namespace dspace;
using dspace::testing::Direction;
using dspace::testing::Globe;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

constexpr int Side = 401;
constexpr double Missing = -9999.0;
using Formula = std::function<double(double c, double r)>;

// A round hole, an oblong one, and single pixels.
bool IsHole(int c, int r) {
  return std::hypot(c - 150.0, r - 200.0) < 60.0 || (c >= 260 && c < 390 && r >= 90 && r < 105) ||
         (c * 31 + r * 17) % 173 == 0;
}

RasterFile Field(const Formula& height) {
  RasterFile file;
  file.width = file.height = Side;
  file.noData = Missing;
  file.geotransform = std::array<double, 6>{0, 1, 0, double(Side), 0, -1};
  file.crs = "+proj=eqc +R=1737400 +type=crs";
  file.value = [=](int c, int r, int) { return IsHole(c, r) ? Missing : height(c, r); };
  return file;
}

struct FilledField {
  TemporaryFolder folder;
  std::shared_ptr<const RasterPosts> raster;
  std::shared_ptr<const FilledPosts> filled;
  explicit FilledField(const Formula& height,
                       double reach = std::numeric_limits<double>::infinity(),
                       int subdivisions = 0) {
    RasterPostsOptions options;
    options.subdivisions = subdivisions;
    options.coarsest = 60;
    raster = std::make_shared<const RasterPosts>(
        std::make_shared<const ElevationSource>(Field(height).Write(folder / "field.tif")),
        options);
    filled = std::make_shared<const FilledPosts>(raster, reach);
  }
  std::vector<float> Level(int level, const PostSource& source) const {
    const PostLattice& lattice = raster->GetLattice();
    const PostBlock all{level, 0, 0, int(lattice.ColumnsAt(level)), int(lattice.RowsAt(level))};
    std::vector<float> heights(std::size_t(all.width) * all.height);
    source.Read(all, heights.data());
    return heights;
  }
};

// Cells with data in part lean to it by a thirtieth of their spacing, on each level that a hole
// reaches: here up to 8 pixels apart.
TEST(FilledPosts, APlaneIsFilledToThePlane) {
  const auto plane = [](double c, double r) { return 100.0 + 0.3 * c - 0.2 * r; };
  const FilledField field(plane);
  const std::vector<float> own = field.Level(0, *field.raster);
  const std::vector<float> heights = field.Level(0, *field.filled);
  double most = 0.0;
  int made = 0;
  for (int r = 0; r < Side; ++r) {
    for (int c = 0; c < Side; ++c) {
      const std::size_t i = std::size_t(r) * Side + c;
      ASSERT_EQ(std::isnan(own[i]), IsHole(c, r));
      if (!std::isnan(own[i])) {
        ASSERT_EQ(heights[i], own[i]) << "data were changed";
        continue;
      }
      ++made;
      if (std::min({c, r, Side - 1 - c, Side - 1 - r}) > 0) {
        most = std::max(most, std::abs(heights[i] - plane(c, r)));
      }
    }
  }
  EXPECT_GT(made, 13000);
  const double slope = std::hypot(0.3, 0.2);
  EXPECT_LT(most, slope * 8.0 / 30.0 * 2.0); // of 120 px x 0.36 = 43 m across the hole
  RecordProperty("most", std::to_string(most));
}

// A membrane over a bowl's hole is level at the rim's height, which coarse posts (8 pixels apart)
// see up to that far outside; a pixel's step at the rim is no greater than twice the bowl's own
// there.
TEST(FilledPosts, CurvedGroundIsJoinedWithoutAStep) {
  const auto bowl = [](double c, double r) {
    return 0.004 * ((c - 150.0) * (c - 150.0) + (r - 200.0) * (r - 200.0));
  };
  const FilledField field(bowl);
  const std::vector<float> heights = field.Level(0, *field.filled);
  const double rim = 0.004 * 60.0 * 60.0; // 14.4 m; a pixel's step there is 0.48 m
  double step = 0.0;
  for (int r = 130; r < 271; ++r) {
    for (int c = 80; c < 221; ++c) {
      const float here = heights[std::size_t(r) * Side + c];
      const double radius = std::hypot(c - 150.0, r - 200.0);
      if (radius < 55.0) {
        ASSERT_NEAR(here, rim, 0.004 * 68.0 * 68.0 - rim) << c << ", " << r;
      }
      if (radius < 61.0) {
        step = std::max({step, double(std::abs(here - heights[std::size_t(r) * Side + c + 1])),
                         double(std::abs(here - heights[std::size_t(r + 1) * Side + c]))});
      }
    }
  }
  EXPECT_LT(step, 2.0 * 0.484); // of a pixel at the rim
  EXPECT_GT(step, 0.2);
}

// A post is the same however it is read, and before and after others.
TEST(FilledPosts, APostDependsOnTheRasterAlone) {
  const auto rough = [](double c, double r) {
    return 5.0 * std::sin(0.21 * c) * std::cos(0.17 * r) + 0.1 * c;
  };
  const FilledField field(rough);
  const FilledField again(rough);
  std::mt19937 random(5);
  std::vector<PostBlock> blocks;
  for (int i = 0; i < 40; ++i) {
    const int level = int(random() % 4);
    const int side = Side >> level;
    blocks.push_back({level, std::int64_t(random() % side) - 5, std::int64_t(random() % side) - 5,
                      1 + int(random() % 40), 1 + int(random() % 40)});
  }
  std::vector<std::vector<float>> whole;
  for (int level = 0; level < 4; ++level) {
    whole.push_back(field.Level(level, *field.filled));
  }
  for (const PostBlock& block : blocks) {
    std::vector<float> heights(std::size_t(block.width) * block.height);
    again.filled->Read(block, heights.data());
    const std::int64_t columns = field.raster->GetLattice().ColumnsAt(block.level);
    const std::int64_t rows = field.raster->GetLattice().RowsAt(block.level);
    for (int j = 0; j < block.height; ++j) {
      for (int i = 0; i < block.width; ++i) {
        const std::int64_t c = block.column + i;
        const std::int64_t r = block.row + j;
        const float here = heights[std::size_t(j) * block.width + i];
        if (c < 0 || r < 0 || c >= columns || r >= rows) {
          EXPECT_TRUE(std::isnan(here));
        } else {
          ASSERT_EQ(here, whole[block.level][std::size_t(r * columns + c)]) << c << ", " << r;
        }
      }
    }
  }
}

TEST(FilledPosts, CoarserPostsAreAboutTheMeansOfTheFilledSurface) {
  const auto rough = [](double c, double r) {
    return 2.0 * std::sin(0.05 * c) * std::cos(0.04 * r) + 0.1 * c;
  };
  const FilledField field(rough);
  const std::vector<float> fine = field.Level(0, *field.filled);
  const int level = 3;
  const std::vector<float> coarse = field.Level(level, *field.filled);
  const auto columns = int(field.raster->GetLattice().ColumnsAt(level));
  double most = 0.0;
  for (int k = 2; k + 2 < columns; ++k) {
    for (int j = 2; j + 2 < columns; ++j) {
      double sum = 0.0;
      double weights = 0.0;
      for (int r = -4; r <= 4; ++r) {
        for (int c = -4; c <= 4; ++c) {
          const double w = (std::abs(r) == 4 ? 0.5 : 1.0) * (std::abs(c) == 4 ? 0.5 : 1.0);
          sum += w * fine[std::size_t(8 * j + r) * Side + 8 * k + c];
          weights += w;
        }
      }
      most = std::max(most, std::abs(sum / weights - coarse[std::size_t(j) * columns + k]));
    }
  }
  EXPECT_LT(most, 0.6); // a cell spans 1.6 m
}

// No further from data than is said; the rest stays a hole.
TEST(FilledPosts, ReachIsKept) {
  for (const double reach : {5.0, 12.5, 40.0}) {
    const FilledField field([](double c, double) { return c; }, reach);
    const std::vector<float> heights = field.Level(0, *field.filled);
    int made = 0;
    for (int r = 135; r < 266; r += 3) {
      for (int c = 85; c < 216; c += 2) {
        double nearest = 1e9;
        const int within = int(std::min(reach, 62.0)) + 1;
        for (int y = std::max(0, r - within); y <= std::min(Side - 1, r + within); ++y) {
          for (int x = std::max(0, c - within); x <= std::min(Side - 1, c + within); ++x) {
            if (!IsHole(x, y)) {
              nearest = std::min(nearest, std::hypot(x - c, y - r));
            }
          }
        }
        ASSERT_EQ(std::isnan(heights[std::size_t(r) * Side + c]), nearest > reach)
            << reach << ": " << c << ", " << r;
        made += IsHole(c, r) && nearest <= reach;
      }
    }
    EXPECT_GT(made, 200);
  }
  EXPECT_THROW(FilledField([](double, double) { return 0.0; }, 0.0), Error);
  EXPECT_THROW(FilledField([](double, double) { return 0.0; }, std::nan("")), Error);
}

// Through a terrain: what is drawn, answered and told apart is one; without the option nothing
// changes.
TEST(FilledPosts, ATerrainAnswersAndTellsItApart) {
  const TemporaryFolder folder;
  const auto plane = [](double c, double r) { return 50.0 + 0.1 * c + 0.05 * r; };
  const std::string path = Field(plane).Write(folder / "field.tif");
  StreamedTerrainOptions options;
  const auto holed = StreamedTerrain::Open(path, options);
  options.fillHoles = std::numeric_limits<double>::infinity();
  options.subdivisions = 2;
  const auto terrain = StreamedTerrain::Open(path, options);
  EXPECT_TRUE(terrain->FillsHoles());
  EXPECT_FALSE(holed->FillsHoles());
  constexpr int Count = 20000;
  Rows3 points(Count, 3);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-0.5, 0.5);
  for (int i = 0; i < Count; ++i) {
    points.row(i) << 402.0 * unit(random), 402.0 * unit(random), 0.0;
  }
  Eigen::VectorXd without(Count);
  Eigen::VectorXd with(Count);
  Eigen::VectorXd told(Count);
  holed->Heights(points, without);
  terrain->Heights(points, with);
  terrain->Filled(points, told);
  int made = 0;
  for (int i = 0; i < Count; ++i) {
    const bool inside = points.row(i).head<2>().cwiseAbs().maxCoeff() < 199.0;
    if (!std::isnan(without[i])) {
      ASSERT_NEAR(with[i], without[i], 1e-4);
      EXPECT_EQ(told[i], 0.0);
    } else if (std::isnan(with[i])) {
      EXPECT_FALSE(inside);
      EXPECT_TRUE(std::isnan(told[i]));
    } else {
      EXPECT_EQ(told[i], 1.0);
      ++made;
      const double c = points(i, 0) + 0.5 * (Side - 1);
      const double r = 0.5 * (Side - 1) - points(i, 1);
      if (inside) {
        ASSERT_NEAR(with[i], plane(c, r), 0.06) << c << ", " << r; // 8 px x 0.11 / 30 x 2
      }
    }
  }
  EXPECT_GT(made, 1500);
  holed->Filled(points, told);
  for (int i = 0; i < Count; ++i) {
    EXPECT_TRUE(std::isnan(without[i]) ? std::isnan(told[i]) : told[i] == 0.0);
  }
  // Rays fall on it; roughness is of the raster's own pixels.
  const RayHit hit = terrain->Intersect({-50.0, 0.0, 1000.0}, {0.0, 0.0, -1.0});
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(1000.0 - hit.distance, plane(150, 200), 0.06);
  Rows3 middle(1, 3);
  middle.row(0) << -50.0, 0.0, 0.0;
  Eigen::VectorXd roughness(1);
  terrain->Roughness(middle, 20.0, roughness);
  EXPECT_TRUE(std::isnan(roughness[0]));
}

// A cap without data about a pole, and a hole across the date line; a pole has one height.
TEST(FilledPosts, PolesAndTheDateLineAreClosed) {
  const TemporaryFolder folder;
  for (const int width : {480, 450}) { // as it is, and resampled
    Globe globe;
    globe.width = width;
    globe.height = [](double lon, double lat) { // no data above 80 degrees
      const bool hole = lat > 80.0 || (std::abs(lon) > 165.0 && std::abs(lat) < 12.0);
      return hole ? Missing : 1000.0 + 200.0 * std::sin(lat * dspace::testing::Degree);
    };
    RasterFile file = globe.File();
    file.noData = Missing;
    StreamedTerrainOptions options;
    options.onBody = true;
    options.fillHoles = std::numeric_limits<double>::infinity();
    const auto terrain = StreamedTerrain::Open(file.Write(folder / "globe.tif"), options);
    const auto at = [&](double lon, double lat) {
      const SurfaceSample sample = terrain->Sample(2e6 * Direction(lon, lat));
      EXPECT_TRUE(sample.valid) << lon << ", " << lat;
      return sample.height;
    };
    const double pole = at(0.0, 90.0);
    EXPECT_NEAR(pole, 1000.0 + 200.0 * std::sin(80.0 * dspace::testing::Degree), 3.0);
    for (int lon = -180; lon < 180; lon += 15) {
      EXPECT_NEAR(at(lon, 89.999), pole, 0.05) << lon;
      for (double lat = 78.0; lat < 90.0; lat += 0.25) { // by a third of a pixel
        EXPECT_NEAR(at(lon, lat), at(lon, lat + 0.2), 1.5) << lon << ", " << lat;
      }
    }
    for (double lat = -14.0; lat < 14.0; lat += 0.5) {
      EXPECT_NEAR(at(179.999, lat), at(-179.999, lat), 0.05) << lat;
      EXPECT_NEAR(at(179.0, lat), 1000.0 + 200.0 * std::sin(lat * dspace::testing::Degree), 6.0);
    }
    // Charts about the poles are of the same ground.
    const auto charts = PoleChartsOf(*terrain, 124);
    const PostLattice& lattice = charts[0].pyramid->Lattice();
    float height = 0.0f;
    charts[0].pyramid->Read({0, lattice.columns / 2, lattice.rows / 2, 1, 1}, &height);
    EXPECT_NEAR(height, pole, 0.01);
  }
}

} // namespace
