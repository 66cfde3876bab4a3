// Wheel tracks on bodies: ruts have their width and depth in metres everywhere.
#include <cmath>

#include <gtest/gtest.h>

#include <GeographicLib/Geodesic.hpp>

#include <dspace/Error.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Globe.h"

namespace {

using namespace dspace;
using dspace::testing::Degree;
using dspace::testing::Direction;
using dspace::testing::Globe;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

constexpr double Radius = 1737400.0;
constexpr double Sinkage = 0.1;
constexpr double Flat = 2.0; // [m] of the floor
constexpr double Wall = 0.5;

// Posts some centimetres apart, on a level sphere or ellipsoid.
std::shared_ptr<StreamedTerrain> Open(const TemporaryFolder& folder, double level = 0.0,
                                      bool ellipsoid = false) {
  Globe globe;
  globe.width = 96;
  globe.radius = ellipsoid ? 6378137.0 : Radius;
  globe.height = [level](double, double) { return level; };
  RasterFile file = globe.File();
  if (ellipsoid) {
    file.crs = "EPSG:4326";
    file.verticalDatum = "";
  }
  StreamedTerrainOptions options;
  options.onBody = true;
  options.subdivisions = ellipsoid ? 23 : 21; // 5 cm
  if (ellipsoid) {
    options.elevation.verticalDatum = VerticalDatum::FromText("ellipsoid");
  }
  return StreamedTerrain::Open(file.Write(folder / "globe.tif"), options);
}

// A place `east` and `north` metres from another on the sphere, along a great circle.
Eigen::Vector3d Moved(const Eigen::Vector3d& up, double east, double north, double radius) {
  const Eigen::Vector3d e = up.head<2>().norm() > 0.0
                                ? Eigen::Vector3d(Eigen::Vector3d::UnitZ().cross(up).normalized())
                                : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d n = up.cross(e);
  const double angle = std::hypot(east, north) / radius;
  if (angle == 0.0) {
    return up;
  }
  return std::cos(angle) * up + std::sin(angle) * (east * e + north * n).normalized();
}

Eigen::Vector2d Angles(const Eigen::Vector3d& up) {
  return {std::atan2(up.y(), up.x()) / Degree, std::atan2(up.z(), up.head<2>().norm()) / Degree};
}

TrackAddition Stroke(const std::string& name, std::vector<Eigen::Vector3d> ups) {
  TrackAddition stroke;
  stroke.name = name;
  stroke.profile.width = Flat;
  stroke.profile.wall = Wall;
  for (const Eigen::Vector3d& up : ups) {
    TrackContact contact;
    contact.place = Angles(up);
    contact.sinkage = Sinkage;
    stroke.contacts.push_back(contact);
  }
  return stroke;
}

double Closed(double aside) {
  return Sinkage * std::clamp(1.0 - (std::abs(aside) - 0.5 * Flat) / Wall, 0.0, 1.0);
}

struct Site {
  const char* name;
  double lon, lat;
};

class BodyTracks : public ::testing::TestWithParam<Site> {};

// Straight ruts in four directions from a place; the cross-section by heights and by rays.
TEST_P(BodyTracks, ARutIsAsWideAndDeepAsOnAPlane) {
  const TemporaryFolder folder;
  for (const double level : {0.0, 20000.0}) {
    const auto terrain = Open(folder, level);
    const double radius = Radius + level; // metres are those of the ground
    const Eigen::Vector3d up = Direction(GetParam().lon, GetParam().lat);
    // The chart is anchored some way off: its scale is not 1 here.
    const Eigen::Vector3d anchor = Moved(up, 0.4 * Radius, 0.3 * Radius, Radius);
    terrain->AddTracks({Stroke("anchor", {anchor})});
    for (const double azimuth : {0.0, 30.0, 90.0, 200.0}) {
      const double ae = std::sin(azimuth * Degree), an = std::cos(azimuth * Degree);
      const auto at = [&](double along, double aside) {
        return Moved(up, along * ae + aside * an, along * an - aside * ae, radius);
      };
      TrackAddition stroke = Stroke("wheel", {at(-8.0, 0.0), at(8.0, 0.0)});
      stroke.begin = true;
      terrain->AddTracks({stroke});
      for (double aside = -2.0; aside <= 2.0; aside += 0.1) {
        const Eigen::Vector3d above = (radius + 3.0) * at(1.3, aside);
        const double height = terrain->Sample(above).height;
        // Between posts 5 cm apart the bend of a wall's ends is cut: 0.2 times a quarter of its
        // diagonal.
        EXPECT_NEAR(level - height, Closed(aside), 0.006)
            << GetParam().name << " azimuth " << azimuth << " aside " << aside;
        const RayHit hit = terrain->Intersect(above, -above.normalized(), 100.0);
        ASSERT_TRUE(hit.hit);
        EXPECT_NEAR(hit.distance, 3.0 + level - height, 2e-3);
      }
      terrain->ClearTracks();
      EXPECT_EQ(terrain->Sample(radius * at(1.3, 0.0)).height, level);
      terrain->AddTracks({Stroke("anchor", {anchor})});
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sites, BodyTracks,
                         ::testing::Values(Site{"equator", 12.3, 0.0}, Site{"sixty", -77.0, 60.0},
                                           Site{"pole", 40.0, 89.9999},
                                           Site{"at the pole", 0.0, 90.0},
                                           Site{"south", 5.0, -89.5}, Site{"seam", 180.0, -20.0}),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           name.erase(std::remove(name.begin(), name.end(), ' '), name.end());
                           return name;
                         });

// GeographicLib's geodesics say where the rut's sides are.
TEST(BodyTracksOnEarth, RutsFollowGeodesicsOfTheEllipsoid) {
  const TemporaryFolder folder;
  const auto terrain = Open(folder, 0.0, true);
  const GeographicLib::Geodesic& earth = GeographicLib::Geodesic::WGS84();
  for (const double lat : {0.0, 60.0, -89.0}) {
    for (const double azimuth : {20.0, 110.0}) {
      const auto at = [&](double along, double aside) {
        double la = 0.0, lo = 0.0, a = 0.0;
        earth.Direct(lat, 170.0, azimuth, along, la, lo, a);
        earth.Direct(la, lo, a + 90.0, aside, la, lo);
        return Eigen::Vector2d(lo, la);
      };
      TrackAddition stroke = Stroke("wheel", {});
      for (const double along : {-5.0, 5.0}) {
        TrackContact contact;
        contact.place = at(along, 0.0);
        contact.sinkage = Sinkage;
        stroke.contacts.push_back(contact);
      }
      terrain->AddTracks({Stroke("anchor", {Direction(140.0, -10.0)})});
      terrain->AddTracks({stroke});
      for (double aside = -2.0; aside <= 2.0; aside += 0.2) {
        EXPECT_NEAR(-terrain->SampleMap(at(1.0, aside)).height, Closed(aside), 0.006)
            << lat << " " << azimuth << " " << aside;
      }
      EXPECT_NEAR(terrain->Tracks().Statistics().length, 10.0, 1e-3);
      terrain->ClearTracks();
    }
  }
}

TEST(BodyTracksKept, StrokesAndFilesRestoreTheSameGround) {
  const TemporaryFolder folder;
  const auto one = Open(folder);
  const auto two = Open(folder);
  const auto three = Open(folder);
  std::vector<Eigen::Vector3d> path;
  const Eigen::Vector3d up = Direction(179.9999, 70.0);
  for (int i = 0; i < 80; ++i) { // over the date line
    path.push_back(Moved(up, 0.2 * i, 2.0 * std::sin(0.1 * i), Radius));
  }
  TrackAddition stroke = Stroke("wheel", path);
  stroke.profile.treadPitch = 0.8;
  stroke.profile.treadDepth = 0.05;
  for (std::size_t i = 0; i < stroke.contacts.size(); ++i) {
    stroke.contacts[i].heading = 0.1;
  }
  one->AddTracks({stroke});
  EXPECT_THROW(two->RestoreTracks(one->Tracks().Strokes()), Error);
  two->RestoreTracks(one->Tracks().Strokes(), false, one->TracksAnchor());
  one->SaveTracks(folder / "tracks.geojson");
  three->LoadTracks(folder / "tracks.geojson");
  int deep = 0;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d p = Radius * Moved(up, 0.04 * i, 1.7 * std::sin(0.02 * i), Radius);
    const double height = one->Sample(p).height;
    deep += height < -0.09 ? 1 : 0;
    EXPECT_EQ(two->Sample(p).height, height);
    EXPECT_NEAR(three->Sample(p).height, height, 1e-5);
  }
  EXPECT_GT(deep, 200);
}

TEST(BodyTracksKept, WhatIsOutOfReachIsRejectedByName) {
  const TemporaryFolder folder;
  const auto terrain = Open(folder);
  terrain->AddTracks({Stroke("wheel", {Direction(0.0, 0.0)})});
  const std::size_t bytes = terrain->Tracks().Statistics().bytes;
  for (const double lon : {130.0, 180.0}) {
    try {
      terrain->AddTracks({Stroke("other", {Direction(lon, 0.0)})});
      FAIL();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("up to 120"), std::string::npos) << error.what();
    }
  }
  TrackAddition none = Stroke("none", {});
  none.contacts.resize(1);
  none.contacts[0].place = {0.0, std::nan("")};
  EXPECT_THROW(terrain->AddTracks({none}), Error);
  EXPECT_EQ(terrain->Tracks().Statistics().bytes, bytes);
}

} // namespace
