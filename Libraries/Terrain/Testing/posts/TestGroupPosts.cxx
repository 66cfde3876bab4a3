// Terrain groups against formulas, and post by post against other code (Patches.h).
#include <algorithm>
#include <cmath>
#include <list>
#include <random>

#include <gtest/gtest.h>

#include <dspace/groups/GroupPosts.h>
#include <dspace/posts/RasterPosts.h>

#include "Groups.h"
#include "Patches.h"
#include "RasterFile.h"

namespace {

using namespace dspace;
using namespace dspace::testing;

TEST(GroupPosts, WithinIsThePatchOutsideTheBaseAndTheBorderIsContinuous) {
  const TemporaryFolder folder;
  const PatchFile patch = Polar();
  const Base base = Region();
  const Group group(base, base.Write(folder / "base.tif"), {patch.Write(folder / "patch.tif")});
  const PatchReport& report = group.posts->Report().patches.at(0);
  ASSERT_TRUE(report.used);
  EXPECT_TRUE(group.posts->Report().warnings.empty()) << group.posts->Report().warnings.front();
  EXPECT_GT(report.posts, 60);
  EXPECT_TRUE(report.heightsAreExact);
  EXPECT_NEAR(report.pixel, 110.0 * 0.5 * (1.0 + std::sin(75.1 * Deg)), 1e-3);
  // As fine as the patch, and no finer than twice that.
  const double spacing = base.step / group.parts * Deg * MoonRadius;
  EXPECT_LE(spacing, 1.02 * report.pixel);
  EXPECT_GT(spacing, 0.45 * report.pixel);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  // At its own posts the patch's formula, as well as stated.
  double squares = 0.0;
  int count = 0;
  const double border = patch.margin / report.pixel + 6.0; // pixels
  for (int i = 0; i < 3000; ++i) {
    const int c = int(unit(random) * patch.width);
    const int r = int(unit(random) * patch.height);
    if (std::min({c, r, patch.width - 1 - c, patch.height - 1 - r}) < border) {
      continue;
    }
    const Eigen::Vector2d lonLat = patch.LonLatOf({c + 0.5, r + 0.5});
    const double error = group.HeightAt(lonLat) - patch.FormulaAt(lonLat);
    EXPECT_LE(std::abs(error), 1.3 * report.greatestError);
    squares += error * error;
    ++count;
  }
  ASSERT_GT(count, 500);
  EXPECT_NEAR(std::sqrt(squares / count), report.rmsError, 0.25 * report.rmsError);
  EXPECT_LT(report.rmsError, 0.5);
  EXPECT_GT(report.rmsError, 0.0);
  // Where the patch is not, the base's posts to the bit.
  int outside = 0;
  for (int i = 0; i < 300; ++i) {
    const PostBlock block{0, std::int64_t(unit(random) * group.base->GetLattice().columns),
                          std::int64_t(unit(random) * group.base->GetLattice().rows), 9, 7};
    std::vector<float> a(63);
    std::vector<float> b(63);
    group.posts->Read(block, a.data());
    group.base->Read(block, b.data());
    for (int k = 0; k < 63; ++k) {
      const Eigen::Vector2d pixel =
          patch.PixelOf(group.LonLat(double(block.column + k % 9), double(block.row + k / 9)));
      if (pixel.minCoeff() < 0.0 || pixel.x() > patch.width || pixel.y() > patch.height) {
        ASSERT_TRUE(a[k] == b[k] || (std::isnan(a[k]) && std::isnan(b[k])));
        ++outside;
      }
    }
  }
  EXPECT_GT(outside, 5000);
  // Small steps from outside to the middle: weight x difference, and the slopes of the two.
  for (const double angle : {0.0, 1.1, 2.3, 4.0, 5.5}) {
    const Eigen::Vector2d middle(0.5 * patch.width, 0.5 * patch.height);
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const double step = 0.05; // pixels
    double before = group.HeightAt(patch.LonLatOf(middle + 170.0 * along));
    double steepest = 0.0;
    for (double t = 170.0; t > 60.0; t -= step) {
      const double height = group.HeightAt(patch.LonLatOf(middle + (t - step) * along));
      steepest = std::max(steepest, std::abs(height - before) / (step * report.pixel));
      before = height;
    }
    const double difference = 900.0 + 60.0 + 700.0 + 6e3 * 0.01;
    const double slopes = 60.0 / 900.0 + 60.0 / 700.0 + 0.01 + 0.03;
    EXPECT_LE(steepest, 1.5 * std::sqrt(2.0) / patch.margin * difference + slopes) << angle;
    EXPECT_GT(steepest, 0.1) << angle; // there is a step to be blended
  }
}

// All posts of random blocks, on every level, against other code. Posts are placed to 0.01 pixel of
// a level: `tolerance` is what heights differ by over that in pixels of level 0.
void ExpectAsByHand(const Group& group, const std::vector<PatchFile>& files,
                    const std::vector<TerrainPatch>& patches, const Eigen::Vector2d& about,
                    double tolerance) {
  std::list<PatchByHand> hands;
  for (std::size_t i = 0; i < files.size(); ++i) {
    hands.emplace_back(files[i], patches[i]);
  }
  const PostLattice& lattice = group.base->GetLattice();
  const double between = hands.front().PixelsBetween(group.raster.step / group.parts);
  std::mt19937 random(8);
  std::normal_distribution<double> normal;
  double worst = 0.0;
  for (int level = 0; level < lattice.levels; ++level) {
    std::vector<int> own;
    for (const PatchByHand& hand : hands) {
      own.push_back(std::max(
          0, int(std::lround(std::log2(hand.PixelsBetween(group.raster.step / group.parts)) +
                             level))));
    }
    int blended = 0;
    for (int i = 0; i < 12; ++i) {
      PostBlock block;
      block.level = level;
      block.width = 3 + int(random() % 70);
      block.height = 3 + int(random() % 40);
      const Eigen::Vector2d place = group.Place(about) * std::ldexp(1.0, -level);
      const double spread = std::ldexp(0.3 * files[0].height / between, -level);
      block.column = std::int64_t(place.x() + spread * normal(random)) - block.width / 2;
      block.row = std::int64_t(place.y() + spread * normal(random)) - block.height / 2;
      std::vector<float> heights(std::size_t(block.width) * block.height);
      std::vector<float> under(heights.size());
      group.posts->Read(block, heights.data());
      group.base->Read(block, under.data());
      for (std::size_t k = 0; k < heights.size(); ++k) {
        const std::int64_t c = lattice.Wrapped(level, block.column + std::int64_t(k) % block.width);
        const std::int64_t r = block.row + std::int64_t(k) / block.width;
        const Eigen::Vector2d lonLat =
            group.LonLat(double(lattice.ColumnPlace(level, c)), double(lattice.RowPlace(level, r)));
        const bool inside = r >= 0 && r < lattice.RowsAt(level) &&
                            (lattice.periodic || (c >= 0 && c < lattice.ColumnsAt(level)));
        double expected = under[k];
        std::size_t p = 0;
        for (const PatchByHand& hand : hands) {
          expected = inside ? hand.Over(expected, lonLat, own[p++]) : expected;
        }
        ASSERT_EQ(std::isnan(expected), std::isnan(heights[k])) << level << ": " << c << ", " << r;
        if (!std::isnan(expected)) {
          ASSERT_NEAR(heights[k], expected, std::ldexp(tolerance, own.front()))
              << "level " << level << " post " << c << ", " << r << " at " << lonLat.transpose();
          worst = std::max(worst, std::abs(heights[k] - expected));
          blended += expected != double(under[k]);
        }
      }
    }
    EXPECT_GT(blended, 0) << level;
  }
  EXPECT_GT(worst, 0.0); // not the same code
}

TEST(GroupPosts, OverlappingPatchesWithHolesAreThoseByHand) {
  const TemporaryFolder folder;
  const Base base = Region();
  const PatchFile first = PolarWithHoles();
  const PatchFile second = Cylindrical();
  const std::vector<TerrainPatch> patches = {first.Write(folder / "first.tif"),
                                             second.Write(folder / "second.tif")};
  const Group group(base, base.Write(folder / "base.tif"), patches);
  EXPECT_NEAR(group.posts->Report().patches[0].addedTo, -40.0, 1e-6);
  ExpectAsByHand(group, {first, second}, patches, {25.4, 75.2}, 0.2);
  // In a hole lies the base, and about it all is continuous.
  const Eigen::Vector2d hole = first.LonLatOf({90.5, 130.5});
  std::vector<float> a(1);
  std::vector<float> b(1);
  const Eigen::Vector2d place = group.Place(hole);
  const PostBlock post{0, std::int64_t(place.x()), std::int64_t(place.y()), 1, 1};
  group.posts->Read(post, a.data());
  group.base->Read(post, b.data());
  EXPECT_EQ(a, b);
  double before = group.HeightAt(hole);
  double steepest = 0.0;
  for (double t = 0.0; t < 70.0; t += 0.05) {
    const double height = group.HeightAt(first.LonLatOf({90.5 - t, 130.5}));
    steepest = std::max(steepest, std::abs(height - before) / (0.05 * 108.0));
    before = height;
  }
  EXPECT_LE(steepest, 1.5 * std::sqrt(2.0) / first.margin * 1700.0 + 0.2);
  EXPECT_GT(std::abs(before - group.HeightAt(hole)), 50.0); // there is something to step over
}

Base Globe() {
  Base base = WholeMoon();
  base.formula = [](double lon, double lat) {
    return 1000.0 * std::sin(2.0 * lon * Deg) * std::cos(lat * Deg);
  };
  return base;
}

TEST(GroupPosts, APatchAcrossTheDateLineHasNoSeam) {
  const TemporaryFolder folder;
  const Base base = Globe();
  const std::string path = base.Write(folder / "base.tif");
  const PatchFile patch = AcrossTheDateLine(180.3);
  const TerrainPatch written = patch.Write(folder / "patch.tif");
  const Group group(base, path, {written});
  ExpectAsByHand(group, {patch}, {written}, {-179.9, 20.0}, 0.5);
  // The same in degrees, whichever way the file counts them.
  for (const double shift : {0.0, -360.0, 360.0}) {
    RasterFile file;
    file.width = 200;
    file.height = 150;
    file.crs = "+proj=longlat +R=1737400 +no_defs";
    file.verticalDatum = "sphere";
    file.unit = "m";
    file.geotransform = std::array<double, 6>{176.0 + shift, 0.04, 0, 23.0, 0, -0.04};
    file.value = [](int, int, int) { return 5000.0; };
    TerrainPatch degrees;
    degrees.path = file.Write(folder / "degrees.tif");
    degrees.margin = 20000.0;
    const Group flat(base, path, {degrees});
    for (const double lon : {177.5, 179.99, 180.0, -179.99, -178.0}) {
      EXPECT_NEAR(flat.HeightAt({lon, 20.0}), 5000.0, 1e-3) << shift << " at " << lon;
    }
    EXPECT_LT(flat.HeightAt({-175.5, 20.0}), 1100.0);
  }
}

TEST(GroupPosts, APatchOnAPoleHasOneHeightThere) {
  const TemporaryFolder folder;
  const Base base = Globe();
  PatchFile patch = OnThePole();
  patch.formula = [](const Eigen::Vector2d& m) { return 300.0 + 1e-3 * m.x() + 2e-3 * m.y(); };
  const TerrainPatch written = patch.Write(folder / "patch.tif");
  const Group group(base, base.Write(folder / "base.tif"), {written});
  ExpectAsByHand(group, {patch}, {written}, {40.0, 89.2}, 0.3);
  for (int level = 0; level < 4; ++level) {
    std::vector<float> row(300);
    group.posts->Read({level, -40, 0, 300, 1}, row.data());
    for (const float height : row) {
      ASSERT_EQ(height, row.front());
    }
    EXPECT_NEAR(row.front(), 300.0, 0.1);
  }
}

// What queries rely on: elsewhere a level's cell is the base's.
TEST(GroupPosts, WhereNoPatchReachesPostsAreTheBases) {
  const TemporaryFolder folder;
  const Base base = Region();
  const PatchFile patch = Polar();
  const Group group(base, base.Write(folder / "base.tif"), {patch.Write(folder / "patch.tif")});
  const PostLattice& lattice = group.base->GetLattice();
  std::mt19937 random(12);
  std::normal_distribution<double> normal;
  for (int level = 0; level < lattice.levels - 2; ++level) {
    const double size = std::ldexp(1.0, level);
    int beside = 0;
    for (int i = 0; i < 4000; ++i) {
      const Eigen::Vector2d place =
          group.Place(patch.middle) + 1500.0 * Eigen::Vector2d(normal(random), normal(random));
      if (place.minCoeff() < 0.0 || place.x() > double(lattice.columns - 2) ||
          place.y() > double(lattice.rows - 2) || group.posts->Reaches(place, level)) {
        continue;
      }
      const PostBlock cell{level, std::int64_t(place.x() / size), std::int64_t(place.y() / size), 2,
                           2};
      std::array<float, 4> a = {};
      std::array<float, 4> b = {};
      group.posts->Read(cell, a.data());
      group.base->Read(cell, b.data());
      ASSERT_EQ(a, b) << level << " at " << place.transpose();
      // Not only far away from it.
      const Eigen::Vector2d pixel = patch.PixelOf(group.LonLat(place.x(), place.y()));
      beside += (pixel - Eigen::Vector2d(150.0, 130.0)).norm() < 300.0 + 10.0 * size;
    }
    EXPECT_GT(beside, 0) << level;
  }
}

} // namespace
