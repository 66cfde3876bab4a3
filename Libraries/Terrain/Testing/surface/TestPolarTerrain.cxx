// Rasters in the stereographic plane of a pole: places, bounds and rays in closed form.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/rays/RayPath.h>
#include <dspace/surface/StreamedTerrain.h>

#include "RasterFile.h"

namespace {

using namespace dspace;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

constexpr double Degree = M_PI / 180.0;
constexpr double Moon = 1737400.0;

// The map of Snyder 1987, p. 157, on a sphere: x and y [m] of longitude and latitude [rad].
Eigen::Vector2d SnyderMap(bool south, double lon0, double k, double lon, double lat) {
  const double rho = 2.0 * Moon * k * std::tan(0.25 * M_PI - (south ? -0.5 : 0.5) * lat);
  return {rho * std::sin(lon - lon0), (south ? rho : -rho) * std::cos(lon - lon0)};
}

Eigen::Vector3d UpOf(double lon, double lat) {
  return {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
}

struct Place {
  bool south;
  double lon0_deg;
  double scale;
  Eigen::Vector2d middle; // of the raster [m]
};

const std::vector<Place> Places = {{true, 0.0, 1.0, {0.0, 0.0}},
                                   {false, 0.0, 1.0, {0.0, 0.0}},
                                   {true, 37.0, 0.97, {20000.0, -30000.0}},
                                   {false, -120.0, 0.97, {1500000.0, -1300000.0}}};

std::shared_ptr<StreamedTerrain> OpenRaster(const TemporaryFolder& folder, const Place& place,
                                            double pixel, double height = 0.0) {
  RasterFile file;
  file.width = 64;
  file.height = 64;
  file.crs = "+proj=stere +lat_0=" + std::string(place.south ? "-90" : "90") +
             " +lon_0=" + std::to_string(place.lon0_deg) + " +k=" + std::to_string(place.scale) +
             " +R=" + std::to_string(Moon) + " +no_defs";
  file.verticalDatum = "sphere";
  file.geotransform = std::array<double, 6>{place.middle.x() - 32 * pixel, pixel, 0,
                                            place.middle.y() + 32 * pixel, 0,     -pixel};
  file.value = [height](int, int, int) { return height; };
  StreamedTerrainOptions options;
  options.onBody = true;
  return StreamedTerrain::Open(file.Write(folder / "polar.tif"), options);
}

TEST(PolarTerrain, PlacesAreThoseOfTheProjection) {
  const TemporaryFolder folder;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const Place& place : Places) {
    const auto terrain = OpenRaster(folder, place, 2000.0);
    const PostPlacement& placement = terrain->Placement();
    EXPECT_EQ(placement.South(), place.south);
    for (int i = 0; i < 200; ++i) {
      const double lon = (2.0 * unit(random) - 1.0) * M_PI;
      const double lat = (place.south ? -1.0 : 1.0) * (90.0 - 120.0 * unit(random)) * Degree;
      const double height = 5000.0 * unit(random);
      const Eigen::Vector2d map =
          SnyderMap(place.south, place.lon0_deg * Degree, place.scale, lon, lat);
      const Eigen::Vector3d p_S = (Moon + height) * UpOf(lon, lat);
      const Eigen::Vector3d found = terrain->MapToScene({map.x(), map.y(), height});
      EXPECT_LT((found - p_S).norm(), 1e-6);
      const Eigen::Vector3d back = terrain->SceneToMap(p_S);
      EXPECT_LT((back - Eigen::Vector3d(map.x(), map.y(), height)).norm(),
                1e-6 * (1.0 + map.norm() / Moon));
      const Eigen::Vector2d post = terrain->MapToPost(map);
      EXPECT_LT((placement.PostAt({lon, lat}) - post).norm(), 1e-9 * (1.0 + post.norm()));
      const Eigen::Vector2d angles = placement.Angles(post);
      EXPECT_NEAR(std::remainder(angles.x() - lon, 2.0 * M_PI) * std::cos(lat), 0.0, 1e-12);
      EXPECT_NEAR(angles.y(), lat, 1e-12);
    }
  }
}

TEST(PolarTerrain, BoundsAreThoseOfItsGround) {
  const TemporaryFolder folder;
  for (const Place& place : Places) {
    for (const double pixel : {500.0, 30000.0}) { // 16 and 960 km to each side
      const auto terrain = OpenRaster(folder, place, pixel, 700.0);
      const PostPlacement& placement = terrain->Placement();
      const PostLattice& lattice = terrain->Pyramid()->Lattice();
      Eigen::AlignedBox3d sampled;
      constexpr int Steps = 400;
      for (int j = 0; j <= Steps; ++j) {
        for (int i = 0; i <= Steps; ++i) {
          sampled.extend(placement.ToScene(
              {double(lattice.columns - 1) * i / Steps, double(lattice.rows - 1) * j / Steps},
              700.0));
        }
      }
      const Eigen::AlignedBox3d box = terrain->GetBounds().scene;
      const double close = 64.0 * pixel / Steps; // places of the sample
      EXPECT_TRUE(((sampled.min() - box.min()).array() > -1e-6).all());
      EXPECT_TRUE(((box.max() - sampled.max()).array() > -1e-6).all());
      EXPECT_LT((sampled.min() - box.min()).maxCoeff(), 0.1 * close);
      EXPECT_LT((box.max() - sampled.max()).maxCoeff(), 0.1 * close);
    }
  }
}

TEST(PolarTerrain, RaysMeetASphereWhereTheyShould) {
  const TemporaryFolder folder;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const Place& place : Places) {
    const double pixel = 4000.0, height = 1234.0;
    const auto terrain = OpenRaster(folder, place, pixel, height);
    int hits = 0;
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector2d from =
          place.middle + 45.0 * pixel * Eigen::Vector2d(unit(random), unit(random));
      const Eigen::Vector2d to =
          place.middle + 30.0 * pixel * Eigen::Vector2d(unit(random), unit(random));
      const double above = 200000.0 * std::pow(10.0, -3.0 + 3.0 * std::abs(unit(random)));
      const Eigen::Vector3d origin = terrain->MapToScene({from.x(), from.y(), height + above});
      const Eigen::Vector3d end = terrain->MapToScene({to.x(), to.y(), height});
      const Eigen::Vector3d way = (end - origin).normalized();
      // The nearer root of |origin + t way| = radius; the farther one where the ground before it is
      // not on the raster.
      const double b = origin.dot(way);
      const double radius = Moon + height;
      const double root = std::sqrt(b * b - (origin.squaredNorm() - radius * radius));
      double expected = std::numeric_limits<double>::infinity();
      for (const double t : {-b - root, -b + root}) {
        const Eigen::Vector2d map = terrain->SceneToMap(origin + t * way).head<2>();
        const double out = (map - place.middle).cwiseAbs().maxCoeff();
        if (t > 0.0 && out < 31.5 * pixel) {
          expected = std::min(expected, t);
        }
      }
      const RayHit hit = terrain->Intersect(origin, way);
      ASSERT_EQ(hit.hit, std::isfinite(expected)) << i;
      if (hit.hit) {
        ++hits;
        ASSERT_NEAR(hit.distance, expected, 1e-6 + 1e-9 * expected);
        ASSERT_LT((hit.normal_S - hit.position_S.normalized()).norm(), 1e-9);
      }
    }
    EXPECT_GT(hits, 100);
  }
}

std::vector<double> Crossings(const RayPath& path, int axis, double line) {
  std::vector<double> t;
  if (axis == 0) {
    path.ColumnCrossings(line, t);
  } else {
    path.RowCrossings(line, t);
  }
  return t;
}

// A place over the lattice's middle, up to `reach` posts aside.
Eigen::Vector3d PlaceOver(const PostPlacement& placement, double reach, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double c = 1000.0 + reach * unit(random);
  const double r = 1000.0 + reach * unit(random);
  return placement.ToScene({c, r}, 2000.0 * unit(random));
}

// A fine march finds no crossing of a line that the path does not state, and states it within a
// micrometre.
TEST(PolarTerrain, RaysCrossTheLinesOfTheLatticeWhereTheyShould) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  PostLattice lattice;
  lattice.columns = lattice.rows = 2001;
  int found = 0;
  for (const bool south : {false, true}) {
    for (const Eigen::Vector2d& pole :
         {Eigen::Vector2d(1000.0, 1000.0), Eigen::Vector2d(990.3, 1020.6),
          Eigen::Vector2d(-4000.0, 300.0)}) {
      const PostPlacement placement =
          PostPlacement::AtPole(south, 0.5 * 100.0 / Moon, pole, 33.0, BodyEllipsoid(Moon, Moon));
      for (int i = 0; i < 100; ++i) {
        const Eigen::Vector3d origin = PlaceOver(placement, 1000.0, random);
        const Eigen::Vector3d way = (PlaceOver(placement, 1000.0, random) - origin).normalized();
        const RayPath path(placement, lattice, origin, way, 150000.0, -3000.0, 3000.0);
        if (path.First() > path.Last()) {
          continue;
        }
        for (int k = 0; k < 20; ++k) {
          const int axis = k % 2;
          const double line = std::round(1000.0 + (k < 10 ? 5.0 : 1000.0) * unit(random));
          const std::vector<double> crossings = Crossings(path, axis, line);
          ASSERT_LE(crossings.size(), 2u);
          const auto off = [&](double t) { return path.Post(t, 0.0)[axis] - line; };
          for (const double t : crossings) {
            ASSERT_LT(std::abs(off(t)), 1e-8); // posts of 100 m
          }
          constexpr int Steps = 200;
          for (int s = 0; s < Steps; ++s) {
            const double t0 = path.First() + (path.Last() - path.First()) * s / Steps;
            const double t1 = path.First() + (path.Last() - path.First()) * (s + 1) / Steps;
            if ((off(t0) < 0.0) != (off(t1) < 0.0)) {
              ++found;
              ASSERT_TRUE(std::any_of(crossings.begin(), crossings.end(),
                                      [&](double t) { return t >= t0 - 1e-6 && t <= t1 + 1e-6; }));
            }
          }
        }
      }
    }
  }
  EXPECT_GT(found, 2000);
}

// A line of the lattice that passes the pole by less than rounding, as pixels of a third of a metre
// make it, is the line through the pole.
TEST(PolarTerrain, RaysCrossLinesThatNearlyMeetThePole) {
  std::mt19937 random(6);
  PostLattice lattice;
  lattice.columns = lattice.rows = 2001;
  int found = 0;
  for (const double off : {0.0, 1e-16, 1e-13, -1e-12, 1e-9, -1e-6, 1e-3}) {
    const PostPlacement placement = PostPlacement::AtPole(
        true, 0.5 * 100.0 / Moon, {1000.0 + off, 1000.0 - off}, 10.0, BodyEllipsoid(Moon, Moon));
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3d origin = PlaceOver(placement, 900.0, random);
      const Eigen::Vector3d end = PlaceOver(placement, 900.0, random);
      const RayPath path(placement, lattice, origin, (end - origin).normalized(),
                         (end - origin).norm(), -3000.0, 3000.0);
      for (const int axis : {0, 1}) {
        const std::vector<double> crossings = Crossings(path, axis, 1000.0);
        const auto beyond = [&](double t) { return path.Post(t, 0.0)[axis] > 1000.0; };
        if (beyond(path.First()) != beyond(path.Last())) {
          ++found;
          ASSERT_TRUE(std::any_of(crossings.begin(), crossings.end(),
                                  [&](double t) {
                                    return t > path.First() && t < path.Last() &&
                                           std::abs(path.Post(t, 0.0)[axis] - 1000.0) < 1e-8;
                                  }))
              << off << " " << i;
        }
      }
    }
  }
  EXPECT_GT(found, 2000);
}

TEST(PolarTerrain, RaysStraightDownMeetTheGroundBelow) {
  const TemporaryFolder folder;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const Place& place : Places) {
    for (const double pixel : {1000.0 / 3.0, 463.0836}) {
      const double height = 700.0;
      const auto terrain = OpenRaster(folder, place, pixel, height);
      for (int i = 0; i < 2000; ++i) {
        Eigen::Vector2d map = 31.0 * pixel * Eigen::Vector2d(unit(random), unit(random));
        if (i % 4 == 0) {
          map[i / 4 % 2] = i % 8 == 0 ? 0.0 : 1e-9 * unit(random); // along the pole's lines
        }
        map += place.middle;
        const Eigen::Vector3d origin = terrain->MapToScene({map.x(), map.y(), 20000.0});
        Eigen::Vector3d way = -origin.normalized();
        if (i % 3 == 0) {
          way =
              (way + 1e-9 * Eigen::Vector3d(unit(random), unit(random), unit(random))).normalized();
        }
        const RayHit hit = terrain->Intersect(origin, way); // as far as it goes
        ASSERT_TRUE(hit.hit) << i;
        ASSERT_NEAR(hit.distance, 20000.0 - height, 1e-5) << i;
      }
    }
  }
}

TEST(PolarTerrain, RaysOnAChartOfAnEllipsoidAreRejected) {
  const PostPlacement placement =
      PostPlacement::OnPole(true, 100.0, 512.0, BodyEllipsoid(6378137.0, 6356752.3));
  EXPECT_THROW(RayPath(placement, PostLattice{}, Eigen::Vector3d(0.0, 0.0, -7e6),
                       Eigen::Vector3d::UnitZ(), 1e7, 0.0, 100.0),
               Error);
}

} // namespace
