// The loops of the sweep against the formula.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <dspace/horizon/HorizonKernel.h>

using namespace dspace;

namespace {

// Steps over hills of which about one in a hundred raises a horizon; some heights are missing.
class HorizonKernelTest : public ::testing::TestWithParam<bool> {
protected:
  static constexpr int Posts = 4096;

  HorizonKernelTest() {
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (int i = 0; i < Posts; ++i) {
      const bool hole = this->random() % 50 == 0;
      this->heights.push_back(hole ? std::numeric_limits<float>::quiet_NaN()
                                   : 100.0f * unit(this->random));
    }
    for (int i = 0; i < HorizonLanes; ++i) {
      this->z.push_back(i == 5 ? std::numeric_limits<float>::quiet_NaN()
                               : 100.0f * unit(this->random));
    }
    for (int k = 0; k < 2000; ++k) {
      EdgeStep step;
      const float distance = 5.0f * float(k + 1);
      if (this->GetParam()) { // a plane
        step.ground = {0.0f, 1.0f, distance, 0.0f};
      } else { // a sphere of 100 km
        const float angle = distance / 1e5f;
        step.ground = {1e5f * (std::cos(angle) - 1.0f), std::cos(angle), 1e5f * std::sin(angle),
                       std::sin(angle)};
      }
      step.first = std::ptrdiff_t(this->random() % (Posts - HorizonLanes));
      step.second = std::ptrdiff_t(this->random() % (Posts - HorizonLanes));
      step.share = unit(this->random);
      this->steps.push_back(step);
    }
  }

  std::mt19937 random{3};
  std::vector<float> heights;
  std::vector<float> z;
  std::vector<EdgeStep> steps;
};

} // namespace

INSTANTIATE_TEST_SUITE_P(Grounds, HorizonKernelTest, ::testing::Values(true, false));

TEST_P(HorizonKernelTest, EdgesRaiseTangentsAsTheFormulaDoes) {
  std::vector<float> tangents(HorizonLanes, -1e6f);
  std::vector<float> expected = tangents;
  std::vector<float> parts = tangents;
  MarchEdges(this->steps, 0b1111u, this->heights.data(), this->z.data(), tangents.data());
  MarchEdges(this->steps, 0b0101u, this->heights.data(), this->z.data(), parts.data());
  int raised = 0;
  for (const EdgeStep& step : this->steps) {
    for (int i = 0; i < HorizonLanes; ++i) {
      const float a = this->heights[std::size_t(step.first + i)];
      const float b = this->heights[std::size_t(step.second + i)];
      const float h = a + step.share * (b - a);
      const HorizonStep& g = step.ground;
      const float t = (g.fall + g.rise * h - this->z[std::size_t(i)]) / (g.away + g.spread * h);
      if (t > expected[std::size_t(i)]) {
        expected[std::size_t(i)] = t;
        ++raised;
      }
    }
  }
  EXPECT_GT(raised, 2 * HorizonLanes);
  EXPECT_LT(raised, 10 * HorizonLanes); // most steps raise none
  for (std::size_t i = 0; i < tangents.size(); ++i) {
    EXPECT_NEAR(tangents[i], expected[i], 2e-7f * std::abs(expected[i])) << i; // of a reciprocal
    EXPECT_EQ(parts[i], (i / HorizonGroup) % 2 == 0 ? tangents[i] : -1e6f) << i;
  }
  EXPECT_EQ(tangents[5], -1e6f);
}

TEST_P(HorizonKernelTest, TheFastOnesDoSoAtTheMeanHeight) {
  float base = 0.0f;
  for (int i = 0; i < HorizonLanes; ++i) {
    base += i == 5 ? 0.0f : this->z[std::size_t(i)] / float(HorizonLanes - 1);
  }
  for (EdgeStep& step : this->steps) {
    step.ground.away += step.ground.spread * base;
    step.ground.spread = 0.0f;
  }
  std::vector<float> fast(HorizonLanes, -1e6f);
  std::vector<float> level(HorizonLanes, -1e6f);
  MarchEdges(this->steps, 0b1111u, this->heights.data(), this->z.data(), level.data());
  for (EdgeStep& step : this->steps) { // as they were
    const float sine = step.ground.away / 1e5f;
    if (!this->GetParam()) {
      step.ground.spread = sine / (1.0f + base / 1e5f);
      step.ground.away -= step.ground.spread * base;
    }
  }
  MarchEdgesFast(this->steps, 0b1111u, base, this->heights.data(), this->z.data(), fast.data());
  for (std::size_t i = 0; i < fast.size(); ++i) {
    EXPECT_NEAR(fast[i], level[i], 1e-5f * std::max(1.0f, std::abs(level[i]))) << i;
  }
  EXPECT_EQ(fast[5], -1e6f);
}

TEST(HorizonKernel, ElevationsAreArcTangents) {
  std::vector<float> tangents = {0.0f, -1e6f, std::numeric_limits<float>::quiet_NaN()};
  for (float t = 1e-6f; t < 1e6f; t *= 1.07f) {
    tangents.push_back(t);
    tangents.push_back(-t);
  }
  std::vector<float> found(tangents.size());
  ElevationsOf(tangents.data(), int(tangents.size()), -1e6f, -90.0f, found.data());
  EXPECT_EQ(found[0], 0.0f);
  EXPECT_EQ(found[1], -90.0f);
  EXPECT_TRUE(std::isnan(found[2]));
  for (std::size_t i = 3; i < tangents.size(); ++i) {
    EXPECT_NEAR(found[i], std::atan(double(tangents[i])) * 180.0 / M_PI, 2e-5) << tangents[i];
  }
}

TEST(HorizonKernel, GroupsMayBeRaised) {
  std::vector<float> z(HorizonLanes, 10.0f);
  std::vector<float> tangents(HorizonLanes, 0.5f);
  z.back() = 9.0f; // up by 6 at 10 to 20 m: 0.6 at most
  tangents.back() = 0.55f;
  const auto raised = [&](float crest, float slack) {
    GroupCrests crests;
    crests.fill(crest);
    return MayRaise(crests, {0.1f, 0.05f}, slack, z.data(), tangents.data());
  };
  EXPECT_EQ(raised(15.0f, 0.0f), 0b1000u);
  EXPECT_EQ(raised(15.0f, 0.06f), 0u);
  EXPECT_EQ(MayRaise({15.0f, 16.0f, 15.0f, 14.0f}, {0.1f, 0.05f}, 0.0f, z.data(), tangents.data()),
            0b0010u);
  // Lower ground is highest where it is farthest.
  tangents.assign(HorizonLanes, -0.3f);
  EXPECT_EQ(raised(5.0f, 0.0f), 0b1111u);
  tangents.assign(HorizonLanes, -0.15f);
  EXPECT_EQ(raised(5.0f, 0.0f), 0u);
  EXPECT_EQ(LeastOf(tangents.data(), HorizonLanes), -0.15f);
  tangents[40] = -2.0f;
  EXPECT_EQ(LeastOf(tangents.data(), HorizonLanes), -2.0f);
}
