// The part of a disc above a horizon: closed forms.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/visibility/HorizonLine.h>

namespace {

using namespace dspace;

// The area of a disc above a straight line that passes `below` its centre, over the disc's own.
double Segment(double below, double radius) {
  const double x = std::clamp(below / radius, -1.0, 1.0);
  return 0.5 + (x * std::sqrt(1.0 - x * x) + std::asin(x)) / M_PI;
}

TEST(HorizonLine, ElevationIsLinearBetweenAzimuths) {
  const HorizonLine line({1.0, 3.0, -1.0, 0.0}, 10.0); // at 10, 100, 190, 280 degrees
  EXPECT_DOUBLE_EQ(line.ElevationAt(10.0), 1.0);
  EXPECT_DOUBLE_EQ(line.ElevationAt(55.0), 2.0);
  EXPECT_DOUBLE_EQ(line.ElevationAt(190.0 - 720.0), -1.0);
  EXPECT_DOUBLE_EQ(line.ElevationAt(325.0), 0.5); // between the last and the first
  EXPECT_NEAR(line.ElevationAt(10.0 - 1e-13), 1.0, 1e-12);
}

TEST(HorizonLine, LevelHorizonLeavesTheSegmentOfACircle) {
  const HorizonLine level(2.0);
  for (const double over : {-0.3, -0.25, -0.1, 0.0, 0.07, 0.2, 0.26, 0.3}) {
    EXPECT_NEAR(level.LitFraction({77.0, 2.0 + over}, 0.2666), Segment(over, 0.2666), 5e-4) << over;
    EXPECT_NEAR(level.TopOver({77.0, 2.0 + over}, 0.2666), over + 0.2666, 1e-9);
  }
}

// At elevation 0 a horizon that rises by `slope` passes the centre's distance over sqrt(1 +
// slope^2).
TEST(HorizonLine, SlopingHorizonAcrossTheDisc) {
  std::vector<double> rising(3600);
  const double slope = 0.8;
  for (int i = 0; i < 3600; ++i) {
    const double azimuth = 0.1 * i;
    rising[i] = std::abs(azimuth - 180.0) < 20.0 ? slope * (azimuth - 180.0) : 0.0;
  }
  const HorizonLine line(rising);
  for (const double over : {-0.2, -0.05, 0.0, 0.1, 0.3}) {
    EXPECT_NEAR(line.LitFraction({180.0, over}, 0.25),
                Segment(over / std::sqrt(1.0 + slope * slope), 0.25), 1e-3)
        << over;
    // The highest point over a sloping line is that whose tangent is parallel to it.
    EXPECT_NEAR(line.TopOver({180.0, over}, 0.25), over + 0.25 * std::sqrt(1.0 + slope * slope),
                1e-3);
  }
}

TEST(HorizonLine, WallHidesWhatIsBesideIt) {
  std::vector<double> wall(7200, -5.0);
  std::fill(wall.begin() + 3600, wall.end(),
            40.0); // from 180 degrees on; it rises from 179.95 degrees on
  const HorizonLine line(wall);
  // At an elevation of 30 degrees the disc is 0.25 / cos(30) degrees of azimuth wide on each side.
  const double width = 1.0 / std::cos(30.0 * M_PI / 180.0);
  const double edge = 180.0 - 0.05 * 10.0 / 45.0; // where it is 30 degrees high
  EXPECT_NEAR(line.LitFraction({edge, 30.0}, 0.25), 0.5, 8e-3);
  EXPECT_NEAR(line.LitFraction({edge - 0.1 * width, 30.0}, 0.25), Segment(0.1, 0.25), 8e-3);
  EXPECT_EQ(line.LitFraction({200.0, 30.0}, 0.25), 0.0);
  EXPECT_EQ(line.LitFraction({100.0, 30.0}, 0.25), 1.0);
  EXPECT_EQ(line.LitFraction({100.0, -6.0}, 0.0), 0.0);
  EXPECT_EQ(line.LitFraction({100.0, -4.0}, 0.0), 1.0);
}

TEST(HorizonLine, RejectsWrongNumbers) {
  EXPECT_THROW(HorizonLine(std::vector<double>()), Error);
  EXPECT_THROW(HorizonLine({0.0, 91.0}), Error);
  EXPECT_THROW(HorizonLine({0.0, NAN}), Error);
  EXPECT_THROW(HorizonLine({0.0}, INFINITY), Error);
  EXPECT_THROW(HorizonLine().LitFraction({0.0, 0.0}, 11.0), Error);
  EXPECT_THROW(HorizonLine().LitFraction({0.0, 0.0}, -1.0), Error);
}

} // namespace
