// Geodesics: against published values, closed forms and PROJ's own implementation.
#include <cmath>
#include <random>

#include <geodesic.h>
#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/crs/Geodesics.h>

namespace {

using namespace dspace;

constexpr double Equatorial = 6378137.0;
constexpr double Polar = 6356752.314245179; // NIMA TR8350.2

double Apart(double a, double b) {
  return std::abs(std::remainder(a - b, 360.0));
}

// The test set of GeographicLib's geodesic routines: latitude, longitude, azimuth of both ends
// [deg] and the distance [m], to 1e-13 deg and 0.1 nm (C. F. F. Karney, geodesictest.c).
constexpr double Published[][7] = {{35.60777, -139.44815, 111.098748429560326, -11.17491, -69.95921,
                                    129.289270889708762, 8935244.5604818305},
                                   {55.52454, 106.05087, 22.020059880982801, 77.03196, 197.18234,
                                    109.112041110671519, 4105086.1713924406},
                                   {-21.97856, 142.59065, -32.44456876433189, 41.84138, 98.56635,
                                    -41.84359951440466, 8394328.894657671},
                                   {-66.99028, 112.2363, 173.73491240878403, -12.70631, 285.90344,
                                    2.512956620913668, 11150344.2312080241},
                                   {-17.42761, 173.34268, -159.033557661192928, -15.84784, 5.93557,
                                    -20.787484651536988, 16076603.1631180673},
                                   {32.84994, 48.28919, 150.492927788121982, -56.28556, 202.29132,
                                    48.113449399816759, 16727068.9438164461}};

TEST(Geodesics, AreThoseOfKarneysTestSet) {
  const Geodesics earth(BodyEllipsoid(Equatorial, Polar));
  for (const auto& row : Published) {
    const Geodesic line = earth.Between({row[1], row[0]}, {row[4], row[3]});
    EXPECT_NEAR(line.distance, row[6], 1e-7);
    EXPECT_LT(Apart(line.azimuth_deg, row[2]), 1e-12);
    EXPECT_LT(Apart(line.endAzimuth_deg, row[5]), 1e-12);
    EXPECT_TRUE(line.azimuth_deg >= 0.0 && line.azimuth_deg <= 360.0);
    const GeodesicEnd end = earth.EndOf({row[1], row[0]}, row[2], row[6]);
    EXPECT_LT(Apart(end.place.x(), row[4]), 1e-12);
    EXPECT_NEAR(end.place.y(), row[3], 1e-12);
    EXPECT_LT(Apart(end.azimuth_deg, row[5]), 1e-12);
    const GeodesicEnd back = earth.EndOf({row[4], row[3]}, row[5], -row[6]);
    EXPECT_NEAR(back.place.y(), row[0], 1e-12);
  }
}

TEST(Geodesics, AreThoseOfProj) {
  for (const double flattening : {0.0, 1.0 / 298.257223563, 1.0 / 154.4}) { // the Moon, Earth, Mars
    const double radius = 3396190.0;
    const Geodesics body(BodyEllipsoid(radius, radius * (1.0 - flattening)));
    geod_geodesic proj;
    geod_init(&proj, radius, flattening);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector2d from(180.0 * unit(random), 90.0 * unit(random));
      const Eigen::Vector2d to(360.0 * unit(random), i % 2 ? 90.0 * unit(random) : -from.y());
      double distance = 0.0, azimuth = 0.0, endAzimuth = 0.0;
      geod_inverse(&proj, from.y(), from.x(), to.y(), to.x(), &distance, &azimuth, &endAzimuth);
      const Geodesic line = body.Between(from, to);
      EXPECT_NEAR(line.distance, distance, 1e-7);
      EXPECT_LT(Apart(line.azimuth_deg, azimuth) * std::sin(distance / radius), 1e-9);
      const GeodesicEnd end = body.EndOf(from, azimuth, 0.25 * distance);
      double latitude = 0.0, longitude = 0.0;
      geod_direct(&proj, from.y(), from.x(), azimuth, 0.25 * distance, &latitude, &longitude,
                  nullptr);
      EXPECT_NEAR(end.place.y(), latitude, 1e-11);
      EXPECT_LT(Apart(end.place.x(), longitude) * std::cos(latitude * M_PI / 180.0), 1e-11);
    }
  }
}

// A quarter of the meridian is a E(e), of the equator a pi / 2; on a sphere lines are great
// circles.
TEST(Geodesics, OfAnyEllipsoidHaveTheirClosedForms) {
  for (const double flattening : {0.0, 0.0033, 0.0098, 0.0102, 0.2, 0.5}) {
    const double radius = 1e6;
    const Geodesics body(BodyEllipsoid(radius, radius * (1.0 - flattening)));
    const double e = std::sqrt(flattening * (2.0 - flattening));
    EXPECT_NEAR(body.Between({10.0, 0.0}, {10.0, 90.0}).distance, radius * std::comp_ellint_2(e),
                1e-6);
    EXPECT_NEAR(body.Between({10.0, 0.0}, {80.0, 0.0}).distance, radius * 70.0 * M_PI / 180.0,
                1e-6);
    EXPECT_NEAR(body.Between({10.0, 0.0}, {80.0, 0.0}).azimuth_deg, 90.0, 1e-12);
    EXPECT_NEAR(body.EndOf({10.0, 0.0}, 0.0, radius * std::comp_ellint_2(e)).place.y(), 90.0, 1e-9);
  }
  const Geodesics moon(BodyEllipsoid(1737400.0, 1737400.0));
  const double a = 20.0 * M_PI / 180.0, b = -35.0 * M_PI / 180.0, d = 70.0 * M_PI / 180.0;
  const double angle =
      std::acos(std::sin(a) * std::sin(b) + std::cos(a) * std::cos(b) * std::cos(d));
  EXPECT_NEAR(moon.Between({0.0, 20.0}, {70.0, -35.0}).distance, 1737400.0 * angle, 1e-6);
  EXPECT_EQ(moon.Between({3.0, 4.0}, {3.0, 4.0}).distance, 0.0);
}

// Expected values: test "Planimeter0" of GeographicLib (C. F. F. Karney, geodtest.c), latitudes
// first there.
TEST(Geodesics, PolygonsHaveThePublishedAreas) {
  const Geodesics earth(BodyEllipsoid(Equatorial, Polar));
  const GeodesicPolygon pole = earth.Around({{0, 89}, {90, 89}, {180, 89}, {270, 89}});
  EXPECT_NEAR(pole.perimeter, 631819.8745, 1e-4);
  EXPECT_NEAR(pole.area, 24952305678.0, 1.0);
  EXPECT_NEAR(earth.Around({{0, -89}, {90, -89}, {180, -89}, {270, -89}}).area, 24952305678.0, 1.0);
  const GeodesicPolygon crossing = earth.Around({{-1, 0}, {0, -1}, {1, 0}, {0, 1}});
  EXPECT_NEAR(crossing.perimeter, 627598.2731, 1e-4);
  EXPECT_NEAR(crossing.area, 24619419146.0, 1.0);
  EXPECT_NEAR(earth.Around({{0, 1}, {1, 0}, {0, -1}, {-1, 0}}).area, 24619419146.0, 1.0);
  const GeodesicPolygon octant = earth.Around({{0, 90}, {0, 0}, {90, 0}});
  EXPECT_NEAR(octant.perimeter, 30022685.0, 1.0);
  EXPECT_NEAR(octant.area, 63758202715511.0, 1.0);
  // Of a sphere: Girard's theorem; a strong flattening: the elliptic integrals' halves add up.
  const double radius = 1737400.0;
  EXPECT_NEAR(Geodesics(BodyEllipsoid(radius, radius)).Around({{0, 90}, {0, 0}, {90, 0}}).area,
              0.5 * M_PI * radius * radius, 1e-3);
  const double flat = 0.75 * radius, e = std::sqrt(1.0 - 0.75 * 0.75);
  const double surface = 2.0 * M_PI * (radius * radius + flat * flat * std::atanh(e) / e);
  EXPECT_NEAR(Geodesics(BodyEllipsoid(radius, flat)).Around({{0, 90}, {0, 0}, {90, 0}}).area,
              surface / 8.0, 1e-6 * surface);
}

TEST(Geodesics, RejectsWhatIsNoPlace) {
  const Geodesics earth(BodyEllipsoid(Equatorial, Polar));
  EXPECT_THROW(earth.Between({0.0, 90.001}, {0.0, 0.0}), Error);
  EXPECT_THROW(earth.Between({0.0, 0.0}, {0.0, -91.0}), Error);
  EXPECT_THROW(earth.Between({NAN, 0.0}, {0.0, 0.0}), Error);
  EXPECT_THROW(earth.EndOf({0.0, 0.0}, INFINITY, 1.0), Error);
  EXPECT_THROW(earth.EndOf({0.0, 0.0}, 1.0, NAN), Error);
  EXPECT_THROW(earth.Around({{0, 0}, {1, 0}}), Error);
  EXPECT_THROW(earth.Around({{0, 0}, {1, 0}, {0, 91}}), Error);
  try {
    earth.Between({0.0, 0.0}, {12.0, 91.0});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument);
    EXPECT_NE(std::string(error.what()).find("longitude 12, latitude 91"), std::string::npos);
  }
}

} // namespace
