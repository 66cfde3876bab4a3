// Ruts in posts against formulas, and what of them reaches a clipmap.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <complex>
#include <cstring>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "FormulaPosts.h"

#include <dspace/Error.h>
#include <dspace/terrain/TrackPosts.h>

namespace {

using namespace dspace;
using dspace::testing::FormulaPosts;

double Hills(double c, double r) {
  return 0.3 * std::sin(0.05 * c) * std::cos(0.04 * r);
}

// Counts what is read of it.
class CountedPosts : public FormulaPosts {
public:
  using FormulaPosts::FormulaPosts;
  void Read(const PostBlock& block, float* heights) const override {
    ++this->reads;
    FormulaPosts::Read(block, heights);
  }
  mutable std::atomic<int> reads{0};
};

constexpr double Post = 0.025; // [m]

Eigen::Affine2d PostToScene() {
  Eigen::Affine2d map = Eigen::Affine2d::Identity();
  map.linear() << Post, 0.0, 0.0, -Post;
  map.translation() << -10.0, 10.0;
  return map;
}

struct Ground {
  std::shared_ptr<CountedPosts> base;
  std::shared_ptr<WheelTracks> tracks;
  std::shared_ptr<TrackPosts> posts;
  explicit Ground(std::int64_t side = 801, FormulaPosts::Formula formula = Hills, int cells = 124,
                  const WheelTracksOptions& options = {})
      : base(std::make_shared<CountedPosts>(side, side, false, std::move(formula), cells)),
        tracks(std::make_shared<WheelTracks>("ground", options)),
        posts(std::make_shared<TrackPosts>(base, tracks, PostToScene())) {}
  std::vector<float> Read(int level, const PostSource& source) const {
    const int columns = int(this->base->GetLattice().ColumnsAt(level));
    const int rows = int(this->base->GetLattice().RowsAt(level));
    std::vector<float> heights(std::size_t(columns) * rows);
    source.Read({level, 0, 0, columns, rows}, heights.data());
    return heights;
  }
};

TrackProfile Rut() {
  TrackProfile profile;
  profile.width = 0.24;
  profile.wall = 0.06;
  profile.rimWidth = 0.1;
  profile.rimHeight = 0.02;
  profile.treadPitch = 0.2;
  profile.treadDepth = 0.015;
  return profile;
}

TrackAddition Stroke(const std::string& name, const TrackProfile& profile,
                     std::vector<TrackContact> contacts, bool exact = false) {
  TrackAddition addition;
  addition.name = name;
  addition.profile = profile;
  addition.contacts = std::move(contacts);
  addition.exact = exact;
  return addition;
}

// A wheel that wanders, sinks here and there, and slips.
std::vector<TrackContact> Wander(std::mt19937& random, int steps, bool headings) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<TrackContact> contacts;
  Eigen::Vector2d p(8.0 * unit(random), 8.0 * unit(random));
  double course = 3.0 * unit(random);
  double rolled = unit(random);
  for (int i = 0; i < steps; ++i) {
    TrackContact c;
    c.place = p;
    c.sinkage = 0.05 + 0.03 * unit(random);
    c.rolled = rolled;
    c.heading = headings ? course + 0.2 * unit(random) : TrackContact::Unknown;
    contacts.push_back(c);
    course += 0.5 * unit(random);
    p += 0.15 * Eigen::Vector2d(std::cos(course), std::sin(course));
    rolled += 0.17;
  }
  return contacts;
}

// By other code: complex numbers, and every line looked at. Less than -1: nothing is there.
double DepthAt(const std::vector<TrackStroke>& strokes, std::complex<double> q) {
  double deepest = -9.0;
  double nearest = 1e9; // of a rut's edge, and its rim's depth
  double rim = 0.0;
  for (const TrackStroke& stroke : strokes) {
    const TrackProfile& p = stroke.profile;
    for (std::size_t i = 0; i + 1 < stroke.contacts.size(); ++i) {
      const TrackContact& a = stroke.contacts[i];
      const TrackContact& b = stroke.contacts[i + 1];
      const std::complex<double> from(a.place.x(), a.place.y());
      const std::complex<double> to(b.place.x(), b.place.y());
      const std::complex<double> local = (q - from) / (to - from); // along: its real part
      const double t = std::min(1.0, std::max(0.0, local.real()));
      const std::complex<double> away = (local - t) * (to - from);
      const double d = std::abs(away) - p.width / 2;
      if (d > p.wall + p.rimWidth) {
        continue;
      }
      if (d > p.wall) {
        const double middle = d - p.wall - p.rimWidth / 2; // a parabola that is 0 at both ends
        if (d - p.wall < nearest) {
          nearest = d - p.wall;
          rim = p.rimHeight * (middle * middle * 4.0 / p.rimWidth / p.rimWidth - 1.0);
        }
        continue;
      }
      const auto unit = [&](double heading) {
        return std::isnan(heading) ? (to - from) / std::abs(to - from) : std::polar(1.0, heading);
      };
      std::complex<double> axis = (1.0 - t) * unit(a.heading) + t * unit(b.heading);
      axis /= std::abs(axis);
      const double s = (1.0 - t) * a.rolled + t * b.rolled + (away * std::conj(axis)).real();
      const double bar = std::pow(std::sin(M_PI * s / p.treadPitch), 2);
      const double floor = (1.0 - t) * a.sinkage + t * b.sinkage + p.treadDepth * bar;
      deepest = std::max(deepest, floor * std::min(1.0, (p.wall - d) / p.wall));
    }
  }
  return deepest < -1.0 && nearest < 1e9 ? rim : deepest;
}

TEST(WheelTracks, AStraightRutIsItsFormula) {
  Ground ground(801, [](double, double) { return 2.0; });
  const TrackProfile rut = Rut();
  // East from (-5, 1), one metre a contact; the wheel turns as fast as it moves.
  std::vector<TrackContact> contacts;
  for (int i = 0; i <= 10; ++i) {
    contacts.push_back({{-5.0 + i, 1.0}, 0.05, 0.0, double(i)});
  }
  ground.tracks->Add({Stroke("wheel", rut, contacts)});
  const std::vector<float> heights = ground.Read(0, *ground.posts);
  int floors = 0;
  int rims = 0;
  for (int r = 0; r < 801; ++r) {
    for (int c = 0; c < 801; ++c) {
      const double x = -10.0 + Post * c;
      const double y = std::abs(10.0 - Post * r - 1.0);
      if (x < -5.0 || x > 5.0) {
        continue;
      }
      const double bars = 0.015 * 0.5 * (1.0 - std::cos(2.0 * M_PI * (x + 5.0) / 0.2));
      double expected = 2.0;
      if (y <= 0.12) {
        expected -= 0.05 + bars;
        ++floors;
      } else if (y <= 0.18) {
        expected -= (0.05 + bars) * (0.18 - y) / 0.06;
      } else if (y <= 0.28) {
        expected += 0.02 * 4.0 * (y - 0.18) / 0.1 * (1.0 - (y - 0.18) / 0.1);
        ++rims;
      }
      ASSERT_NEAR(heights[std::size_t(r) * 801 + c], expected, 1e-6) << x << ", " << y;
    }
  }
  EXPECT_GT(floors, 3000);
  EXPECT_GT(rims, 2500);
}

TEST(WheelTracks, WanderingRutsAreTheDeepestOfTheirLines) {
  Ground ground;
  std::mt19937 random(4);
  std::vector<TrackStroke> strokes;
  for (int n = 0; n < 12; ++n) {
    const TrackAddition stroke =
        Stroke("wheel " + std::to_string(n), Rut(), Wander(random, 25, n % 2 == 0), true);
    strokes.push_back(stroke);
    ground.tracks->Add({stroke});
  }
  const std::vector<float> before = ground.Read(0, *ground.base);
  const std::vector<float> heights = ground.Read(0, *ground.posts);
  int touched = 0;
  for (int r = 0; r < 801; ++r) {
    for (int c = 0; c < 801; ++c) {
      const std::size_t at = std::size_t(r) * 801 + c;
      const double depth = DepthAt(strokes, {-10.0 + Post * c, 10.0 - Post * r});
      if (depth < -1.0) {
        ASSERT_EQ(heights[at], before[at]);
        continue;
      }
      // Sinkages and headings are kept as floats.
      ASSERT_NEAR(heights[at], before[at] - depth, 2e-6) << c << ", " << r;
      ++touched;
    }
  }
  EXPECT_GT(touched, 20000);
}

TEST(WheelTracks, OrderDoesNotMatter) {
  std::mt19937 random(8);
  std::vector<TrackAddition> additions;
  for (int n = 0; n < 30; ++n) {
    additions.push_back(Stroke("wheel " + std::to_string(n), Rut(), Wander(random, 20, true)));
  }
  Ground first;
  for (const TrackAddition& addition : additions) {
    first.tracks->Add({addition});
  }
  std::shuffle(additions.begin(), additions.end(), random);
  Ground second;
  second.tracks->Add(additions);
  for (int level = 0; level < first.base->GetLattice().levels; ++level) {
    const std::vector<float> a = first.Read(level, *first.posts);
    const std::vector<float> b = second.Read(level, *second.posts);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0) << level;
  }
}

TEST(WheelTracks, CoarserLevelsShowTheMeanOverTheirCells) {
  Ground ground(801, [](double, double) { return 0.0; });
  std::mt19937 random(5);
  std::vector<TrackStroke> strokes;
  for (int n = 0; n < 4; ++n) {
    strokes.push_back(Stroke("wheel " + std::to_string(n), Rut(), Wander(random, 25, true), true));
    ground.tracks->Add({Stroke(strokes.back().name, Rut(), strokes.back().contacts, true)});
  }
  const double width = 0.24 + 2 * (0.06 + 0.1); // 0.56 m: level 6 has posts 1.6 m apart, 7 3.2 m
  for (int level = 1; level < 4; ++level) {
    const PostLattice& lattice = ground.base->GetLattice();
    const auto columns = std::size_t(lattice.ColumnsAt(level));
    std::vector<float> heights(columns * columns);
    std::vector<float> weights(heights.size());
    ASSERT_TRUE(ground.posts->ReadWithTracks({level, 0, 0, int(columns), int(columns)},
                                             heights.data(), weights.data()));
    const int n = std::min(1 << level, 8);
    int touched = 0;
    for (int m = 0; m < 4000; ++m) {
      const std::size_t c = random() % (columns - 2) + 1;
      const std::size_t r = random() % (columns - 2) + 1;
      double sum = 0.0;
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          const double x = std::ldexp(double(c) + (i + 0.5) / n - 0.5, level);
          const double y = std::ldexp(double(r) + (j + 0.5) / n - 0.5, level);
          const double depth = DepthAt(strokes, {-10.0 + Post * x, 10.0 - Post * y});
          sum += depth < -1.0 ? 0.0 : depth;
        }
      }
      ASSERT_NEAR(heights[r * columns + c], -sum / (n * n), 2e-6) << level;
      ASSERT_GE(weights[r * columns + c], 0.0f);
      ASSERT_LE(weights[r * columns + c], 1.0f);
      touched += sum != 0.0;
    }
    EXPECT_GT(touched, 50);
  }
  // Narrower than a quarter of a post it is not shown.
  Ground large(80001, [](double, double) { return 0.0; });
  large.tracks->Add({Stroke("wheel", Rut(), {{{0.0, 0.0}, 0.1}, {{30.0, 0.0}, 0.1}})});
  for (int level = 0; level < large.base->GetLattice().levels; ++level) {
    const int around = 400 >> std::min(level, 8); // of the stroke's middle
    const std::int64_t c = ((400 + 600) >> level) - around;
    const std::int64_t r = (400 >> level) - around;
    std::vector<float> heights(std::size_t(2 * around + 3) * (2 * around + 3));
    large.posts->Read({level, c, r, 2 * around + 3, 2 * around + 3}, heights.data());
    const bool lowered =
        std::any_of(heights.begin(), heights.end(), [](float h) { return h < 0.0f; });
    EXPECT_EQ(lowered, std::ldexp(Post, level) <= 4.0 * width) << level;
  }
}

TEST(WheelTracks, ClearingRestoresEveryByte) {
  Ground ground;
  const auto pyramid = std::make_shared<ElevationPyramid>(ground.posts);
  std::vector<std::vector<float>> before;
  const auto all = [&] {
    std::vector<std::vector<float>> levels;
    for (int level = 0; level < ground.base->GetLattice().levels; ++level) {
      const int columns = int(ground.base->GetLattice().ColumnsAt(level));
      levels.emplace_back(std::size_t(columns) * columns);
      std::vector<float> weights(levels.back().size());
      pyramid->Read({level, 0, 0, columns, columns}, levels.back().data(), weights.data(), 60.0);
      levels.push_back(std::move(weights));
    }
    return levels;
  };
  before = all();
  std::mt19937 random(6);
  pyramid->Invalidate(ground.posts->RectanglesOf(
      ground.tracks->Add({Stroke("a", Rut(), Wander(random, 400, true)),
                          Stroke("b", Rut(), Wander(random, 400, false))})));
  EXPECT_NE(all(), before);
  pyramid->Invalidate(ground.posts->RectanglesOf(ground.tracks->Clear()));
  EXPECT_EQ(all(), before);
  EXPECT_TRUE(ground.tracks->Empty());
  EXPECT_EQ(ground.tracks->Statistics().bytes, 0u);
}

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

TEST(WheelTracks, AStepDoesNotReadTheSourceAgain) {
  Ground ground(2001, Hills);
  ElevationPyramid pyramid(ground.posts);
  std::vector<float> heights(2001 * 2001);
  const auto look = [&] {
    for (int level = 0; level < ground.base->GetLattice().levels; ++level) {
      const int columns = int(ground.base->GetLattice().ColumnsAt(level));
      pyramid.Read({level, 0, 0, columns, columns}, heights.data());
    }
  };
  look();
  int before = 0;
  for (int n = 0; n < 60; ++n) { // 1.5 m, within a tile of 3.2 m
    pyramid.Invalidate(ground.posts->RectanglesOf(ground.tracks->Add(
        {Stroke("wheel", Rut(), {{{-8.8 + 0.025 * n, 8.4 + 0.01 * (n % 3)}, 0.05}})})));
    look();
    if (n == 0) {
      before = ground.base->reads;
    }
  }
  EXPECT_EQ(ground.base->reads, before);
}

TEST(WheelTracks, WhatLiesOnALineIsLeftOut) {
  WheelTracks straight("ground");
  WheelTracks curve("ground");
  std::vector<TrackContact> ahead;
  std::vector<TrackContact> around;
  for (int i = 0; i <= 40000; ++i) { // a kilometre, a contact each 2.5 cm
    const double s = 0.025 * i;
    ahead.push_back({{0.6 * s, 0.8 * s}, 0.05});
    around.push_back({{5.0 * std::cos(s / 5.0), 5.0 * std::sin(s / 5.0) + 0.3 * s / 5.0}, 0.05});
  }
  TrackAddition addition = Stroke("wheel", Rut(), ahead);
  straight.Add({addition});
  EXPECT_NEAR(straight.Statistics().length, 1000.0, 1e-6);
  EXPECT_LE(straight.Statistics().contacts, 1100u);
  EXPECT_LE(straight.Statistics().bytes, 200u * 1000u); // stated: some 180 bytes a metre
  addition.contacts = around;
  curve.Add({addition});
  EXPECT_LE(curve.Statistics().bytes, 450u * 1000u); // stated: some 400
  // What was left out lies on the line that stayed, to the tolerance.
  const std::vector<TrackStroke> kept = curve.Strokes();
  std::size_t at = 0;
  for (const TrackContact& c : around) {
    double nearest = 1e9;
    for (std::size_t i = at; i + 1 < kept[0].contacts.size() && i < at + 4; ++i) {
      const Eigen::Vector2d a = kept[0].contacts[i].place;
      const Eigen::Vector2d b = kept[0].contacts[i + 1].place;
      const double t = std::clamp((c.place - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      const double distance = (a + t * (b - a) - c.place).norm();
      if (distance < nearest) {
        nearest = distance;
        at = distance < 2e-3 ? i : at;
      }
    }
    ASSERT_LE(nearest, 1e-3 + 1e-12);
  }
}

TEST(WheelTracks, ABudgetThatIsUsedUpRefusesAndChangesNothing) {
  WheelTracksOptions options;
  options.byteBudget = 64 << 10;
  Ground ground(801, Hills, 124, options);
  std::mt19937 random(3);
  int added = 0;
  std::vector<float> before;
  std::size_t bytes = 0;
  try {
    for (; added < 10000; ++added) {
      before = ground.Read(1, *ground.posts);
      bytes = ground.tracks->Statistics().bytes;
      ground.tracks->Add({Stroke("a", Rut(), Wander(random, 20, true)),
                          Stroke("b", Rut(), Wander(random, 20, true))});
      ASSERT_LE(ground.tracks->Statistics().bytes, options.byteBudget);
    }
    FAIL() << "a budget was exceeded";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Resource);
    EXPECT_NE(std::string(error.what()).find("65536"), std::string::npos) << error.what();
  }
  EXPECT_GT(added, 3);
  EXPECT_EQ(ground.Read(1, *ground.posts), before);
  EXPECT_EQ(ground.tracks->Statistics().bytes, bytes);
  ground.tracks->Clear();
  ground.tracks->Add({Stroke("a", Rut(), Wander(random, 20, true))});
}

TEST(WheelTracks, WhatIsNotAcceptedIsRefused) {
  WheelTracks tracks("ground");
  const auto refused = [&tracks](TrackAddition addition, const std::string& part) {
    try {
      tracks.Add({Stroke("fine", Rut(), {{{0.0, 0.0}, 0.1}}), addition});
      ADD_FAILURE() << part << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
    EXPECT_TRUE(tracks.Empty());
  };
  const double nan = std::nan("");
  refused(Stroke("w", Rut(), {{{nan, 0.0}, 0.1}}), "a coordinate");
  refused(Stroke("w", Rut(), {{{0.0, 0.0}, -0.1}}), "sinkage");
  refused(Stroke("w", Rut(), {{{0.0, 0.0}, nan}}), "sinkage");
  refused(Stroke("w", Rut(), {{{0.0, 0.0}, 3.0}}), "sinkage");
  refused(Stroke("w", Rut(), {{{0.0, 0.0}, 0.1, HUGE_VAL}}), "heading");
  refused(Stroke("w", Rut(), {{{0.0, 0.0}, 0.1, 0.0, 1e12}}), "rolled");
  refused(Stroke("fine", Rut(), {{{0.0, 0.0}, 0.1}}), "twice");
  TrackProfile rut = Rut();
  rut.width = 0.0;
  refused(Stroke("w", rut, {{{0.0, 0.0}, 0.1}}), "width");
  rut = Rut();
  rut.treadPitch = 1e-9;
  refused(Stroke("w", rut, {{{0.0, 0.0}, 0.1}}), "pitch");
  WheelTracksOptions options;
  options.byteBudget = 100;
  EXPECT_THROW(WheelTracks("ground", options), Error);
}

} // namespace
