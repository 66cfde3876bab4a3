// Ruts in posts against formulas.
#include <cstring>

#include <gtest/gtest.h>

#include "WheelTrackTestSupport.h"

#include <dspace/Error.h>

namespace dspace::testing {
namespace {

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

TEST(WheelTracks, ABudgetThatIsUsedUpRejectsAndChangesNothing) {
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

TEST(WheelTracks, WhatIsNotAcceptedIsRejected) {
  WheelTracks tracks("ground");
  const auto rejected = [&tracks](TrackAddition addition, const std::string& part) {
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
  rejected(Stroke("w", Rut(), {{{nan, 0.0}, 0.1}}), "a coordinate");
  rejected(Stroke("w", Rut(), {{{0.0, 0.0}, -0.1}}), "sinkage");
  rejected(Stroke("w", Rut(), {{{0.0, 0.0}, nan}}), "sinkage");
  rejected(Stroke("w", Rut(), {{{0.0, 0.0}, 3.0}}), "sinkage");
  rejected(Stroke("w", Rut(), {{{0.0, 0.0}, 0.1, HUGE_VAL}}), "heading");
  rejected(Stroke("w", Rut(), {{{0.0, 0.0}, 0.1, 0.0, 1e12}}), "rolled");
  rejected(Stroke("fine", Rut(), {{{0.0, 0.0}, 0.1}}), "twice");
  TrackProfile rut = Rut();
  rut.width = 0.0;
  rejected(Stroke("w", rut, {{{0.0, 0.0}, 0.1}}), "width");
  rut = Rut();
  rut.treadPitch = 1e-9;
  rejected(Stroke("w", rut, {{{0.0, 0.0}, 0.1}}), "pitch");
  WheelTracksOptions options;
  options.byteBudget = 100;
  EXPECT_THROW(WheelTracks("ground", options), Error);
}

} // namespace
} // namespace dspace::testing
