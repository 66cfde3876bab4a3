// CRS, scene frame and vertical datum against PROJ called directly and against closed forms.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>

#include <gtest/gtest.h>
#include <ogr_spatialref.h>
#include <proj.h>

#include <dspace/Error.h>
#include <dspace/Utf8.h>
#include <dspace/crs/Crs.h>
#include <dspace/crs/CrsTransform.h>
#include <dspace/crs/SceneFrame.h>
#include <dspace/crs/VerticalDatum.h>

#include "TemporaryFolder.h"

namespace {

using dspace::BodyAxes;
using dspace::Crs;
using dspace::CrsTransform;
using dspace::Error;
using dspace::SceneFrame;
using dspace::VerticalDatum;

// PROJ's own forward projection of degrees; independent of the library's way through GDAL.
class Proj {
public:
  explicit Proj(const std::string& text) : Pj_(proj_create(PJ_DEFAULT_CTX, text.c_str())) {}
  ~Proj() { proj_destroy(this->Pj_); }
  Eigen::Vector2d operator()(double lon, double lat) const {
    const PJ_COORD p =
        proj_trans(this->Pj_, PJ_FWD, proj_coord(proj_torad(lon), proj_torad(lat), 0.0, 0.0));
    return {p.xy.x, p.xy.y};
  }

private:
  PJ* Pj_;
};

constexpr double R = 3396190.0;

Error::Kind KindOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.GetKind();
  }
  return Error::Kind::Internal;
}

} // namespace

// Old GeoTIFF and .prj files hold Latin-1; protobuf accepts no such text.
TEST(Crs, NamesOfAnotherEncodingBecomeUtf8) {
  OGRSpatialReference srs;
  ASSERT_EQ(srs.importFromWkt("PROJCS[\"Sch\xF6"
                              "fthal\",GEOGCS[\"Mond \xE4\","
                              "DATUM[\"D_\xFC\",SPHEROID[\"S\",1737400,0]],"
                              "PRIMEM[\"Reference_Meridian\",0],UNIT[\"Degree\","
                              "0.0174532925199433]],PROJECTION[\"Equirectangular\"],"
                              "PARAMETER[\"standard_parallel_1\",0],"
                              "PARAMETER[\"central_meridian\",0],UNIT[\"metre\",1]]"),
            OGRERR_NONE);
  const Crs crs = Crs::FromOgr(srs);
  EXPECT_EQ(crs.GetName(), "Sch\xC3\xB6"
                           "fthal");
  EXPECT_TRUE(dspace::IsUtf8(crs.GetWkt()));
  EXPECT_NE(crs.GetWkt().find("Sch\xC3\xB6"
                              "fthal"),
            std::string::npos);
  EXPECT_TRUE(dspace::IsUtf8(crs.Geographic().GetName()));
  EXPECT_EQ(crs.GetAxes().semiMajor, 1737400.0);
  // It is the same reference: the text leads back to it, and coordinates agree.
  const Crs again = Crs::FromText(crs.GetWkt());
  EXPECT_EQ(again.GetName(), crs.GetName());
  const Eigen::Vector2d p =
      CrsTransform(crs, Crs::FromText("+proj=longlat +R=1737400 +type=crs")).Apply({1e4, 2e4});
  EXPECT_NEAR(p.x(), 1e4 / 1737400.0 * 180.0 / M_PI, 1e-9);
  EXPECT_NEAR(p.y(), 2e4 / 1737400.0 * 180.0 / M_PI, 1e-9);
}

TEST(Crs, NamesItself) {
  const Crs moon = Crs::FromText("IAU_2015:30100");
  EXPECT_EQ(moon.GetKind(), Crs::Kind::Geographic);
  EXPECT_EQ(moon.GetAuthority(), "IAU_2015:30100");
  EXPECT_EQ(moon.GetAxes().semiMajor, 1737400.0);
  EXPECT_NEAR(moon.GetUnit(), 1.0, 1e-12);
  EXPECT_NE(moon.GetWkt().find("Moon"), std::string::npos);
  const Crs feet = Crs::FromText("EPSG:2227"); // California zone 3, US survey feet
  EXPECT_EQ(feet.GetKind(), Crs::Kind::Projected);
  EXPECT_NEAR(feet.GetUnit(), 1200.0 / 3937.0, 1e-15);
  EXPECT_EQ(Crs().GetKind(), Crs::Kind::None);
}

TEST(Crs, RejectsWhatItDoesNotKnow) {
  EXPECT_EQ(KindOf([] { Crs::FromText(""); }), Error::Kind::InvalidArgument);
  EXPECT_EQ(KindOf([] { Crs::FromText("EPSG:99999999"); }), Error::Kind::InvalidArgument);
  EXPECT_EQ(KindOf([] { Crs::FromText("no such thing"); }), Error::Kind::InvalidArgument);
  EXPECT_EQ(KindOf([] { Crs::FromText("EPSG:4978"); }), Error::Kind::Unsupported); // geocentric
  EXPECT_EQ(KindOf([] { Crs().Geographic(); }), Error::Kind::Unsupported);
  // A file is not read, whatever it holds.
  const dspace::testing::TemporaryFolder folder;
  const std::string file = folder / "crs.prj";
  std::ofstream(file) << Crs::FromText("EPSG:32633").GetWkt();
  EXPECT_EQ(KindOf([&] { Crs::FromText(file); }), Error::Kind::InvalidArgument);
  // The Moon is not Mars.
  EXPECT_EQ(KindOf([] {
              CrsTransform(Crs::FromText("IAU_2015:30100"), Crs::FromText("IAU_2015:49900"));
            }),
            Error::Kind::Unsupported);
}

TEST(Crs, ConvertsAsProjDoes) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> longitude(-179.0, 179.0), latitude(60.0, 89.9);
  struct Case {
    std::string text;
    double lowest;
  };
  for (const std::string& text : {std::string("+proj=stere +lat_0=90 +lon_0=0 +R=1737400"),
                                  std::string("+proj=eqc +lat_ts=30 +lon_0=20 +R=3396190"),
                                  std::string("+proj=utm +zone=33 +ellps=WGS84"),
                                  std::string("+proj=aeqd +lat_0=50 +lon_0=10 +R=1737400")}) {
    const bool utm = text.find("utm") != std::string::npos;
    const Crs crs = Crs::FromText(text + " +type=crs");
    const CrsTransform toGeographic(crs, crs.Geographic());
    const Proj proj(text);
    for (int i = 0; i < 100; ++i) {
      const double lon = utm ? 15.0 + longitude(random) / 60.0 : longitude(random);
      const double lat = latitude(random);
      const Eigen::Vector2d map = proj(lon, lat);
      EXPECT_LT((toGeographic.ApplyInverse({lon, lat}) - map).norm(), 1e-6) << text; // metres
      const Eigen::Vector2d back = toGeographic.Apply(map);
      EXPECT_NEAR(back.y(), lat, 1e-10) << text;
      EXPECT_NEAR(std::remainder(back.x() - lon, 360.0), 0.0, 1e-8) << text;
    }
  }
}

TEST(Crs, ScaleFactorsOfAPlateCarree) {
  const Crs crs = Crs::FromText("+proj=eqc +lon_0=180 +R=1737400 +type=crs");
  for (double latitude : {0.0, 30.0, -82.0}) {
    const Eigen::Vector2d scale = crs.ScaleFactors(10.0, latitude);
    EXPECT_NEAR(scale.x(), 1.0 / std::cos(latitude * M_PI / 180.0), 1e-6);
    EXPECT_NEAR(scale.y(), 1.0, 1e-6);
  }
}

TEST(Crs, WestPositiveLongitudeRunsAgainstEast) {
  const std::string wkt =
      "GEOGCRS[\"west\",DATUM[\"Mars\",ELLIPSOID[\"Mars\",3396190,169.894447223612]],"
      "PRIMEM[\"Reference Meridian\",0],CS[ellipsoidal,2],AXIS[\"latitude\",north,ORDER[1]],"
      "AXIS[\"longitude\",west,ORDER[2]],ANGLEUNIT[\"degree\",0.0174532925199433]]";
  const Crs crs = Crs::FromText(wkt);
  EXPECT_EQ(crs.GetAxisSigns(), Eigen::Vector2d(-1.0, 1.0));
  const SceneFrame frame(crs, {10.0, 0.0});
  EXPECT_LT(frame.MapToScene({11.0, 0.0, 0.0}).x(), 0.0); // further west
}

TEST(SceneFrame, IsTheEquidistantCylindricalOfASphere) {
  const Crs crs = Crs::FromText("IAU_2015:49900");
  const Eigen::Vector2d origin(137.4, -5.4);
  const SceneFrame frame(crs, origin, -4500.0);
  const Proj proj("+proj=eqc +lat_ts=-5.4 +lat_0=-5.4 +lon_0=137.4 +R=3396190");
  for (double lon : {134.3, 137.4, 141.2})
    for (double lat : {-8.9, -5.4, -1.9}) {
      const Eigen::Vector3d p_S = frame.MapToScene({lon, lat, -4400.0});
      EXPECT_LT((p_S.head<2>() - proj(lon, lat)).norm(), 1e-6); // metres
      EXPECT_EQ(p_S.z(), 100.0);
      EXPECT_LT((frame.SceneToMap(p_S) - Eigen::Vector3d(lon, lat, -4400.0)).norm(), 1e-11);
    }
}

TEST(SceneFrame, DistortsAsItsHeaderSays) {
  // 100 km around 5.4 S, against azimuthal equidistant, which is true along every line through the
  // origin: X is too long by cos(p0)/cos(p) and no more.
  const double lon0 = 137.4, lat0 = -5.4, degree = M_PI / 180.0;
  const SceneFrame frame(Crs::FromText("IAU_2015:49900"), {lon0, lat0});
  const Proj aeqd("+proj=aeqd +lat_0=-5.4 +lon_0=137.4 +R=3396190");
  for (int a = 0; a < 360; a += 15) {
    const double lat = lat0 + 1.687 * std::cos(a * degree); // 100 km
    const double lon = lon0 + 1.687 * std::sin(a * degree) / std::cos(lat0 * degree);
    const Eigen::Vector2d p = frame.MapToScene({lon, lat, 0.0}).head<2>();
    const Eigen::Vector2d q = aeqd(lon, lat);
    EXPECT_LT((p - q).norm(), 0.0030 * p.norm());
    EXPECT_LT(std::abs(p.norm() - 1.687 * degree * R), 1.0); // the circle asked for, in its plane
  }
  // On an ellipsoid: unit steps at the origin are the ground's, by numerical PROJ cartesian.
  const Crs earth = Crs::FromText("EPSG:4326");
  const SceneFrame local(earth, {-122.2, 38.0});
  PJ* cart = proj_create(PJ_DEFAULT_CTX, "+proj=cart +ellps=WGS84");
  const auto ecef = [&](double lon, double lat) {
    const PJ_COORD p =
        proj_trans(cart, PJ_FWD, proj_coord(proj_torad(lon), proj_torad(lat), 0.0, 0.0));
    return Eigen::Vector3d(p.xyz.x, p.xyz.y, p.xyz.z);
  };
  const double d = 0.001;
  EXPECT_NEAR(local.MapToScene({-122.2 + d, 38.0, 0.0}).x(),
              (ecef(-122.2 + d, 38.0) - ecef(-122.2, 38.0)).norm(), 1e-4);
  EXPECT_NEAR(local.MapToScene({-122.2, 38.0 + d, 0.0}).y(),
              (ecef(-122.2, 38.0 + 0.5 * d) - ecef(-122.2, 38.0 - 0.5 * d)).norm(), 1e-4);
  proj_destroy(cart);
}

TEST(SceneFrame, RejectsAPoleAndNaN) {
  const Crs crs = Crs::FromText("IAU_2015:49900");
  EXPECT_EQ(KindOf([&] { SceneFrame(crs, {0.0, 89.5}); }), Error::Kind::InvalidArgument);
  EXPECT_EQ(KindOf([&] { SceneFrame(crs, {std::nan(""), 0.0}); }), Error::Kind::InvalidArgument);
  EXPECT_EQ(KindOf([&] { SceneFrame(crs, {0.0, 0.0}, INFINITY); }), Error::Kind::InvalidArgument);
}

TEST(VerticalDatum, ReadsItsOwnText) {
  for (const char* text : {"unknown", "ellipsoid", "sphere", "sphere:3396190", "radius:1737400",
                           "areoid", "geoid", "relative"})
    EXPECT_EQ(VerticalDatum::FromText(text).Text(), text);
  for (const char* text : {"", "moon", "areoid:3", "sphere:", "sphere:-1", "sphere:1x"})
    EXPECT_EQ(KindOf([&] { VerticalDatum::FromText(text); }), Error::Kind::InvalidArgument) << text;
}

TEST(VerticalDatum, AreoidBoundHoldsAtMslsLanding) {
  // MSL: radius 3391.15 km at 4.592 S, MOLA height -4503 m: the sphere is off by 3396.19 - 4.503 -
  // 3391.15 = 0.537 km. Poles: the areoid is some 20 km below the sphere.
  const BodyAxes sphere{R, R};
  const VerticalDatum areoid = VerticalDatum::FromText("areoid");
  const double bound = DatumErrorBound(areoid, sphere, 4.592);
  EXPECT_GT(bound, 537.0);
  EXPECT_LT(bound, 2200.0);
  EXPECT_NEAR(DatumErrorBound(areoid, sphere, 90.0), 2000.0 + 19990.0, 1.0);
  EXPECT_NE(
      DatumWarning(areoid, sphere, 4.592).find(std::to_string(static_cast<int>(std::ceil(bound)))),
      std::string::npos);
  EXPECT_TRUE(std::isinf(DatumErrorBound(areoid, {1737400.0, 1737400.0}, 0.0)));
  EXPECT_EQ(DatumErrorBound(VerticalDatum::FromText("sphere:3396190"), sphere, 45.0), 0.0);
  EXPECT_TRUE(DatumWarning(VerticalDatum::FromText("sphere:3396190"), sphere, 45.0).empty());
  EXPECT_FALSE(DatumWarning(VerticalDatum(), sphere, 45.0).empty());
}
