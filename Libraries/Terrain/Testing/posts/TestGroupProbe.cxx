// Single posts of a terrain group and the bounds of its blocks, against blocks of posts.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/groups/GroupProbe.h>

#include "Groups.h"

namespace {

using namespace dspace;
using namespace dspace::testing;

// About a place: every post of 64 x 64 to the bit, and the bounds of blocks of all sizes.
void ExpectAsBlocks(const Group& group, const Eigen::Vector2d& lonLat, unsigned seed,
                    double tightest, double rows = 1500.0, double columns = 1500.0) {
  const std::unique_ptr<GroupProbe> probe = group.posts->MakeGroupProbe();
  ASSERT_NE(probe, nullptr);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const PostLattice& lattice = group.posts->GetLattice();
  const Eigen::Vector2d middle = group.Place(lonLat);
  int patched = 0;
  for (int i = 0; i < 60; ++i) {
    const PostBlock block{0, std::int64_t(middle.x() + columns * unit(random)),
                          std::int64_t(middle.y() + rows * unit(random)), 64, 64};
    if (!probe->HasRows(block.row, block.row + 63)) {
      continue;
    }
    std::vector<float> posts(64 * 64);
    std::vector<float> base(64 * 64);
    group.posts->Read(block, posts.data());
    group.base->Read(block, base.data());
    for (int k = 0; k < 64 * 64; ++k) {
      const float height = probe->At(block.column + k % 64, block.row + k / 64);
      ASSERT_TRUE(height == posts[k] || (std::isnan(height) && std::isnan(posts[k])))
          << height << " and " << posts[k] << " at " << block.column + k % 64 << ", "
          << block.row + k / 64;
      patched += posts[k] != base[k] && !std::isnan(posts[k]);
    }
  }
  EXPECT_GT(patched, 2000) << "seed " << seed;
  double widths = 0.0;
  double bounds = 0.0;
  for (int i = 0; i < 400; ++i) {
    const int bits = i % (PatchProbe::Bits + 1);
    const std::int64_t size = std::int64_t(1) << bits;
    const auto c = std::int64_t(std::floor((middle.x() + columns * unit(random)) / double(size)));
    const auto r = std::int64_t(std::floor((middle.y() + rows * unit(random)) / double(size)));
    if (r < 0 || (r + 1) * size >= lattice.rows || !probe->HasRows(r * size, (r + 1) * size)) {
      continue;
    }
    const PostBlock block{0, c * size, r * size, int(size) + 1, int(size) + 1};
    std::vector<float> posts(std::size_t(block.width) * block.height);
    const auto rangeOf = [&](const PostSource& source) {
      source.Read(block, posts.data());
      std::array<double, 2> range = {INFINITY, -INFINITY};
      for (const float height : posts) {
        if (!std::isnan(height)) {
          range = {std::min<double>(range[0], height), std::max<double>(range[1], height)};
        }
      }
      return range;
    };
    const std::array<double, 2> truth = rangeOf(*group.posts);
    const std::array<double, 2> found =
        probe->Over(bits, c, r, [&] { return rangeOf(*group.base); });
    if (truth[0] > truth[1]) {
      continue;
    }
    EXPECT_LE(found[0], truth[0]) << "2^" << bits << " cells, " << c << ", " << r;
    EXPECT_GE(found[1], truth[1]) << "2^" << bits << " cells, " << c << ", " << r;
    if (bits >= 2 && bits <= 5) {
      widths += truth[1] - truth[0];
      bounds += std::min(found[1] - found[0], 1e6);
    }
  }
  EXPECT_LT(bounds, tightest * widths);
}

TEST(GroupProbe, PostsInOtherProjectionsWithHolesAreThoseOfBlocks) {
  const TemporaryFolder folder;
  const Base base = Region();
  const PatchFile first = PolarWithHoles();
  const PatchFile second = Cylindrical();
  const Group group(base, base.Write(folder / "base.tif"),
                    {first.Write(folder / "first.tif"), second.Write(folder / "second.tif")});
  ExpectAsBlocks(group, {25.4, 75.2}, 1, 20.0);
}

TEST(GroupProbe, InsideAPatchBoundsAreNarrow) {
  const TemporaryFolder folder;
  const Base base = Region();
  PatchFile patch = Polar();
  patch.margin = 300.0;
  const Group group(base, base.Write(folder / "base.tif"), {patch.Write(folder / "patch.tif")}, 8);
  ExpectAsBlocks(group, {25.2, 75.1}, 2, 3.0);
}

TEST(GroupProbe, PostsAboutABodyAreThoseOfBlocks) {
  const TemporaryFolder folder;
  const Base base = WholeMoon();
  const std::string path = base.Write(folder / "base.tif");
  const Group line(base, path, {AcrossTheDateLine(180.0).Write(folder / "line.tif")});
  ExpectAsBlocks(line, {-179.9, 20.0}, 3, 20.0, 150.0, 200.0);
  ExpectAsBlocks(line, {179.9, 20.0}, 4, 20.0, 150.0, 200.0);
  const Group pole(base, path, {OnThePole().Write(folder / "pole.tif")});
  ExpectAsBlocks(pole, {40.0, 88.2}, 5, 20.0, 60.0);
}

} // namespace
