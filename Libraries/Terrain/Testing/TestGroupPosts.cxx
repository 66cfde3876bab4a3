// Terrain groups against formulas, and post by post against other code (Patches.h).
#include <algorithm>
#include <cmath>
#include <list>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/terrain/GroupPosts.h>
#include <dspace/terrain/PatchWeight.h>
#include <dspace/terrain/RasterPosts.h>

#include "Patches.h"
#include "RasterFile.h"

namespace {

using namespace dspace;
using namespace dspace::testing;

// A raster in degrees, on which patches lie.
struct Base {
  int width = 0;
  int height = 0;
  double step = 1.0; // [deg]
  double west = 0.0;
  double north = 90.0;
  bool globe = false; // goes around, with poles
  std::string datum = "sphere";
  std::function<double(double lon, double lat)> formula;

  std::string Write(const std::string& path) const {
    RasterFile file;
    file.width = this->width;
    file.height = this->height;
    file.crs = "+proj=longlat +R=1737400 +no_defs";
    file.verticalDatum = this->datum;
    file.unit = "m";
    file.geotransform =
        std::array<double, 6>{this->west, this->step, 0, this->north, 0, -this->step};
    file.value = [this](int c, int r, int) {
      return this->formula(this->west + (c + 0.5) * this->step,
                           this->north - (r + 0.5) * this->step);
    };
    return file.Write(path);
  }
};

struct Group {
  std::shared_ptr<const RasterPosts> base;
  std::shared_ptr<const GroupPosts> posts;
  double parts = 1.0; // posts a pixel of the base
  Base raster;

  Group(const Base& from, const std::string& path, const std::vector<TerrainPatch>& patches,
        int least = 0)
      : raster(from) {
    const auto source = std::make_shared<const ElevationSource>(path);
    OpenPatches opened(source->Info(), patches);
    RasterPostsOptions options;
    options.subdivisions = std::max(opened.Subdivisions(), least);
    options.periodic = from.globe;
    options.poles = from.globe;
    options.coarsest = 8;
    this->base = std::make_shared<const RasterPosts>(source, options);
    this->parts = std::ldexp(1.0, options.subdivisions);
    Eigen::Affine2d postToPixel = Eigen::Affine2d::Identity();
    postToPixel.linear() /= this->parts;
    postToPixel.translation() << 0.5, from.globe ? 0.0 : 0.5;
    this->posts = std::make_shared<const GroupPosts>(
        this->base, source->Info().pixelToMap * postToPixel, from.globe, std::move(opened));
  }
  // Of a level-0 place.
  Eigen::Vector2d LonLat(double c, double r) const {
    return {this->raster.west + (c / this->parts + 0.5) * this->raster.step,
            this->raster.north -
                (r / this->parts + (this->raster.globe ? 0.0 : 0.5)) * this->raster.step};
  }
  Eigen::Vector2d Place(const Eigen::Vector2d& lonLat) const {
    return {
        ((lonLat.x() - this->raster.west) / this->raster.step - 0.5) * this->parts,
        ((this->raster.north - lonLat.y()) / this->raster.step - (this->raster.globe ? 0.0 : 0.5)) *
            this->parts};
  }
  // The surface between posts of level 0.
  double HeightAt(const Eigen::Vector2d& lonLat) const {
    const Eigen::Vector2d p = this->Place(lonLat);
    const auto c = std::int64_t(std::floor(p.x()));
    const auto r = std::int64_t(std::floor(p.y()));
    std::array<float, 4> h = {};
    this->posts->Read({0, c, r, 2, 2}, h.data());
    const double u = p.x() - double(c);
    const double v = p.y() - double(r);
    return (1.0 - std::max(u, v)) * h[0] + std::min(u, v) * h[3] +
           std::abs(u - v) * (v > u ? h[2] : h[1]);
  }
};

double Plain(double lon, double lat) {
  return 700.0 * std::sin(lon * Deg * 9.0) * std::cos(lat * Deg * 7.0);
}

Base Region() { // lon 20 to 30, lat 72 to 78
  Base base;
  base.width = 200;
  base.height = 120;
  base.step = 0.05;
  base.west = 20.0;
  base.north = 78.0;
  base.formula = Plain;
  return base;
}

PatchFile Polar() {
  PatchFile patch;
  patch.projection = PolarStereographic(10.0);
  patch.middle = {25.2, 75.1};
  patch.width = 301;
  patch.height = 260;
  patch.size = 110.0;
  patch.margin = 3500.0;
  patch.formula = [](const Eigen::Vector2d& m) {
    return 900.0 + 60.0 * std::sin(m.x() / 900.0) * std::cos(m.y() / 700.0) + 0.01 * m.x();
  };
  return patch;
}

PatchFile Cylindrical() {
  PatchFile patch;
  patch.projection = EquidistantCylindrical(24.0, 60.0);
  patch.middle = {25.6, 75.3};
  patch.width = 240;
  patch.height = 310;
  patch.size = 61.0;
  patch.margin = 1700.0;
  patch.formula = [](const Eigen::Vector2d& m) {
    return -300.0 + 20.0 * std::cos(m.x() / 500.0 + m.y() / 1300.0);
  };
  return patch;
}

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
  PatchFile first = Polar();
  first.added = -40.0;
  first.hole = [](int c, int r) {
    return (c - 90) * (c - 90) + (r - 130) * (r - 130) < 500 || (c == 200 && r == 100);
  };
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
  Base base;
  base.width = 192;
  base.height = 96;
  base.step = 360.0 / 192.0;
  base.west = -180.0;
  base.globe = true;
  base.formula = [](double lon, double lat) {
    return 1000.0 * std::sin(2.0 * lon * Deg) * std::cos(lat * Deg);
  };
  return base;
}

TEST(GroupPosts, APatchAcrossTheDateLineHasNoSeam) {
  const TemporaryFolder folder;
  const Base base = Globe();
  const std::string path = base.Write(folder / "base.tif");
  PatchFile patch = Cylindrical();
  patch.projection = EquidistantCylindrical(180.0, 0.0);
  patch.middle = {180.3, 20.0};
  patch.size = 1200.0;
  patch.margin = 40000.0;
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
  PatchFile patch = Polar();
  patch.middle = {10.0, 89.0};
  patch.size = 500.0;
  patch.margin = 20000.0;
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

// Over 4 million pixels, a weight stands for 2 x 2 of them: still within the stated distances.
TEST(GroupPosts, WeightsOfLargePatches) {
  const TemporaryFolder folder;
  constexpr int Size = 2200;
  const std::vector<Eigen::Vector2i> holes = {{400, 700}, {1501, 333}, {1502, 1800}, {900, 901}};
  RasterFile file;
  file.width = Size;
  file.height = Size;
  file.type = GDT_Byte;
  file.noData = 255.0;
  file.geotransform = std::array<double, 6>{0, 3.0, 0, 0, 0, -3.0};
  file.value = [&](int c, int r, int) {
    const bool hole = std::find(holes.begin(), holes.end(), Eigen::Vector2i(c, r)) != holes.end();
    return hole ? 255.0 : double((c + r) % 200);
  };
  const ElevationSource source(file.Write(folder / "large.tif"));
  constexpr double Margin = 120.0;
  const PatchWeight weight(source, {3.0, 3.0}, Margin);
  EXPECT_FALSE(weight.Empty());
  EXPECT_TRUE(weight.HeightsAreExact());
  EXPECT_EQ(weight.Heights(), (std::array<double, 2>{0.0, 199.0}));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int between = 0;
  for (int i = 0; i < 40000; ++i) {
    Eigen::Vector2d pixel(unit(random) * Size, unit(random) * Size);
    if (i % 2 == 0) {
      const Eigen::Vector2d hole = holes[std::size_t(i / 2) % holes.size()].cast<double>();
      pixel = hole + Eigen::Vector2d::Constant(0.5) +
              70.0 * Eigen::Vector2d(unit(random) - 0.5, unit(random) - 0.5);
    }
    double distance = std::min({pixel.x() + 0.5, Size - pixel.x() + 0.5, pixel.y() + 0.5,
                                Size - pixel.y() + 0.5}); // to the middles of what is not there
    for (const Eigen::Vector2i& hole : holes) {
      distance =
          std::min(distance, (pixel - hole.cast<double>() - Eigen::Vector2d::Constant(0.5)).norm());
    }
    const double w = weight.At(pixel, 0);
    // To two cells of 2 pixels, for where holes lie in theirs and for what is between weights.
    const auto rise = [&](double pixels) {
      const double s = std::clamp((3.0 * pixels - 3.0 * 6.0) / Margin, 0.0, 1.0);
      return s * s * (3.0 - 2.0 * s);
    };
    ASSERT_GE(w, rise(distance - 4.0) - 1e-6) << pixel.transpose();
    ASSERT_LE(w, rise(distance + 4.0) + 1e-6) << pixel.transpose();
    if (distance < 1.5) {
      ASSERT_EQ(w, 0.0); // no triangle with a post without data counts
    }
    between += w > 0.0 && w < 1.0;
  }
  EXPECT_GT(between, 5000);
}

TEST(GroupPosts, WhatAddsNothingSaysSo) {
  const TemporaryFolder folder;
  Base base = Region();
  const std::string path = base.Write(folder / "base.tif");
  PatchFile none = Polar();
  none.hole = [](int, int) { return true; };
  TerrainPatch empty = none.Write(folder / "empty.tif");
  empty.name = "the empty one";
  PatchFile away = Polar();
  away.middle = {200.0, 75.0};
  const TerrainPatch far = away.Write(folder / "far.tif");
  const PatchFile good = Cylindrical();
  const TerrainPatch used = good.Write(folder / "good.tif");
  const Group group(base, path, {empty, far, used});
  const GroupReport& report = group.posts->Report();
  ASSERT_EQ(report.patches.size(), 3u);
  EXPECT_FALSE(report.patches[0].used);
  EXPECT_FALSE(report.patches[1].used);
  EXPECT_TRUE(report.patches[2].used);
  ASSERT_EQ(report.warnings.size(), 2u);
  EXPECT_NE(report.warnings[0].find("'the empty one' is wholly without data"), std::string::npos);
  EXPECT_NE(report.warnings[1].find("far.tif' lies wholly outside"), std::string::npos);
  ExpectAsByHand(group, {good}, {used}, {25.6, 75.3}, 0.3);
}

std::string MessageOf(const Base& base, const std::string& path, const TerrainPatch& patch) {
  try {
    const Group group(base, path, {patch});
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(GroupPosts, RefusesOtherBodiesAndMargins) {
  const TemporaryFolder folder;
  const Base base = Region();
  const std::string path = base.Write(folder / "base.tif");
  const TerrainPatch good = Polar().Write(folder / "patch.tif");
  TerrainPatch mars = good;
  mars.elevation.crs = "+proj=stere +lat_0=90 +R=3396190 +no_defs";
  const std::string body = MessageOf(base, path, mars);
  EXPECT_NE(body.find("patch.tif"), std::string::npos) << body;
  EXPECT_NE(body.find("3396190"), std::string::npos) << body;
  EXPECT_NE(body.find("1737400"), std::string::npos) << body;
  for (const double margin : {0.0, -1.0, std::nan(""), 1.0 / 0.0}) {
    TerrainPatch bad = good;
    bad.margin = margin;
    EXPECT_NE(MessageOf(base, path, bad).find("margin"), std::string::npos) << margin;
  }
  TerrainPatch wide = good;
  wide.margin = 1e6;
  const Group group(base, path, {wide});
  ASSERT_EQ(group.posts->Report().warnings.size(), 1u);
  EXPECT_NE(group.posts->Report().warnings[0].find("blended everywhere"), std::string::npos);
  TerrainPatch missing = good;
  missing.path = folder / "missing.tif";
  EXPECT_NE(MessageOf(base, path, missing).find("missing.tif"), std::string::npos);
}

TEST(GroupPosts, DatumsThatCannotBeConvertedAreNamed) {
  const TemporaryFolder folder;
  Base base = Region();
  base.datum = "relative";
  const std::string path = base.Write(folder / "base.tif");
  const Group group(base, path, {Polar().Write(folder / "patch.tif")});
  ASSERT_EQ(group.posts->Report().warnings.size(), 1u);
  const std::string& warning = group.posts->Report().warnings[0];
  EXPECT_NE(warning.find("sphere:1737400"), std::string::npos) << warning;
  EXPECT_NE(warning.find("relative"), std::string::npos) << warning;
  EXPECT_EQ(group.posts->Report().patches[0].addedTo, 0.0);
}

} // namespace
