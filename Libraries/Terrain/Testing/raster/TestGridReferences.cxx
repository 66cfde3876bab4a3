// Grid references: against published values and PROJ.
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <proj.h>

#include <dspace/Error.h>
#include <dspace/crs/GridReferences.h>

namespace {

using namespace dspace;

constexpr double Degree = M_PI / 180.0;

// GeographicLib's manual page of GeoConvert.
TEST(GridReferences, AreThoseOfTheManual) {
  const MgrsSquare square = SquareOfMgrs("38SMB4488");
  EXPECT_NEAR(square.center.x(), 44.40363, 5e-6);
  EXPECT_NEAR(square.center.y(), 33.33424, 5e-6);
  EXPECT_EQ(square.side, 1000.0);
  const UtmPlace utm = UtmOf(square.center);
  EXPECT_EQ(utm.zone, 38);
  EXPECT_TRUE(utm.north);
  EXPECT_NEAR(utm.easting, 444500.0, 1e-6);
  EXPECT_NEAR(utm.northing, 3688500.0, 1e-6);
  EXPECT_EQ(MgrsOf({44.4, 33.0 + 20.0 / 60.0}, 2), "38SMB4488");
  EXPECT_EQ(MgrsOf({44.4, 33.0 + 20.0 / 60.0}, 1), "38SMB48");
}

// Greenwich's neighbours on the equator, the exceptions of Norway and Svalbard, UPS about the
// poles.
TEST(GridReferences, HaveTheirZones) {
  const UtmPlace utm = UtmOf({3.0, 0.0}); // on the central meridian of zone 31
  EXPECT_EQ(utm.zone, 31);
  EXPECT_NEAR(utm.easting, 500000.0, 1e-6);
  EXPECT_NEAR(utm.northing, 0.0, 1e-6);
  EXPECT_EQ(MgrsOf({3.0, 0.0}), "31NEA0000000000");
  EXPECT_EQ(MgrsOf({3.0, 0.0}, 0), "31NEA");
  EXPECT_EQ(UtmOf({5.0, 60.0}).zone, 32);
  EXPECT_EQ(UtmOf({5.0, 55.0}).zone, 31);
  EXPECT_EQ(UtmOf({8.0, 78.0}).zone, 31);
  EXPECT_EQ(UtmOf({10.0, 78.0}).zone, 33);
  EXPECT_EQ(UtmOf({-180.0, 10.0}).zone, 1);
  EXPECT_EQ(UtmOf({180.0, 10.0}).zone, 1);
  EXPECT_EQ(UtmOf({5.0, 60.0}, 31).zone, 31); // asked for
  const UtmPlace pole = UtmOf({12.0, 90.0});
  EXPECT_EQ(pole.zone, 0);
  EXPECT_NEAR(pole.easting, 2e6, 1e-6);
  EXPECT_NEAR(pole.northing, 2e6, 1e-6);
  EXPECT_EQ(MgrsOf({0.0, 90.0}), "ZAH0000000000");
  EXPECT_FALSE(UtmOf({0.0, -85.0}).north);
}

TEST(GridReferences, AreThoseOfProj) {
  PJ_CONTEXT* context = proj_context_create();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 600; ++i) {
    const Eigen::Vector2d place(180.0 * unit(random),
                                i % 4 ? 80.0 * unit(random) : 90.0 * unit(random));
    const UtmPlace utm = UtmOf(place);
    const std::string south = utm.north ? "" : " +south";
    const std::string text =
        utm.zone != 0 ? "+proj=utm +ellps=WGS84 +zone=" + std::to_string(utm.zone) + south
                      : "+proj=ups +ellps=WGS84" + south;
    PJ* projection = proj_create(context, text.c_str());
    ASSERT_TRUE(projection) << text;
    const PJ_COORD there = proj_trans(projection, PJ_FWD,
                                      proj_coord(place.x() * Degree, place.y() * Degree, 0.0, 0.0));
    EXPECT_NEAR(utm.easting, there.xy.x, 1e-6) << text;
    EXPECT_NEAR(utm.northing, there.xy.y, 1e-6) << text;
    proj_destroy(projection);
    const Eigen::Vector2d back = PlaceOfUtm(utm);
    EXPECT_NEAR(back.y(), place.y(), 1e-10);
    EXPECT_NEAR(std::remainder(back.x() - place.x(), 360.0) * std::cos(place.y() * Degree), 0.0,
                1e-10);
    const MgrsSquare square = SquareOfMgrs(MgrsOf(place, 5)); // half a diagonal away at most
    EXPECT_LT(std::hypot(square.center.y() - place.y(),
                         std::remainder(square.center.x() - place.x(), 360.0) *
                             std::cos(place.y() * Degree)) *
                  Degree * 6.4e6,
              0.73);
    EXPECT_EQ(square.side, 1.0);
  }
  proj_context_destroy(context);
}

TEST(GridReferences, RejectsWhatIsOutside) {
  const auto message = [](auto give) {
    try {
      give();
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(message([] { UtmOf({0.0, 91.0}); }).find("latitude 91"), std::string::npos);
  EXPECT_NE(message([] { UtmOf({NAN, 1.0}); }).find("nan"), std::string::npos);
  EXPECT_NE(message([] { UtmOf({3.0, 1.0}, 61); }).find("zone is 61"), std::string::npos);
  EXPECT_NE(message([] { UtmOf({3.0, 1.0}, -1); }).find("zone is -1"), std::string::npos);
  EXPECT_NE(message([] { UtmOf({3.0, 1.0}, 12); }).find("near the zone"), std::string::npos);
  EXPECT_NE(message([] { PlaceOfUtm({77, true, 5e5, 0.0}); }).find("zone 77"), std::string::npos);
  EXPECT_NE(message([] { PlaceOfUtm({33, true, 5e9, 0.0}); }).find("5e+09"), std::string::npos);
  EXPECT_NE(message([] { PlaceOfUtm({33, true, NAN, 0.0}); }).find("finite"), std::string::npos);
  EXPECT_NE(message([] { MgrsOf({3.0, 0.0}, 12); }).find("12"), std::string::npos);
  for (const char* text : {"", "38", "38S", "INV", "38SMB448", "99SMB4488", "38IMB4488", "hello",
                           "38SMB44 88", "38SAA0000"}) {
    EXPECT_NE(message([&] { SquareOfMgrs(text); }).find(std::string("'") + text + "'"),
              std::string::npos)
        << text;
  }
}

TEST(GridReferences, AreOfWgs84Only) {
  EXPECT_TRUE(IsWgs84({6378137.0, 6356752.314245179}));
  EXPECT_TRUE(IsWgs84({6378137.0, 6356752.314140356})); // GRS 80
  EXPECT_FALSE(IsWgs84({6378206.4, 6356583.8}));        // Clarke 1866
  EXPECT_FALSE(IsWgs84({1737400.0, 1737400.0}));
}

} // namespace
