// What of ruts reaches a clipmap: its textures after any change, and how much is rolled over.
#include <cstring>
#include <thread>

#include <gtest/gtest.h>

#include "WheelTrackTestSupport.h"

#include <dspace/Error.h>

namespace dspace::testing {
namespace {

// After each of a hundred additions the textures are those of a first upload from a new pyramid,
// byte for byte, and only what changed goes up.
TEST(WheelTracks, TexturesFollowByteForByte) {
  constexpr int Cells = 60;
  Ground ground(801, Hills, Cells);
  const auto pyramid = std::make_shared<ElevationPyramid>(ground.posts);
  ClipmapLevels levels(pyramid, Cells);
  const ClipmapGeometry geometry(Cells);
  const std::size_t side = geometry.Texels();
  std::vector<std::vector<ClipmapTexel>> textures(levels.Count(),
                                                  std::vector<ClipmapTexel>(side * side));
  std::size_t uploaded = 0;
  const auto upload = [&](int level, const ClipmapUpdate& u, const ClipmapTexel* texels) {
    for (int j = 0; j < u.height; ++j) {
      std::copy_n(texels + std::size_t(j) * u.width, u.width,
                  textures[level].begin() + std::ptrdiff_t(u.y + j) * std::ptrdiff_t(side) + u.x);
    }
    uploaded += std::size_t(u.width) * u.height;
  };
  std::mt19937 random(21);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::map<std::string, TrackContact> wheels;
  Eigen::Vector2d place(400.0, 400.0);
  for (int n = 0; n < 100; ++n) {
    // Two of three wheels roll on by some centimetres, now and then far away.
    std::vector<TrackAddition> additions;
    for (int w = 0; w < 2; ++w) {
      const std::string name = "wheel " + std::to_string((n + w) % 3);
      TrackContact& at = wheels[name];
      at.place += n % 10 == 9 ? Eigen::Vector2d(3.0 * unit(random), 3.0 * unit(random))
                              : Eigen::Vector2d(0.05 * unit(random), 0.05 * unit(random));
      at.place = at.place.cwiseMax(-9.5).cwiseMin(9.5);
      at.sinkage = 0.04 + 0.02 * unit(random);
      additions.push_back(Stroke(name, Rut(), {at}));
    }
    pyramid->Invalidate(ground.posts->RectanglesOf(ground.tracks->Add(additions)));
    if (n % 3 == 2) { // the view moves, too
      place += 12.0 * Eigen::Vector2d(unit(random), unit(random));
    }
    ClipmapLevels::View where;
    where.place = place;
    where.height = 0.5;
    where.cellSize = Post;
    where.wait = 60.0;
    uploaded = 0;
    const ClipmapLevels::State state = levels.Update(where, upload);
    ASSERT_TRUE(state.complete);
    if (n > 0 && n % 3 != 2 && n % 10 < 8) {
      // Some dozen posts a side about each wheel, of five levels; all of it is 3969 posts a level.
      EXPECT_LT(uploaded, 2u * 2u * 5u * 40u * 40u) << n;
      EXPECT_GT(uploaded, 0u) << n;
    }
    ClipmapLevels fresh(std::make_shared<ElevationPyramid>(ground.posts), Cells);
    const ClipmapLevels::State again =
        fresh.Update(where, [](int, const ClipmapUpdate&, const ClipmapTexel*) {});
    ASSERT_EQ(again.finest, state.finest);
    for (int level = state.finest; level < levels.Count(); ++level) {
      const ClipmapWindow& window = levels.Window(level);
      for (std::int64_t r = window.row - 1; r <= window.row + Cells + 1; ++r) {
        for (std::int64_t c = window.column - 1; c <= window.column + Cells + 1; ++c) {
          const std::size_t at = std::size_t(geometry.Texel(r)) * side + geometry.Texel(c);
          ASSERT_EQ(
              std::memcmp(&textures[level][at], &fresh.Texel(level, c, r), sizeof(ClipmapTexel)), 0)
              << "addition " << n << ", level " << level << ", post " << c << ", " << r;
        }
      }
    }
  }
}

// Reads wait while it is closed.
class GatedPosts : public PostSource {
public:
  explicit GatedPosts(std::shared_ptr<const PostSource> source) : Source_(std::move(source)) {}
  const std::string& GetName() const override { return this->Source_->GetName(); }
  const PostLattice& GetLattice() const override { return this->Source_->GetLattice(); }
  void Read(const PostBlock& block, float* heights) const override {
    while (this->closed) {
      std::this_thread::yield();
    }
    this->Source_->Read(block, heights);
  }
  std::atomic<bool> closed{false};

private:
  std::shared_ptr<const PostSource> Source_;
};

// An interactive picture has no part that vanishes while what changed is on its way.
TEST(WheelTracks, UntilAChangeIsThereTheOldPostsAreDrawn) {
  Ground ground;
  const auto gate = std::make_shared<GatedPosts>(ground.posts);
  const auto pyramid = std::make_shared<ElevationPyramid>(gate);
  ClipmapLevels levels(pyramid, 124);
  ClipmapLevels::View where;
  where.place = {400.0, 400.0};
  where.height = 0.5;
  where.cellSize = Post;
  where.wait = 60.0;
  std::size_t uploaded = 0;
  const auto upload = [&uploaded](int, const ClipmapUpdate& u, const ClipmapTexel*) {
    uploaded += std::size_t(u.width) * u.height;
  };
  ASSERT_EQ(levels.Update(where, upload).finest, 0);
  const float before = levels.Texel(0, 400, 400).height;
  gate->closed = true;
  pyramid->Invalidate(ground.posts->RectanglesOf(
      ground.tracks->Add({Stroke("wheel", Rut(), {{{-1.0, 0.0}, 0.05}, {{1.0, 0.0}, 0.05}})})));
  where.wait.reset();
  uploaded = 0;
  for (int n = 0; n < 3; ++n) {
    const ClipmapLevels::State state = levels.Update(where, upload);
    EXPECT_EQ(state.finest, 0);
    EXPECT_FALSE(state.complete);
    EXPECT_EQ(levels.Texel(0, 400, 400).height, before);
  }
  EXPECT_EQ(uploaded, 0u);
  gate->closed = false;
  while (!levels.Update(where, upload).complete) {
    std::this_thread::yield();
  }
  EXPECT_LT(levels.Texel(0, 400, 400).height, before - 0.04f);
  uploaded = 0;
  EXPECT_TRUE(levels.Update(where, upload).complete);
  EXPECT_EQ(uploaded, 0u); // once
}

// Where a lattice goes around a body the window and the change may be in different turns.
TEST(WheelTracks, ChangesAroundABodyReachTheTextures) {
  auto bump = std::make_shared<std::pair<double, double>>(-100.0, -100.0);
  const auto base = std::make_shared<FormulaPosts>(
      1024, 513, true,
      [bump](double c, double r) {
        return c == bump->first && r == bump->second ? 7.0 : 0.01 * c + 0.02 * r;
      },
      60);
  const auto pyramid = std::make_shared<ElevationPyramid>(base);
  ClipmapLevels levels(pyramid, 60);
  std::mt19937 random(7);
  double column = 10.0;
  for (int n = 0; n < 60; ++n) {
    ClipmapLevels::View where;
    column += double(random() % 120) - 20.0; // around several times
    where.place = {std::fmod(column, 1024.0), 250.0 + double(random() % 20)};
    where.height = 30.0;
    where.wait = 60.0;
    const auto none = [](int, const ClipmapUpdate&, const ClipmapTexel*) {};
    levels.Update(where, none);
    const auto old = *bump;
    *bump = {double((int(column) + int(random() % 40) - 20 + 2048) % 1024),
             240.0 + double(random() % 40)};
    pyramid->Invalidate({{std::int64_t(old.first), std::int64_t(old.second), 1, 1},
                         {std::int64_t(bump->first), std::int64_t(bump->second), 1, 1}});
    const ClipmapLevels::State state = levels.Update(where, none);
    ClipmapLevels fresh(std::make_shared<ElevationPyramid>(base), 60);
    fresh.Update(where, none);
    for (int level = state.finest; level < levels.Count(); ++level) {
      const ClipmapWindow& window = levels.Window(level);
      const std::int64_t turn =
          (window.column - fresh.Window(level).column); // whole turns apart, or none
      for (std::int64_t r = window.row - 1; r <= window.row + 61; ++r) {
        for (std::int64_t c = window.column - 1; c <= window.column + 61; ++c) {
          const ClipmapTexel& a = levels.Texel(level, c, r);
          const ClipmapTexel& b = fresh.Texel(level, c - turn, r);
          ASSERT_EQ(std::memcmp(&a, &b, sizeof(ClipmapTexel)), 0)
              << "step " << n << ", level " << level << ", post " << c << ", " << r;
        }
      }
    }
  }
}

// Half of the weight stands where holes have a 1.
TEST(WheelTracks, TexelsTellHowMuchIsRolledOver) {
  Ground ground;
  ground.tracks->Add({Stroke("wheel", Rut(), {{{-2.0, 0.0}, 0.05}, {{2.0, 0.0}, 0.05}})});
  ClipmapLevels levels(std::make_shared<ElevationPyramid>(ground.posts), 124);
  ClipmapLevels::View where;
  where.place = {400.0, 400.0};
  where.height = 0.5;
  where.cellSize = Post;
  where.wait = 60.0;
  ASSERT_EQ(levels.Update(where, [](int, const ClipmapUpdate&, const ClipmapTexel*) {}).finest, 0);
  EXPECT_TRUE(levels.HasTracks(0));
  EXPECT_FALSE(levels.HasHoles(0));
  for (std::int64_t r = 380; r <= 420; ++r) { // y = 0 is row 400
    const double y = Post * std::abs(double(r - 400));
    const double weight = y <= 0.12 ? 1.0 : std::max(0.0, (0.18 - y) / 0.06);
    EXPECT_NEAR(levels.Texel(0, 400, r).hole, 0.5 * weight, 1e-6) << r;
  }
}

} // namespace
} // namespace dspace::testing
