// Rows of cells against single discs.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/horizon/LitFraction.h>
#include <dspace/maps/LitCells.h>

namespace dspace {
namespace {

constexpr float Radius = 0.00465f;

struct Row {
  std::vector<float> above, rise, secant, lit;
  std::vector<std::uint32_t> night, longest;

  explicit Row(std::size_t count)
      : above(count), rise(count), secant(count, 1.0f), lit(count), night(count), longest(count) {}
  SeenRow Seen() const {
    return {this->above.data(), this->rise.data(), this->secant.data(), int(this->above.size())};
  }
  LitCounts Counts() { return {this->lit.data(), this->night.data(), this->longest.data()}; }
};

TEST(LitCells, PartsOfDiscsAreThoseOfSingleOnes) {
  for (const float perRise : {0.0f, 57.3f}) {
    for (const float rise : {-0.05f, 0.0f, 0.004f}) {
      Row row(2001);
      for (std::size_t i = 0; i < row.above.size(); ++i) {
        row.above[i] = Radius * (float(i) - 1000.0f) / 400.0f;
        row.rise[i] = rise;
        row.secant[i] = 1.0f + float(i % 3);
      }
      AddLit(row.Seen(), Radius, perRise, row.Counts());
      for (std::size_t i = 0; i < row.above.size(); ++i) {
        const double expected = LitFraction(
            row.above[i], double(rise) * double(perRise) * double(row.secant[i]), Radius);
        EXPECT_NEAR(row.lit[i], expected, 3e-7) << i;
        if (expected == 0.0 || expected > 1e-6) {
          EXPECT_EQ(row.night[i], expected == 0.0 ? 1u : 0u) << i;
        }
      }
    }
  }
}

TEST(LitCells, NightsAreCounted) {
  Row row(3);
  const float up = 2.0f * Radius, down = -2.0f * Radius, none = std::nanf("");
  const float steps[6][3] = {{down, up, none},   {down, down, none}, {0.0f, down, none},
                             {down, down, none}, {down, up, none},   {down, up, none}};
  for (const auto& step : steps) {
    row.above.assign(step, step + 3);
    AddLit(row.Seen(), Radius, 1.0f, row.Counts());
  }
  EXPECT_EQ(row.lit[0], 0.5f);
  EXPECT_EQ(row.lit[1], 3.0f);
  EXPECT_EQ(row.night, (std::vector<std::uint32_t>{3, 0, 6}));
  EXPECT_EQ(row.longest, (std::vector<std::uint32_t>{3, 3, 6}));
}

TEST(LitCells, CentresAboveTheHorizonAreCounted) {
  Row row(4);
  row.above = {0.0f, 1e-9f, -1e-9f, std::nanf("")};
  std::vector<std::uint32_t> counts = {7, 7, 7, 7};
  CountAbove(row.Seen(), counts.data());
  EXPECT_EQ(counts, (std::vector<std::uint32_t>{8, 8, 7, 7}));
}

} // namespace
} // namespace dspace
