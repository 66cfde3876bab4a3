// Body-fixed coordinates against published values and PROJ called directly.
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <proj.h>

#include <dspace/crs/BodyCoordinates.h>
#include <dspace/crs/Crs.h>
#include <dspace/surface/GridTerrain.h>

namespace {

using dspace::BodyAxes;
using dspace::BodyCoordinates;
using dspace::BodyCoordinatesOf;
using dspace::Crs;
using dspace::GeodeticToBodyFixed;
using dspace::VerticalDatum;

const BodyAxes Wgs84{6378137.0, 6378137.0 * (1.0 - 1.0 / 298.257223563)};
constexpr double Millimetre = 1e-3;

} // namespace

// EPSG Guidance Note 7-2, section 4.1.1: the North Sea point. GeographicLib's CartConvert: the
// example of its manual page, to the centimetre that it prints.
TEST(BodyCoordinates, PublishedValues) {
  const double latitude = 53.0 + 48.0 / 60.0 + 33.820 / 3600.0;
  const double longitude = 2.0 + 7.0 / 60.0 + 46.380 / 3600.0;
  const Eigen::Vector3d sea = GeodeticToBodyFixed(Wgs84, longitude, latitude, 73.0);
  EXPECT_NEAR(sea.x(), 3771793.968, Millimetre);
  EXPECT_NEAR(sea.y(), 140253.342, Millimetre);
  EXPECT_NEAR(sea.z(), 5124304.349, Millimetre);
  const Eigen::Vector3d cart = GeodeticToBodyFixed(Wgs84, 44.4, 33.3, 6000.0);
  EXPECT_NEAR(cart.x(), 3816209.60, 5e-3);
  EXPECT_NEAR(cart.y(), 3737108.55, 5e-3);
  EXPECT_NEAR(cart.z(), 3485109.57, 5e-3);
}

TEST(BodyCoordinates, EllipsoidsAgainstProj) {
  for (const BodyAxes& axes : {Wgs84, BodyAxes{1737400.0, 1737400.0},
                               BodyAxes{3396190.0, 3376200.0}, BodyAxes{285000.0, 229000.0}}) {
    const std::string text =
        "+proj=cart +a=" + std::to_string(axes.semiMajor) + " +b=" + std::to_string(axes.semiMinor);
    // std::to_string has six digits after the point: the axes that PROJ gets.
    const BodyAxes given{std::stod(std::to_string(axes.semiMajor)),
                         std::stod(std::to_string(axes.semiMinor))};
    PJ* cart = proj_create(PJ_DEFAULT_CTX, text.c_str());
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 2000; ++i) {
      const double lon = 180.0 * unit(random);
      const double lat = i % 100 == 0 ? (i % 200 ? 90.0 : -90.0) : 90.0 * unit(random);
      const double height = 20000.0 * unit(random);
      const PJ_COORD p =
          proj_trans(cart, PJ_FWD, proj_coord(proj_torad(lon), proj_torad(lat), height, 0.0));
      const Eigen::Vector3d expected(p.xyz.x, p.xyz.y, p.xyz.z);
      EXPECT_LT((GeodeticToBodyFixed(given, lon, lat, height) - expected).norm(),
                1e-3 * Millimetre);
    }
    proj_destroy(cart);
  }
}

// A zero that is a sphere of another radius: the place is that far from the centre, on the normal.
TEST(BodyCoordinates, HeightsAboveASphere) {
  const BodyAxes mars{3396190.0, 3376200.0};
  const VerticalDatum sphere{VerticalDatum::Kind::Sphere, 3396000.0, ""};
  for (const double latitude : {-90.0, -30.0, 0.0, 45.0, 89.0}) {
    const BodyCoordinates place = BodyCoordinatesOf(mars, sphere, 77.0, latitude, 1234.5);
    EXPECT_NEAR(place.bodyFixed.norm(), 3396000.0 + 1234.5, 1e-6);
    EXPECT_LT((GeodeticToBodyFixed(mars, 77.0, latitude, place.height) - place.bodyFixed).norm(),
              1e-9);
  }
  const BodyAxes moon{1737400.0, 1737400.0};
  EXPECT_NEAR(
      BodyCoordinatesOf(moon, {VerticalDatum::Kind::Radius, 1737000.0, ""}, 0, 0, 10).height,
      -390.0, 1e-6);
}

// Map points of projected, geographic and west-positive systems through PROJ's own pipelines.
TEST(BodyCoordinates, LocateAgainstProj) {
  struct Case {
    const char* crs;
    const char* pipeline; // from map x, y to body-fixed
    Eigen::Vector2d middle;
    double reach;
  };
  const Case cases[] = {
      {"EPSG:32633",
       "+proj=pipeline +step +inv +proj=utm +zone=33 +ellps=WGS84 +step +proj=cart +ellps=WGS84",
       {500000.0, 5500000.0},
       3e5},
      {"+proj=stere +lat_0=-90 +R=1737400 +units=m +no_defs",
       "+proj=pipeline +step +inv +proj=stere +lat_0=-90 +R=1737400 +step +proj=cart +R=1737400",
       {0.0, 0.0},
       2e5},
      {"EPSG:4326",
       "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad +step +proj=cart "
       "+ellps=WGS84",
       {15.0, 40.0},
       30.0},
      {"+proj=eqc +lon_0=180 +lat_ts=20 +a=3396190 +b=3376200 +units=m +no_defs",
       "+proj=pipeline +step +inv +proj=eqc +lon_0=180 +lat_ts=20 +a=3396190 +b=3376200 +step "
       "+proj=cart +a=3396190 +b=3376200",
       {0.0, 0.0},
       2e6}};
  for (const Case& each : cases) {
    const Crs crs = Crs::FromText(each.crs);
    Eigen::Affine2d toMap = Eigen::Affine2d::Identity();
    toMap.linear() << each.reach, 0.0, 0.0, -each.reach;
    toMap.translation() = each.middle;
    const dspace::GridTerrain terrain("terrain 'ground'", 2, 2, {0, 0, 0, 0}, toMap, crs,
                                      {VerticalDatum::Kind::Ellipsoid, 0.0, ""});
    PJ* pipeline = proj_create(PJ_DEFAULT_CTX, each.pipeline);
    ASSERT_NE(pipeline, nullptr) << each.pipeline;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    dspace::Rows3 points(500, 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      points.row(i) << each.middle.x() + each.reach * unit(random),
          each.middle.y() + each.reach * unit(random), 5000.0 * unit(random);
    }
    const std::vector<BodyCoordinates> places = terrain.Locate(points);
    double worst = 0.0;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const PJ_COORD p =
          proj_trans(pipeline, PJ_FWD, proj_coord(points(i, 0), points(i, 1), points(i, 2), 0.0));
      worst = std::max(
          worst,
          (places[std::size_t(i)].bodyFixed - Eigen::Vector3d(p.xyz.x, p.xyz.y, p.xyz.z)).norm());
    }
    EXPECT_LT(worst, Millimetre) << each.crs;
    proj_destroy(pipeline);
  }
  const dspace::GridTerrain plane("terrain 'plane'", 2, 2, {0, 0, 0, 0},
                                  Eigen::Affine2d::Identity());
  EXPECT_TRUE(std::isnan(plane.Locate(dspace::Rows3::Zero(1, 3))[0].longitude_deg));
}
