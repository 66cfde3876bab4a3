// Horizons against closed forms and against every triangle.
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "Globe.h"
#include "Grids.h"

#include <dspace/measure/HorizonScan.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace::testing {
namespace {

using V = Eigen::Vector3d;

// A wall of 1,000 m that goes around the north pole of a sphere of 6,371 km, at an arc of
// `arc` metres, and level ground within and behind it.
class RingWall {
public:
  explicit RingWall(double arc) {
    const double row_deg = arc / Radius / Degree; // colatitude of the wall's posts
    RasterFile file;
    file.width = 360;
    file.height = 4;
    file.crs = "+proj=longlat +R=6371000 +no_defs";
    file.verticalDatum = "sphere";
    // Rows at half, one and a half, ... steps from the pole: the second one is the wall.
    this->Step_ = row_deg / 1.5;
    file.geotransform = std::array<double, 6>{-180, 1, 0, 90, 0, -this->Step_};
    file.value = [](int, int row, int) { return row == 1 ? 1000.0 : 0.0; };
    const std::string path = file.Write((this->Folder_.Path() / "ring.tif").string());
    StreamedTerrainOptions options;
    options.onBody = true;
    this->Terrain_ = StreamedTerrain::Open(path, options);
  }
  std::vector<HorizonPoint> Scan(std::size_t count) const {
    Obstacles obstacles;
    obstacles.Add(Obstacles::Ground{"ring", this->Terrain_, {}});
    const V pole(0.0, 0.0, Radius);
    const V up = this->Terrain_->Up(pole);
    const V north = this->Terrain_->North(pole);
    return ScanHorizon(obstacles, pole, {north.cross(up), north, up}, count, "place");
  }
  static constexpr double Radius = 6371000.0;

private:
  TemporaryFolder Folder_;
  double Step_ = 0.0;
  std::shared_ptr<StreamedTerrain> Terrain_;
};

TEST(HorizonScan, ARingWallOnASphereIsAtTheElevationOfItsGeometry) {
  // The crest is 5,000.04 m from the axis: (R + 1000) sin(angle).
  const double angle = std::asin(5000.04 / (RingWall::Radius + 1000.0));
  const RingWall byTangent(angle * RingWall::Radius);
  for (const HorizonPoint& point : byTangent.Scan(36)) {
    // The crest at azimuths between posts of a row is a circle of latitude.
    EXPECT_NEAR(point.elevation_deg * Degree, 0.197017, 1e-6);
    EXPECT_NEAR(point.distance, std::hypot(5000.04, 1000.0 - 5000.04 * 5000.04 / 2 / 6371e3), 0.02);
  }
  const RingWall byArc(5000.0);
  for (const HorizonPoint& point : byArc.Scan(36)) {
    EXPECT_NEAR(point.elevation_deg * Degree, 0.196988, 1e-6);
  }
}

TEST(HorizonScan, ASmoothSphereDipsByItsTangent) {
  Globe globe;
  globe.height = [](double, double) { return 0.0; };
  TemporaryFolder folder;
  StreamedTerrainOptions options;
  options.onBody = true;
  const auto terrain =
      StreamedTerrain::Open(globe.File().Write((folder.Path() / "globe.tif").string()), options);
  Obstacles obstacles;
  obstacles.Add(Obstacles::Ground{"globe", terrain, {}});
  for (const double height : {2.0, 100.0, 50000.0}) {
    const V place = (globe.radius + height) * Direction(37.0, 20.0);
    const V up = terrain->Up(place);
    const V north = terrain->North(place);
    const double dip = std::acos(globe.radius / (globe.radius + height)) / Degree;
    // A millimetre of a chord changes a dip of 2 m by half as much as it changes the height.
    const double bound = dip * 0.5 * 1e-3 / height + 2e-6;
    for (const HorizonPoint& p :
         ScanHorizon(obstacles, place, {north.cross(up), north, up}, 16, "p"))
      EXPECT_NEAR(p.elevation_deg, -dip, bound) << height;
  }
}

// The greatest elevation of points on the edges of all triangles in an azimuth.
double HighestByHand(const GridTerrain& ground, const V& place, double azimuth) {
  double best = -90.0;
  const V level(std::sin(azimuth), std::cos(azimuth), 0.0);
  for (double out = 0.01; out < 90.0; out += 0.0005) {
    const SurfaceSample sample = ground.Sample(place + out * level);
    if (sample.valid) {
      best = std::max(best, std::atan2(sample.position_S.z() - place.z(), out) / Degree);
    }
  }
  return best;
}

TEST(HorizonScan, RoughGroundAgreesWithItsProfiles) {
  const auto ground = Rough(80, 60, 11);
  Obstacles obstacles;
  obstacles.Add(Obstacles::Ground{"rough", ground, {}});
  V place = ground->MapToScene({1027.3, 1978.1, 0.0});
  place.z() = ground->Sample(place).position_S.z() + 0.8;
  const auto horizon = ScanHorizon(obstacles, place, {}, 24, "place");
  for (std::size_t k = 0; k < 24; ++k) {
    const double azimuth = 2.0 * M_PI * double(k) / 24.0;
    EXPECT_NEAR(horizon[k].elevation_deg, HighestByHand(*ground, place, azimuth), 1e-2) << k;
    EXPECT_EQ(horizon[k].object, 0u);
    // The point lies in the azimuth, on the ground, in the direction that is stated.
    const V to = horizon[k].point - place;
    EXPECT_NEAR(std::remainder(std::atan2(to.x(), to.y()) - azimuth, 2.0 * M_PI), 0.0, 1e-9) << k;
    EXPECT_NEAR(std::asin(to.z() / to.norm()) / Degree, horizon[k].elevation_deg, 1e-9) << k;
    EXPECT_NEAR(to.norm(), horizon[k].distance, 1e-9) << k;
    EXPECT_NEAR(ground->Sample(horizon[k].point).position_S.z(), horizon[k].point.z(), 1e-6) << k;
  }
}

TEST(HorizonScan, OutsideTheDataTheGroundIsFoundAndWhereThereIsNoneNothing) {
  const auto ground =
      Sampled(101, 101, NorthUp(-0.5, 100.5, 1.0), [](const Eigen::Vector2d&) { return 20.0; });
  Obstacles obstacles;
  obstacles.Add(Obstacles::Ground{"flat", ground, {}});
  const V place = ground->MapToScene({-100.0, 50.0, 70.0}); // west of the data
  const auto horizon = ScanHorizon(obstacles, place, {}, 4, "place");
  EXPECT_NEAR(horizon[1].elevation_deg, -std::atan2(50.0, 200.0) / Degree, 1e-5); // the far edge
  EXPECT_EQ(horizon[3].elevation_deg, -90.0);
  EXPECT_TRUE(std::isinf(horizon[3].distance));
  EXPECT_TRUE(std::isnan(horizon[3].point.x()));
}

// Rays to random triangles, one elevation after the other.
TEST(HorizonScan, TrianglesAgreeWithRays) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  auto mesh = std::make_shared<Mesh>();
  for (int t = 0; t < 60; ++t) {
    const V center(6.0 * unit(random), 6.0 * unit(random), 2.0 * unit(random));
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        mesh->positions.push_back(float(center[axis] + unit(random)));
      }
      mesh->indices.push_back(std::uint32_t(mesh->indices.size()));
    }
  }
  const auto rays = std::make_shared<MeshRays>(mesh);
  Obstacles obstacles;
  obstacles.Add(3, rays, Eigen::Affine3d::Identity());
  const V place(0.1, -0.2, 0.3);
  constexpr int Count = 90;
  const auto horizon = ScanHorizon(obstacles, place, {}, Count, "place");
  int found = 0;
  for (int k = 0; k < Count; ++k) {
    const double azimuth = 2.0 * M_PI * k / Count;
    const auto meets = [&](double elevation) {
      const V direction(std::cos(elevation * Degree) * std::sin(azimuth),
                        std::cos(elevation * Degree) * std::cos(azimuth),
                        std::sin(elevation * Degree));
      return std::isfinite(rays->Intersect(place, direction, 0.0, 1e9));
    };
    if (horizon[k].object == 0) {
      continue;
    }
    ++found;
    EXPECT_EQ(horizon[k].object, 3u);
    EXPECT_TRUE(meets(horizon[k].elevation_deg - 1e-6)) << k;
    for (double above = horizon[k].elevation_deg + 1e-6; above < 90.0; above += 0.05) {
      EXPECT_FALSE(meets(above)) << k << " at " << above;
    }
  }
  EXPECT_GT(found, 60);
}

TEST(HorizonScan, ARoofOverThePlaceIsAtTheZenith) {
  auto mesh = std::make_shared<Mesh>();
  mesh->positions = {-1, -1, 2, 1, -1, 2, 0, 1, 2};
  mesh->indices = {0, 1, 2};
  Obstacles obstacles;
  obstacles.Add(8, std::make_shared<MeshRays>(mesh), Eigen::Affine3d::Identity());
  for (const HorizonPoint& p : ScanHorizon(obstacles, V::Zero(), {}, 7, "place")) {
    EXPECT_NEAR(p.elevation_deg, 90.0, 1e-9);
    EXPECT_NEAR(p.distance, 2.0, 1e-12);
  }
}

} // namespace
} // namespace dspace::testing
