// Runs of edges, and bounds of what they can be seen at.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/horizon/EdgeRuns.h>

namespace dspace::testing {
namespace {

// Of a sphere of 100 km.
HorizonStep GroundAt(double distance) {
  const double angle = distance / 1e5;
  return {float(1e5 * (std::cos(angle) - 1.0)), float(std::cos(angle)),
          float(1e5 * std::sin(angle)), float(std::sin(angle))};
}

TEST(EdgeRuns, AnEdgeIsInTheRunOfItsDistance) {
  EdgeRuns runs;
  runs.Clear(4, 100.0, 180.0);
  runs.Add(100.5, {GroundAt(100.5), 1, 2, 0.5f}, 7, 9, 0, 1);
  runs.Add(119.5, {GroundAt(119.5), 3, 4, 0.5f}, 5, 11, 1, 1);
  runs.Add(161.0, {GroundAt(161.0), 5, 6, 0.5f}, -3, 2, 1, 0);
  runs.Add(180.0, {GroundAt(180.0), 7, 8, 0.5f}, -4, 2, 0, 1); // its end is the last run's
  ASSERT_EQ(runs.Runs().size(), 4u);
  const EdgeRuns::Run& first = runs.Runs()[0];
  ASSERT_EQ(first.edges.size(), 2u);
  EXPECT_EQ(first.edges[1].first, 3);
  EXPECT_EQ(first.posts.left, 5);
  EXPECT_EQ(first.posts.right, 7);
  EXPECT_EQ(first.posts.top, 9);
  EXPECT_EQ(first.posts.bottom, 12);
  EXPECT_TRUE(runs.Runs()[1].edges.empty());
  EXPECT_LT(runs.Runs()[1].posts.right, runs.Runs()[1].posts.left);
  EXPECT_EQ(runs.Runs()[3].edges.size(), 2u);
  runs.Clear(2, 0.0, 10.0);
  EXPECT_TRUE(runs.Runs()[0].edges.empty());
  EXPECT_GT(runs.Runs()[0].posts.top, runs.Runs()[0].posts.bottom);
}

// No tangent is above the bound, and the greatest is close to it.
TEST(EdgeRuns, BoundsHoldTheTangentsOfTheirGround) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const HeightSpan all = {-900.0f, 800.0f};
  for (int k = 0; k < 300; ++k) {
    const double begin = 50.0 + 2e4 * unit(random);
    const double end = begin + 40.0;
    const auto highest = float(-850.0 + 1600.0 * unit(random));
    const auto z = float(-850.0 + 1600.0 * unit(random));
    GroundBounds bounds;
    double greatest = -1e9;
    for (int i = 0; i <= 20; ++i) {
      const HorizonStep g = GroundAt(begin + (end - begin) * i / 20.0);
      bounds.Add(g);
      for (const double below : {0.0, 1.0, 30.0}) {
        const double h = double(highest) - below;
        greatest = std::max(greatest, (double(g.fall) + double(g.rise) * h - double(z)) /
                                          (double(g.away) + double(g.spread) * h));
      }
    }
    const LaneReach reach = bounds.Reach(all);
    const double up = double(bounds.Crest(highest)) - double(z);
    const double bound = std::max(up * double(reach.over), up * double(reach.under));
    EXPECT_GE(bound, greatest) << begin << " m, " << highest << " from " << z;
    // A hundredth for the least height's nearness, and the fall and the length of the run.
    const double loose = std::abs(greatest) * (0.02 + 2.0 * (end - begin) / begin) + 0.02;
    EXPECT_LE(bound, greatest + loose) << begin << " m, " << highest << " from " << z;
  }
}

} // namespace
} // namespace dspace::testing
