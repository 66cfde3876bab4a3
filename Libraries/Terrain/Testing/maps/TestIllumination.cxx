// Illumination maps against closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/maps/Illumination.h>

#include "Grids.h"
#include "MapTestSupport.h"

namespace dspace::testing {
namespace {

using V = Eigen::Vector3d;
using Q = IlluminationOptions::Quantity;
constexpr double Astronomical = 149597870700.0; // [m]

V Towards(double azimuth, double elevation, double distance) {
  return distance * V(std::cos(elevation) * std::sin(azimuth),
                      std::cos(elevation) * std::cos(azimuth), std::sin(elevation));
}

// Level ground west of a long wall of 10 m.
class Walled : public ::testing::Test {
protected:
  static constexpr double Wall = 10.0;
  static constexpr int Columns = 60;
  static constexpr int Rows = 801;
  Walled() {
    HorizonMapOptions options;
    options.cells = FindCells(this->Ground_, std::nullopt, 0.0);
    options.cells.row = Rows / 2; // the middle of the wall
    options.cells.rows = 1;
    options.azimuths = 720;
    WriteHorizonMap(this->Ground_, options, this->Path("horizon.tif"));
  }
  std::string Path(const std::string& name) const { return (this->Folder_.Path() / name).string(); }

  TemporaryFolder Folder_;
  std::shared_ptr<const GridTerrain> Grid_ =
      Sampled(Columns, Rows, NorthUp(0.0, double(Rows), 1.0),
              [](const Eigen::Vector2d& map) { return map.x() > Columns - 1.0 ? Wall : 0.0; });
  MapGround Ground_ = MapGroundOf(*Grid_);
};

// A Sun that goes around at one elevation is behind the wall where sin(azimuth) exceeds the tangent
// of its elevation over that of the wall.
TEST_F(Walled, ASunThatGoesAroundIsHiddenByAnArc) {
  const HorizonMap horizons(this->Path("horizon.tif"));
  IlluminationOptions options;
  constexpr int Steps = 3600;
  const double elevation = 12.0 * Degree;
  for (int k = 0; k < Steps; ++k) { // from the west on, so that the night is in one piece
    const double azimuth = 2.0 * M_PI * k / Steps - 0.5 * M_PI;
    options.sun_S.push_back(Towards(azimuth, elevation, Astronomical));
    options.earth_S.push_back(Towards(azimuth, elevation, 4e8));
  }
  options.step_s = 10.0;
  options.sunRadius = 0.0;
  options.quantities = {Q::LitFraction, Q::LongestNight, Q::PermanentShadow, Q::EarthFraction};
  ASSERT_TRUE(WriteIllumination(horizons, options, this->Path("lit.tif")));
  const auto bands = BandsOf(this->Path("lit.tif"));
  int hidden = 0;
  for (int c = 0; c < 55; ++c) {
    const double away = Columns - 1.0 - c;
    const double x = std::tan(elevation) * away / Wall;
    // At most 75 degrees off the wall's normal: it is as long as that.
    const double arc = x < 1.0 ? 2.0 * std::acos(x) / (2.0 * M_PI) : 0.0;
    EXPECT_NEAR(bands[0][std::size_t(c)], 1.0 - arc, 1.5 / Steps + 2e-5) << c;
    EXPECT_NEAR(bands[1][std::size_t(c)], arc * Steps * 10.0, 16.0) << c;
    EXPECT_EQ(bands[2][std::size_t(c)], 0.0f);
    EXPECT_NEAR(bands[3][std::size_t(c)], 1.0 - arc, 1.5 / Steps + 2e-5) << c;
    hidden += arc > 0.0;
  }
  EXPECT_GT(hidden, 30);
}

// A disc at a level horizon: a circle's segment.
TEST_F(Walled, ADiscAtTheHorizonIsLitInPart) {
  const HorizonMap horizons(this->Path("horizon.tif"));
  const double radius = std::asin(695700e3 / Astronomical);
  for (const double part : {-1.2, -0.6, 0.0, 0.35, 0.99, 1.5}) {
    IlluminationOptions options;
    options.sun_S = {Towards(-0.5 * M_PI, part * radius, Astronomical)};
    options.quantities = {Q::LitFraction, Q::PermanentShadow};
    const std::string path = this->Path("disc" + std::to_string(part) + ".tif");
    ASSERT_TRUE(WriteIllumination(horizons, options, path));
    const double x = std::clamp(part, -1.0, 1.0);
    const double expected = 1.0 - (std::acos(x) - x * std::sqrt(1.0 - x * x)) / M_PI;
    const auto bands = BandsOf(path);
    EXPECT_NEAR(bands[0][20], expected, 1e-6) << part;
    EXPECT_EQ(bands[1][20], part < -1.0 ? 1.0f : 0.0f) << part;
  }
}

// Another disc before the Sun, and discs of equal size half a diameter apart: 2 pi / 3 - sqrt(3) /
// 2 of pi is hidden. It is no night.
TEST_F(Walled, AnotherDiscLeavesAPartOfTheSun) {
  const HorizonMap horizons(this->Path("horizon.tif"));
  const double radius = std::asin(695700e3 / Astronomical);
  struct Case {
    double apart, size, left; // in radii of the Sun
  };
  int number = 0;
  for (const Case& c : {Case{0.0, 0.5, 0.75}, Case{0.0, 1.5, 0.0}, Case{2.1, 1.0, 1.0},
                        Case{1.0, 1.0, 1.0 - 2.0 / 3.0 + std::sqrt(3.0) / (2.0 * M_PI)}}) {
    IlluminationOptions options;
    options.sun_S = {Towards(-0.5 * M_PI, 0.7, Astronomical),
                     Towards(-0.5 * M_PI, 0.7, Astronomical)};
    options.eclipser_S = {Towards(-0.5 * M_PI, 0.7 + c.apart * radius, 4e8),
                          Towards(1.0, 0.7, 4e8)};
    options.eclipserRadius = 4e8 * std::sin(c.size * radius);
    options.quantities = {Q::LitFraction, Q::LongestNight, Q::PermanentShadow};
    const std::string path = this->Path("eclipse" + std::to_string(++number) + ".tif");
    ASSERT_TRUE(WriteIllumination(horizons, options, path));
    const auto bands = BandsOf(path);
    EXPECT_NEAR(bands[0][20], 0.5 * (c.left + 1.0), 1e-5) << number;
    EXPECT_EQ(bands[1][20], 0.0f);
    EXPECT_EQ(bands[2][20], 0.0f);
  }
  IlluminationOptions options;
  options.sun_S = {Towards(0.0, 0.7, Astronomical)};
  options.eclipser_S.resize(2);
  EXPECT_THROW(WriteIllumination(horizons, options, this->Path("no.tif")), Error);
}

// A high Sun at the wall's sloping outline: the disc is points on the sphere, each behind the wall
// or over it.
TEST_F(Walled, AHighDiscIsCutAtTheOutlinesSlopeInTheSky) {
  const HorizonMap horizons(this->Path("horizon.tif"));
  const double radius = std::asin(695700e3 / Astronomical);
  constexpr int Column = 54;
  constexpr double Away = Columns - 1.0 - Column;
  for (const double part : {-0.6, 0.0, 0.5, 0.9}) {
    // The wall is 45 degrees high at the azimuth of 30 degrees.
    const V center = Towards(M_PI / 6.0, 0.25 * M_PI + part * radius, 1.0);
    const V right = center.cross(V::UnitZ()).normalized();
    const V up = right.cross(center);
    int lit = 0, all = 0;
    for (int ring = 0; ring < 100; ++ring) {
      for (int k = 0; k < 200; ++k, ++all) {
        const double r = std::tan(radius) * std::sqrt((ring + 0.5) / 100.0);
        const double angle = 2.0 * M_PI * (k + 0.5 * (ring % 2)) / 200.0;
        const V d = center + r * (std::cos(angle) * right + std::sin(angle) * up);
        lit += d.z() * Away > d.x() * Wall;
      }
    }
    IlluminationOptions options;
    options.sun_S = {Astronomical * center};
    const std::string path = this->Path("high" + std::to_string(part) + ".tif");
    ASSERT_TRUE(WriteIllumination(horizons, options, path));
    EXPECT_NEAR(BandsOf(path)[0][Column], double(lit) / all, 5e-3) << part;
  }
}

// On a smooth body each cell has its own vertical: the Sun is up where it is above the cell's
// plane, and a near Earth is seen from the cell, not from the body's centre.
TEST(Illumination, CellsOfABodyHaveTheirOwnHorizontal) {
  const TemporaryFolder folder;
  const auto terrain = OnBody(WriteDegrees(folder, "level.tif", 1737400.0, 240, 200, 30.0, 85.0,
                                           0.05, [](double, double) { return 0.0; }));
  const MapGround ground = MapGroundOf(*terrain);
  HorizonMapOptions options;
  options.cells = FindCells(ground, std::nullopt, 0.0);
  options.cells.every = 64; // 0.1 degrees
  options.cells.columns = 90;
  options.cells.rows = 70;
  options.azimuths = 8;
  const std::string path = (folder.Path() / "horizon.tif").string();
  ASSERT_TRUE(WriteHorizonMap(ground, options, path));
  const HorizonMap horizons(path);
  IlluminationOptions lit;
  lit.quantities = {Q::LitFraction, Q::EarthFraction};
  lit.sun_S = {Astronomical * Direction(190.0, 8.0).eval()};
  lit.earth_S = {384400e3 * Direction(190.0, 8.0).eval()};
  const std::string out = (folder.Path() / "lit.tif").string();
  ASSERT_TRUE(WriteIllumination(horizons, lit, out));
  const auto bands = BandsOf(out);
  int partly = 0;
  int earth = 0;
  for (int i = 0; i < 90 * 70; ++i) {
    const V place = ground.placement.ToScene(options.cells.Post(i % 90, i / 90), 0.0);
    const V up = place.normalized();
    const double elevation = std::asin(up.dot((lit.sun_S[0] - place).normalized()));
    const double x = std::clamp(elevation / std::asin(lit.sunRadius / Astronomical), -1.0, 1.0);
    const double expected = 1.0 - (std::acos(x) - x * std::sqrt(1.0 - x * x)) / M_PI;
    // The next post of the sphere is 2e-3 degrees below its plane.
    EXPECT_NEAR(bands[0][std::size_t(i)], expected, 0.006) << i;
    const double above = std::asin(up.dot((lit.earth_S[0] - place).normalized()));
    if (std::abs(above) > 5e-5) {
      EXPECT_EQ(bands[1][std::size_t(i)], above > 0.0 ? 1.0f : 0.0f) << i;
    }
    partly += expected > 0.02 && expected < 0.98;
    earth += above > 0.0;
  }
  EXPECT_GT(partly, 50);
  EXPECT_GT(earth, 200);
  EXPECT_LT(earth, 90 * 70 - 200);
}

TEST_F(Walled, BadInputIsRejected) {
  const HorizonMap horizons(this->Path("horizon.tif"));
  IlluminationOptions options;
  EXPECT_THROW(WriteIllumination(horizons, options, this->Path("bad.tif")), Error);
  options.sun_S = {Towards(1.0, 0.1, Astronomical)};
  options.step_s = 0.0;
  EXPECT_THROW(WriteIllumination(horizons, options, this->Path("bad.tif")), Error);
  options.step_s = 1.0;
  options.quantities = {Q::EarthFraction};
  EXPECT_THROW(WriteIllumination(horizons, options, this->Path("bad.tif")), Error);
}

} // namespace
} // namespace dspace::testing
