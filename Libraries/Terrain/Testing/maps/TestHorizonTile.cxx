// Tiles against each of their cells.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <dspace/DiscLeft.h>
#include <dspace/maps/HorizonTile.h>
#include <dspace/maps/TileFile.h>

#include "MapTestSupport.h"

namespace dspace::testing {
namespace {

using V = Eigen::Vector3d;
constexpr double Moon = 1737400.0;

// Maps of hills on the Moon, of 70 x 67 cells: tiles that are whole, and at the map's edges.
class Tiles : public ::testing::Test {
protected:
  static constexpr int Columns = 70;
  static constexpr int Rows = 67;
  static constexpr int Azimuths = 12;

  // Cells of `every` posts from the post at 200, 200 on, or to the last row.
  HorizonMap MapOf(double north, double step, int every, bool last = false) {
    const auto terrain = OnBody(WriteDegrees(
        this->Folder_, "hills.tif", Moon, 60, 60, 20.0, north, step, [](double lon, double lat) {
          return 300.0 * std::sin(90.0 * lon) * std::cos(70.0 * lat);
        }));
    const MapGround ground = MapGroundOf(*terrain);
    HorizonMapOptions options;
    options.cells.column = options.cells.row = 200;
    options.cells.every = every;
    if (last) {
      options.cells.row = 60 * ground.postsAPixel - (Rows + 1) * every;
    }
    options.cells.columns = Columns;
    options.cells.rows = Rows;
    options.azimuths = Azimuths;
    options.height = 2.0;
    const std::string path =
        (this->Folder_.Path() / ("map" + std::to_string(++this->Maps_) + ".tif")).string();
    EXPECT_TRUE(WriteHorizonMap(ground, options, path));
    return HorizonMap(path);
  }
  // The place and axes of a cell.
  static V PlaceOf(const HorizonMap& map, int column, int row) {
    return map.Placement().ToScene(map.Cells().Post(column, row), 0.0);
  }

  // Every cell of every tile against its own direction and horizon.
  static void ExpectSeen(const HorizonMap& map, const V& p_S, double tolerance) {
    for (int row = 0; row < Rows; row += TileFile::Side) {
      for (int column = 0; column < Columns; column += TileFile::Side) {
        HorizonTile tile(map, column, row);
        tile.LookAt(p_S);
        std::vector<float> horizons = map.Read(column, row, tile.Width(), tile.Height());
        std::replace(horizons.begin(), horizons.end(), -90.0f, 0.0f); // nothing in sight: level
        const auto cells = std::size_t(tile.Width()) * std::size_t(tile.Height());
        std::vector<float> above(std::size_t(tile.Width())), rise(above), secant(above);
        double most = 0.0;
        for (int j = 0; j < tile.Height(); ++j) {
          tile.SeeRow(j, above.data(), rise.data(), secant.data());
          for (int i = 0; i < tile.Width(); ++i) {
            const ChartAxes axes =
                ChartAxesAt(map.Placement(), map.Cells().Post(column + i, row + j));
            const V d = p_S - PlaceOf(map, column + i, row + j);
            const double east = axes.east.dot(d), north = axes.north.dot(d);
            const double elevation = std::atan2(axes.up.dot(d), std::hypot(east, north));
            double x = std::atan2(east, north) / (2.0 * M_PI) * Azimuths;
            x = x < 0.0 ? x + Azimuths : x;
            const int first = std::min(int(x), Azimuths - 1);
            const auto at = std::size_t(j * tile.Width() + i);
            const double a = horizons[std::size_t(first) * cells + at];
            const double b = horizons[std::size_t((first + 1) % Azimuths) * cells + at];
            const double expected = elevation - (a + (x - first) * (b - a)) * M_PI / 180.0;
            most = std::max(most, std::abs(double(above[std::size_t(i)]) - expected));
            EXPECT_NEAR(secant[std::size_t(i)], std::min(1.0 / std::cos(elevation), 4.0), 2e-4);
          }
        }
        EXPECT_LT(most, tolerance) << column << ", " << row;
      }
    }
  }

  TemporaryFolder Folder_;
  int Maps_ = 0;
};

V Towards(const V& place, double turn, double distance) {
  return distance * (Eigen::AngleAxisd(turn, V(0.3, -0.5, 0.8).normalized()) * place.normalized());
}

// Far from the pole nodes are 32 cells apart.
TEST_F(Tiles, CellsBetweenNodesSeeTheirOwnDirection) {
  const HorizonMap map = this->MapOf(20.0, 0.02, 1);
  const V place = PlaceOf(map, 35, 33);
  for (const double turn : {0.3, 1.2, -0.9}) {
    ExpectSeen(map, Towards(place, turn, 1.496e11), 1e-5);
    ExpectSeen(map, Towards(place, turn, 3.8e8), 1e-5);
  }
}

// Beside the pole each cell is a node, and in between there are some.
TEST_F(Tiles, CellsNearAPoleSeeTheirOwnDirection) {
  for (const double north : {-88.5, -80.0, -60.0}) {
    const HorizonMap map = this->MapOf(north, 0.02, 4);
    const V place = PlaceOf(map, 35, 33);
    ExpectSeen(map, Towards(place, 1.45, 1.496e11), 3e-5);
  }
}

// Cells whose axes turn by degrees from one to 32 farther on: nodes are closer together.
TEST_F(Tiles, CellsWhoseAxesTurnSeeTheirOwnDirection) {
  const HorizonMap map = this->MapOf(-84.0, 0.1, 32, true);
  const V place = PlaceOf(map, 35, 33);
  const auto east = [&](int column, int row) {
    return ChartAxesAt(map.Placement(), map.Cells().Post(column, row)).east;
  };
  ASSERT_GT((east(32, 60) - east(0, 60)).norm(), 0.02);
  for (const double turn : {1.2, 1.45}) { // low, where horizons matter
    ExpectSeen(map, Towards(place, turn, 1.496e11), 3e-5);
  }
}

// The limb of the Earth crosses the cells.
TEST_F(Tiles, WhatAnotherDiscLeavesIsThatOfEachCell) {
  constexpr double SunRadius = 6.957e8, EarthRadius = 6378136.6;
  const HorizonMap map = this->MapOf(20.0, 0.02, 4);
  const HorizonMap fine = this->MapOf(20.0, 0.02, 1);
  for (const HorizonMap* each : {&map, &fine}) {
    const V place = PlaceOf(*each, 35, 33);
    const V sun = Towards(place, 0.2, 1.496e11);
    const V earth =
        place + 3.8e8 * (Eigen::AngleAxisd(0.0168, V::UnitZ().cross(place).normalized()) *
                         (sun - place).normalized());
    int parts = 0;
    for (int column = 0; column < Columns; column += TileFile::Side) {
      HorizonTile tile(*each, column, 0);
      const bool any = tile.Eclipse(sun, SunRadius, earth, EarthRadius);
      for (int cell = 0; cell < tile.Width() * tile.Height(); ++cell) {
        const V p = PlaceOf(*each, column + cell % tile.Width(), cell / tile.Width());
        const V s = sun - p, e = earth - p;
        const double expected =
            DiscLeft(std::asin(SunRadius / s.norm()), std::asin(EarthRadius / e.norm()),
                     std::atan2(s.cross(e).norm(), s.dot(e)));
        EXPECT_NEAR(any ? tile.LeftAt(cell) : 1.0, expected, 1e-4);
        parts += expected > 0.0 && expected < 1.0;
      }
      EXPECT_FALSE(tile.Eclipse(sun, SunRadius, -earth, EarthRadius));
    }
    EXPECT_GT(parts, 1000);
  }
}

} // namespace
} // namespace dspace::testing
