// The part of a disc above a line: closed forms, and points of the disc.
#include <cmath>

#include <gtest/gtest.h>

#include <dspace/horizon/LitFraction.h>

namespace {

using dspace::LitFraction;

TEST(LitFraction, IsThatOfACircularSegment) {
  EXPECT_DOUBLE_EQ(LitFraction(0.0, 0.0, 0.2), 0.5);
  EXPECT_DOUBLE_EQ(LitFraction(0.2, 0.0, 0.2), 1.0);
  EXPECT_DOUBLE_EQ(LitFraction(-0.2, 0.0, 0.2), 0.0);
  EXPECT_DOUBLE_EQ(LitFraction(9.0, 3.0, 0.2), 1.0);
  // At half a radius the segment takes an angle of 120 degrees: (2 pi / 3 - sin(120)) / 2 pi.
  const double segment = (2.0 * M_PI / 3.0 - std::sin(2.0 * M_PI / 3.0)) / (2.0 * M_PI);
  EXPECT_NEAR(LitFraction(-0.1, 0.0, 0.2), segment, 1e-15);
  EXPECT_NEAR(LitFraction(0.1, 0.0, 0.2), 1.0 - segment, 1e-15);
  // A line of 45 degrees is nearer by the root of 2.
  EXPECT_NEAR(LitFraction(-0.1 * std::sqrt(2.0), 1.0, 0.2), segment, 1e-15);
  EXPECT_NEAR(LitFraction(-0.1 * std::sqrt(2.0), -1.0, 0.2), segment, 1e-15);
}

TEST(LitFraction, IsTheShareOfTheDiscsPointsAboveTheLine) {
  constexpr int Side = 1000;
  for (const double slope : {0.0, 0.3, -2.0, 40.0}) {
    for (const double above : {-0.21, -0.13, 0.004, 0.17}) {
      int inside = 0;
      int lit = 0;
      for (int i = 0; i < Side; ++i) {
        for (int j = 0; j < Side; ++j) {
          const double x = (2.0 * (i + 0.5) / Side - 1.0) * 0.25;
          const double y = (2.0 * (j + 0.5) / Side - 1.0) * 0.25;
          if (x * x + y * y < 0.25 * 0.25) {
            ++inside;
            lit += y > -above + slope * x;
          }
        }
      }
      EXPECT_NEAR(LitFraction(above, slope, 0.25), double(lit) / inside, 1e-3)
          << slope << " " << above;
    }
  }
}

TEST(LitFraction, OfAPointIsAllOrNothing) {
  EXPECT_EQ(LitFraction(1e-9, 2.0, 0.0), 1.0);
  EXPECT_EQ(LitFraction(0.0, 0.0, 0.0), 1.0);
  EXPECT_EQ(LitFraction(-1e-9, 2.0, 0.0), 0.0);
}

} // namespace
