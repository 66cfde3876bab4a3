// The loops of the sweep against the formula, to the bit.
#include <gtest/gtest.h>

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
  MarchEdges(this->steps, this->heights.data(), this->z.data(), tangents.data());
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
  EXPECT_EQ(tangents, expected);
  EXPECT_EQ(tangents[5], -1e6f);
}
