// Which rasters lie in the stereographic plane of a pole, and where; the body of a raster.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/raster/PolarGrid.h>
#include <dspace/raster/RasterBody.h>

namespace {

using namespace dspace;

constexpr double Moon = 1737400.0;

// 100 x 80 pixels from a corner of the map on.
ElevationInfo Raster(const std::string& crs, const std::array<double, 6>& g) {
  ElevationInfo info;
  info.path = "raster.tif";
  info.crs = Crs::FromText(crs);
  info.georeferenced = true;
  info.window = {0, 0, 100, 80};
  info.pixelToMap.linear() << g[1], g[2], g[4], g[5];
  info.pixelToMap.translation() << g[0], g[3];
  info.verticalDatum = VerticalDatum::FromText("sphere");
  info.verticalDatum.radius = info.crs.GetAxes().semiMajor;
  return info;
}

std::string Stereographic(const std::string& more, const std::string& unit = "m") {
  return "+proj=stere +R=1737400 +units=" + unit + " +no_defs " + more;
}

Error::Kind KindOf(const ElevationInfo& info, const std::string& says) {
  try {
    PolarGridOf(info);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    return error.GetKind();
  }
  ADD_FAILURE() << "not rejected: " << says;
  return Error::Kind::Io;
}

// Snyder 1987, p. 157: the south pole's Y axis leads along the central meridian, the north pole's
// away from it; X is 90 degrees to the east of that and of its opposite.
TEST(PolarGrid, ScaleOriginAndTurnAreThoseOfTheProjection) {
  const std::array<double, 6> g = {-4000.0, 50.0, 0.0, 3000.0, 0.0, -50.0};
  auto grid = PolarGridOf(Raster(Stereographic("+lat_0=-90 +lon_0=20"), g));
  ASSERT_TRUE(grid);
  EXPECT_TRUE(grid->south);
  EXPECT_NEAR(grid->step, 0.5 * 50.0 / Moon, 1e-15);
  EXPECT_LT((grid->pole - Eigen::Vector2d(79.5, 59.5)).norm(), 1e-9);
  EXPECT_NEAR(grid->east_deg, 110.0, 1e-9);

  grid = PolarGridOf(Raster(Stereographic("+lat_0=90 +lon_0=-30 +k=0.9 +x_0=500 +y_0=-250"), g));
  ASSERT_TRUE(grid);
  EXPECT_FALSE(grid->south);
  EXPECT_NEAR(grid->step, 0.5 * 50.0 / (0.9 * Moon), 1e-15);
  EXPECT_LT((grid->pole - Eigen::Vector2d(89.5, 64.5)).norm(), 1e-9);
  EXPECT_NEAR(grid->east_deg, 60.0, 1e-9);

  // True at a latitude: k = (1 + sin 70 deg) / 2 (Snyder 1987, 21-7 and 21-33).
  grid = PolarGridOf(Raster(Stereographic("+lat_0=-90 +lat_ts=-70"), g));
  ASSERT_TRUE(grid);
  EXPECT_NEAR(grid->step * 2.0 * Moon / 50.0, 2.0 / (1.0 + std::sin(70.0 * M_PI / 180.0)), 1e-9);

  // In kilometres, and rotated by 30 degrees against the clock.
  const double c = 0.05 * std::cos(M_PI / 6.0), s = 0.05 * std::sin(M_PI / 6.0);
  grid = PolarGridOf(Raster(Stereographic("+lat_0=-90", "km"), {-4.0, c, s, 3.0, s, -c}));
  ASSERT_TRUE(grid);
  EXPECT_NEAR(grid->step, 0.5 * 50.0 / Moon, 1e-15);
  EXPECT_NEAR(grid->east_deg, 60.0, 1e-9);
}

TEST(PolarGrid, OtherRastersAreNoneOfIt) {
  const std::array<double, 6> g = {-4000.0, 50.0, 0.0, 3000.0, 0.0, -50.0};
  for (const char* crs : {"+proj=stere +lat_0=-80 +R=1737400", "+proj=laea +lat_0=-90 +R=1737400",
                          "+proj=eqc +R=1737400", "+proj=stere +lat_0=-90 +a=3396190 +b=3376200"}) {
    EXPECT_FALSE(PolarGridOf(Raster(crs, g))) << crs;
  }
  EXPECT_FALSE(PolarGridOf(Raster("+proj=longlat +R=1737400", {0, 0.1, 0, 10, 0, -0.1})));
  ElevationInfo nowhere = Raster(Stereographic("+lat_0=-90"), g);
  nowhere.georeferenced = false;
  EXPECT_FALSE(PolarGridOf(nowhere));
}

TEST(PolarGrid, PixelsMustBeSquareAndNotMirrored) {
  const std::string crs = Stereographic("+lat_0=-90");
  EXPECT_EQ(KindOf(Raster(crs, {0, 50, 0, 0, 0, 50}), "mirrored"), Error::Kind::Unsupported);
  EXPECT_EQ(KindOf(Raster(crs, {0, 50, 0, 0, 0, -51}), "no squares"), Error::Kind::Unsupported);
  EXPECT_EQ(KindOf(Raster(crs, {0, 50, 3, 0, 0, -50}), "no squares"), Error::Kind::Unsupported);
  EXPECT_EQ(KindOf(Raster(crs, {-7e6, 1e5, 0, 7e6, 0, -1e5}), "up to 125"),
            Error::Kind::Unsupported);
}

TEST(RasterBody, IsTheSphereOfTheHeightsOrTheEllipsoidOfTheDegrees) {
  const std::array<double, 6> g = {0, 0.1, 0, 10, 0, -0.1};
  ElevationInfo info = Raster("+proj=longlat +R=1737400", g);
  EXPECT_EQ(BodyOfRaster(info).Equatorial(), Moon);
  info.verticalDatum.radius = 1738000.0;
  EXPECT_EQ(BodyOfRaster(info).Equatorial(), 1738000.0);
  EXPECT_EQ(BodyOfRaster(info).Polar(), 1738000.0);

  info = Raster("+proj=longlat +a=3396190 +b=3376200", g);
  const auto kind = [&] {
    try {
      BodyOfRaster(info);
    } catch (const Error& error) {
      return error.GetKind();
    }
    return Error::Kind::Io;
  };
  EXPECT_EQ(kind(), Error::Kind::Unsupported); // heights over a sphere
  info.verticalDatum = VerticalDatum::FromText("ellipsoid");
  EXPECT_EQ(BodyOfRaster(info).Equatorial(), 3396190.0);
  EXPECT_NEAR(BodyOfRaster(info).Polar(), 3376200.0, 1e-6);
  info.crs = Crs::FromText("+proj=stere +lat_0=-90 +a=3396190 +b=3376200");
  EXPECT_EQ(kind(), Error::Kind::Unsupported); // a projection of an ellipsoid
}

} // namespace
