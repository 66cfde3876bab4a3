// Values between directions against a bilinear function, which the table holds exactly, and its
// edges.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <dspace/Error.h>
#include <dspace/visibility/DirectionTable.h>

using dspace::AzimuthElevation;
using dspace::DirectionTable;

TEST(DirectionTable, IsLinearBetweenDirectionsAndGoesAround) {
  // Elevations -10, 0, 10, 20; azimuths 0, 90, 180, 270.
  std::vector<double> values;
  for (const double elevation : {-10.0, 0.0, 10.0, 20.0}) {
    for (const double azimuth : {0.0, 90.0, 180.0, 270.0}) {
      values.push_back(100.0 + azimuth + 2.0 * elevation);
    }
  }
  const DirectionTable table(values, 4, -10.0, 20.0);
  const auto at = [&](double azimuth, double elevation) {
    AzimuthElevation direction;
    direction.azimuth_deg = azimuth;
    direction.elevation_deg = elevation;
    return table.At(direction);
  };
  EXPECT_NEAR(at(0.0, -10.0), 80.0, 1e-12);
  EXPECT_NEAR(at(45.0, 5.0), 155.0, 1e-12);
  EXPECT_NEAR(at(200.0, 17.0), 334.0, 1e-12);
  EXPECT_NEAR(at(-160.0, 17.0), 334.0, 1e-12);
  EXPECT_NEAR(at(315.0, 0.0), 0.5 * (370.0 + 100.0), 1e-12); // from 270 back to 0
  EXPECT_NEAR(at(360.0, 0.0), 100.0, 1e-12);
  EXPECT_NEAR(at(90.0, 85.0), 230.0, 1e-12); // the highest row
  EXPECT_NEAR(at(90.0, -85.0), 170.0, 1e-12);
}

TEST(DirectionTable, HoldsOneValue) {
  const DirectionTable table({3.0}, 1, 0.0, 0.0);
  EXPECT_EQ(table.At({123.0, 45.0}), 3.0);
}

TEST(DirectionTable, RejectsWhatIsNoTable) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(DirectionTable({}, 1, 0.0, 10.0), dspace::Error);
  EXPECT_THROW(DirectionTable({1.0, 2.0, 3.0}, 2, 0.0, 10.0), dspace::Error);
  EXPECT_THROW(DirectionTable({1.0}, 0, 0.0, 0.0), dspace::Error);
  EXPECT_THROW(DirectionTable({1.0, -1.0}, 1, 0.0, 10.0), dspace::Error);
  EXPECT_THROW(DirectionTable({1.0, nan}, 1, 0.0, 10.0), dspace::Error);
  EXPECT_THROW(DirectionTable({1.0, 2.0}, 1, 10.0, 10.0), dspace::Error);
  EXPECT_THROW(DirectionTable({1.0, 2.0}, 1, 0.0, 91.0), dspace::Error);
  EXPECT_THROW(DirectionTable({1.0, 2.0}, 1, nan, 10.0), dspace::Error);
}
