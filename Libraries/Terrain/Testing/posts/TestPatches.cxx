// Patches of terrain groups: their weights, and what is rejected or warned of.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/groups/GroupPosts.h>
#include <dspace/groups/PatchWeight.h>

#include "Groups.h"
#include "Patches.h"
#include "RasterFile.h"

namespace {

using namespace dspace;
using namespace dspace::testing;

// Over 4 million pixels, a weight stands for 2 x 2 of them: still within the stated distances.
TEST(Patches, WeightsOfLargePatches) {
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

TEST(Patches, WhatAddsNothingSaysSo) {
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
  // The good one is there as if it were alone.
  const Group alone(base, path, {used});
  const Eigen::Vector2d place = group.Place(good.middle);
  const PostBlock block{0, std::int64_t(place.x()) - 60, std::int64_t(place.y()) - 60, 120, 120};
  std::vector<float> a(120 * 120);
  std::vector<float> b(120 * 120);
  group.posts->Read(block, a.data());
  alone.posts->Read(block, b.data());
  EXPECT_EQ(a, b);
  EXPECT_NEAR(group.HeightAt(good.middle), good.FormulaAt(good.middle), 0.3);
}

std::string MessageOf(const Base& base, const std::string& path, const TerrainPatch& patch) {
  try {
    const Group group(base, path, {patch});
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(Patches, RejectsOtherBodiesAndMargins) {
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

TEST(Patches, DatumsThatCannotBeConvertedAreNamed) {
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
