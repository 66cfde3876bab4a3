// Pixels into angles: pictures made by hand.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <dspace/measure/PictureReadings.h>

namespace {

using namespace dspace;

constexpr int Size = 1000;
constexpr double PerDegree = M_PI / 180.0;

// What a level camera of 90 degrees sees of a horizon of one elevation in all azimuths.
std::vector<float> Ring(double elevation_deg) {
  std::vector<float> range(Size * Size, std::numeric_limits<float>::infinity());
  for (int row = 0; row < Size; ++row) {
    for (int column = 0; column < Size; ++column) {
      const double x = (column + 0.5 - Size / 2) / (Size / 2.0);
      const double y = (Size / 2 - row - 0.5) / (Size / 2.0);
      if (std::atan2(y, std::hypot(1.0, x)) <= elevation_deg * PerDegree) {
        range[std::size_t(row * Size + column)] = float(row);
      }
    }
  }
  return range;
}

TEST(PictureReadings, AHorizonOfOneElevation) {
  for (const double elevation : {-20.0, -0.3, 0.0, 5.0, 30.0}) {
    const std::vector<float> range = Ring(elevation);
    for (const double right : {-44.99, -30.0, 0.0, 12.3, 44.99}) {
      const HorizonReading reading = ReadHorizon(range, Size, right);
      // The upper edge of the highest pixel: within one pixel of it.
      EXPECT_GE(reading.elevation_deg, elevation - 0.5 * PixelAngle(Size))
          << elevation << " at " << right;
      EXPECT_LE(reading.elevation_deg, elevation + PixelAngle(Size))
          << elevation << " at " << right;
      EXPECT_FALSE(reading.over);
    }
  }
  EXPECT_NEAR(PixelAngle(Size), 0.1146, 1e-4);
}

TEST(PictureReadings, NothingAndTooHigh) {
  const HorizonReading none = ReadHorizon(Ring(-60.0), Size, 0.0);
  EXPECT_EQ(none.elevation_deg, -90.0);
  EXPECT_TRUE(ReadHorizon(Ring(36.0), Size, 44.99).over); // corners show 35.3 degrees
  EXPECT_FALSE(ReadHorizon(Ring(36.0), Size, 0.0).over);
}

TEST(PictureReadings, LabelsAreCounted) {
  EXPECT_EQ(CountLabel({1, 2, 2, 0, 2}, 2), 3u);
  EXPECT_EQ(CountLabel({}, 2), 0u);
}

} // namespace
