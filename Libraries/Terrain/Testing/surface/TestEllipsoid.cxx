// Terrain on ellipsoids: against GeographicLib, PROJ and differences of places.
#include <cmath>
#include <random>
#include <string>

#include <GeographicLib/Geocentric.hpp>
#include <gtest/gtest.h>
#include <proj.h>

#include <dspace/Error.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Globe.h"

namespace {

using namespace dspace;
using dspace::testing::Bulges;
using dspace::testing::ByHand;
using dspace::testing::Degree;
using dspace::testing::Globe;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

constexpr double Equatorial = 6378137.0;
constexpr double Polar = 6356752.314245179; // NIMA TR8350.2

std::shared_ptr<StreamedTerrain> Earth(const TemporaryFolder& folder, Globe& globe,
                                       const std::string& crs = "EPSG:4326") {
  RasterFile file = globe.File();
  file.crs = crs;
  file.verticalDatum = "ellipsoid";
  StreamedTerrainOptions options;
  options.onBody = true;
  return StreamedTerrain::Open(file.Write(folder / "earth.tif"), options);
}

// Longitude, latitude [deg] and height to the body's axes, by PROJ.
class Proj {
public:
  Proj()
      : Context_(proj_context_create()),
        Cart_(proj_create(this->Context_, "+proj=cart +ellps=WGS84")) {}
  ~Proj() {
    proj_destroy(this->Cart_);
    proj_context_destroy(this->Context_);
  }
  Eigen::Vector3d At(double lon, double lat, double height) const {
    const PJ_COORD p =
        proj_trans(this->Cart_, PJ_FWD, proj_coord(lon * Degree, lat * Degree, height, 0.0));
    return {p.xyz.x, p.xyz.y, p.xyz.z};
  }

private:
  PJ_CONTEXT* Context_;
  PJ* Cart_;
};

TEST(Ellipsoid, PlacesHeightsAndVerticalsAreThoseOfGeographicLibAndProj) {
  const TemporaryFolder folder;
  Globe globe;
  globe.height = Bulges;
  const auto terrain = Earth(folder, globe);
  const GeographicLib::Geocentric& earth = GeographicLib::Geocentric::WGS84();
  const Proj proj;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 3000; ++i) {
    const double lon = 180.0 * unit(random);
    const double lat = i < 4 ? 90.0 * (i % 2 ? 1.0 : -1.0) : 89.99 * unit(random);
    const double height = i % 3 == 0 ? 4e5 * unit(random) : 3000.0 * unit(random);
    Eigen::Vector3d p;
    earth.Forward(lat, lon, height, p.x(), p.y(), p.z());
    EXPECT_LT((proj.At(lon, lat, height) - p).norm(), 1e-6);
    EXPECT_LT((terrain->MapToScene({lon, lat, height}) - p).norm(), 1e-6);
    const Eigen::Vector3d map = terrain->SceneToMap(p);
    EXPECT_NEAR(map.y(), lat, 1e-11);
    EXPECT_NEAR(map.z(), height, 1e-6);
    const Eigen::Vector3d up(std::cos(lat * Degree) * std::cos(lon * Degree),
                             std::cos(lat * Degree) * std::sin(lon * Degree),
                             std::sin(lat * Degree));
    EXPECT_LT((terrain->Up(p) - up).norm(), 1e-12);
    if (i < 4) {
      continue;
    }
    EXPECT_NEAR(std::remainder(map.x() - lon, 360.0), 0.0, 1e-9);
    const SurfaceSample sample = terrain->Sample(p);
    const double expected = ByHand(globe, lon, lat);
    ASSERT_NEAR(sample.height, expected, 2e-3) << lon << ", " << lat;
    earth.Forward(lat, lon, sample.height, p.x(), p.y(), p.z());
    EXPECT_LT((sample.position_S - p).norm(), 1e-3);
  }
}

TEST(Ellipsoid, NormalsAreSquareToTheGround) {
  const TemporaryFolder folder;
  Globe globe;
  globe.height = Bulges;
  const auto terrain = Earth(folder, globe);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int compared = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d at(180.0 * unit(random), 80.0 * unit(random));
    const double d = 1e-4; // [deg], some 10 m
    const SurfaceSample here = terrain->SampleMap(at);
    const SurfaceSample east = terrain->SampleMap(at + Eigen::Vector2d(d, 0.0));
    const SurfaceSample north = terrain->SampleMap(at + Eigen::Vector2d(0.0, d));
    const Eigen::Vector3d a = (east.position_S - here.position_S).normalized();
    const Eigen::Vector3d b = (north.position_S - here.position_S).normalized();
    const double off = std::max(std::abs(here.normal_S.dot(a)), std::abs(here.normal_S.dot(b)));
    compared += off < 5e-6; // but where a triangle ends between
  }
  EXPECT_GT(compared, 480);
}

// The nearest root of (p / (a, a, b))^2 = 1 along a ray.
double RayToEllipsoid(const Eigen::Vector3d& from, const Eigen::Vector3d& along, double a,
                      double b) {
  const Eigen::Vector3d scale(1.0 / a, 1.0 / a, 1.0 / b);
  const Eigen::Vector3d o = from.cwiseProduct(scale);
  const Eigen::Vector3d d = along.cwiseProduct(scale);
  const double half = o.dot(d) / d.squaredNorm();
  const double root = half * half - (o.squaredNorm() - 1.0) / d.squaredNorm();
  return root < 0.0 ? INFINITY : -half - std::sqrt(root);
}

TEST(Ellipsoid, RaysMeetItWhereTheClosedFormDoes) {
  const TemporaryFolder folder;
  Globe globe;
  globe.height = [](double, double) { return 0.0; };
  const auto terrain = Earth(folder, globe);
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  int hits = 0;
  for (int i = 0; i < 1500; ++i) {
    const Eigen::Vector3d from =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized() * Equatorial *
        (1.0 + 0.3 * (0.01 + i % 10));
    const Eigen::Vector3d to =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized() * Polar *
        (0.7 + 0.3 * (i % 5) / 4.0);
    const Eigen::Vector3d along = (to - from).normalized();
    const double truth = RayToEllipsoid(from, along, Equatorial, Polar);
    const RayHit hit = terrain->Intersect(from, along);
    ASSERT_EQ(hit.hit, std::isfinite(truth)) << i;
    if (!hit.hit) {
      continue;
    }
    ++hits;
    EXPECT_NEAR(hit.distance, truth, 1e-3 / std::max(1e-3, std::abs(hit.normal_S.dot(along))));
    EXPECT_FALSE(hit.fromBelow);
  }
  EXPECT_GT(hits, 800);
}

// On hills: the height at a hit is the ground's, and before it the ray is above.
TEST(Ellipsoid, RaysMeetHillsFirst) {
  const TemporaryFolder folder;
  Globe globe;
  globe.height = [](double lon, double lat) { return 3.0 * Bulges(4.0 * lon, 3.0 * lat); };
  const auto terrain = Earth(folder, globe);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const double lat = i % 8 == 0 ? 90.0 - std::abs(unit(random)) : 89.0 * unit(random);
    const Eigen::Vector3d from = terrain->MapToScene({180.0 * unit(random), lat, 16000.0});
    Eigen::Vector3d along(unit(random), unit(random), unit(random));
    along -= along.dot(terrain->Up(from)) * terrain->Up(from);
    along = (along.normalized() - 0.05 * (1.0 + unit(random)) * terrain->Up(from)).normalized();
    const RayHit hit = terrain->Intersect(from, along, 1e6);
    const double end = hit.hit ? hit.distance : 1e6;
    for (int k = 1; k < 400; ++k) {
      const Eigen::Vector3d p = from + along * (end * k / 400.0);
      const double above = terrain->SceneToMap(p).z() - terrain->Sample(p).height;
      EXPECT_GT(above, -1e-3) << "ray " << i << " at " << k;
    }
    if (hit.hit) {
      ++hits;
      EXPECT_NEAR(terrain->SceneToMap(hit.position_S).z(), terrain->Sample(hit.position_S).height,
                  1e-4);
    }
  }
  EXPECT_GT(hits, 50);
}

TEST(Ellipsoid, WhatIsOfAnotherBodyIsRejectedByName) {
  const TemporaryFolder folder;
  Globe globe;
  globe.height = [](double, double) { return 0.0; };
  const auto message = [&](const std::string& crs, const std::string& datum,
                           const std::string& given = "") {
    RasterFile file = globe.File();
    file.crs = crs;
    file.verticalDatum = datum;
    StreamedTerrainOptions options;
    options.onBody = true;
    if (!given.empty()) {
      options.elevation.crs = given;
    }
    try {
      StreamedTerrain::Open(file.Write(folder / "other.tif"), options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(message("EPSG:4326", "sphere:1737400").find("6378137 by 6356752.31"),
            std::string::npos);
  EXPECT_EQ(message("EPSG:4326", "ellipsoid"), "accepted");
  const std::string moon = message("+proj=longlat +R=1737400 +no_defs", "ellipsoid", "EPSG:4326");
  EXPECT_NE(moon.find("'WGS 84', is of an ellipsoid with a radius of 6378137"), std::string::npos)
      << moon;
  EXPECT_NE(moon.find("of a body of 1737400"), std::string::npos) << moon;
  EXPECT_EQ(message("+proj=longlat +a=3396190 +b=3376200 +no_defs", "ellipsoid"), "accepted");
}

} // namespace
