// Streamed terrains on a body: against closed forms, their surface by hand.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Globe.h"

namespace {

using namespace dspace;
using dspace::testing::Bulges;
using dspace::testing::ByHand;
using dspace::testing::Degree;
using dspace::testing::Direction;
using dspace::testing::Globe;
using dspace::testing::TemporaryFolder;

StreamedTerrainOptions GlobeOnBody() {
  StreamedTerrainOptions options;
  options.onBody = true;
  return options;
}

TEST(StreamedGlobe, OnABodyHeightsAreThoseByHand) {
  const TemporaryFolder folder;
  for (const auto& [west, direction] : {std::pair(-180.0, 1), {0.0, 1}, {180.0, -1}}) {
    Globe globe;
    globe.west_deg = west;
    globe.direction = direction;
    globe.height = Bulges;
    const auto terrain =
        StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), GlobeOnBody());
    EXPECT_TRUE(terrain->HeightRangeIsExact());
    EXPECT_GE(terrain->Subdivisions(), 1);
    // Flat cells stay within a millimetre of the sphere.
    const double cell = terrain->Placement().CellSize({0.0, double(1 << 20)});
    EXPECT_LE(cell * cell / (4.0 * globe.radius), 1e-3);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    constexpr int Count = 4000;
    Rows3 points(Count, 3);
    Eigen::VectorXd heights(Count);
    std::vector<double> expected;
    for (int i = 0; i < Count; ++i) {
      const double lon = 180.0 * unit(random);
      // A quarter of them between the last row of pixels and a pole.
      const double lat = i % 4 == 0 ? 90.0 - 2.5 * std::abs(unit(random)) : 90.0 * unit(random);
      const double side = i % 8 == 0 ? -1.0 : 1.0;
      points.row(i) = (2e6 + 1e6 * unit(random)) * Direction(lon, side * lat);
      expected.push_back(ByHand(globe, lon, side * lat));
    }
    terrain->Heights(points, heights);
    for (int i = 0; i < Count; ++i) {
      ASSERT_NEAR(heights[i], expected[i], 2e-3) << west << " at " << points.row(i);
      const SurfaceSample sample = terrain->Sample(points.row(i));
      EXPECT_EQ(sample.height, heights[i]);
      EXPECT_NEAR(sample.position_S.norm(), globe.radius + heights[i], 1e-6);
      EXPECT_NEAR(sample.normal_S.norm(), 1.0, 1e-12);
    }
  }
}

// On a sphere of one height a ray's distance is the closed form's.
TEST(StreamedGlobe, RaysMeetASphereWhereTheClosedFormDoes) {
  const TemporaryFolder folder;
  Globe globe;
  globe.height = [](double, double) { return 1200.0; };
  const auto terrain =
      StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), GlobeOnBody());
  const double radius = globe.radius + 1200.0;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d from =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized() * radius *
        (1.0 + (i % 3 == 0 ? 1e-6 : 0.3) * (0.01 + i % 10));
    Eigen::Vector3d to =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized() * radius;
    if (i % 7 == 0) {
      to = Eigen::Vector3d(0, 0, i % 2 == 0 ? radius : -radius); // at a pole
    } else if (i % 11 == 0) {
      to = 0.3 * from; // straight down
    } else if (i % 3 == 0) {
      to = from + 3e4 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    }
    const Eigen::Vector3d d = (to - from).normalized();
    const double b = from.dot(d);
    const double root = b * b - (from.squaredNorm() - radius * radius);
    const bool expected = root >= 0.0 && b < 0.0;
    const RayHit hit = terrain->Intersect(from, d);
    if (std::abs(root) < 1e4) {
      continue; // within a tenth of a millimetre of passing by
    }
    ASSERT_EQ(hit.hit, expected) << i << ": " << from.transpose() << " to " << to.transpose();
    if (expected) {
      ++hits;
      EXPECT_NEAR(hit.distance, -b - std::sqrt(root), 1e-6 / std::abs(d.dot(hit.normal_S)));
      EXPECT_FALSE(hit.fromBelow);
      EXPECT_LT((hit.normal_S - hit.position_S.normalized()).norm(), 1e-9);
    }
  }
  EXPECT_GT(hits, 2000);
}

// Chords of some metres: no deeper than a flat cell's own departure from the sphere. One high place
// far away keeps the range of heights from telling.
TEST(StreamedGlobe, RaysThatTouchASphereAreSeenTo) {
  const TemporaryFolder folder;
  Globe globe;
  globe.height = [](double lon, double lat) {
    return lon < -170.0 && lat < -80.0 ? 9000.0 : 1200.0;
  };
  const auto terrain =
      StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), GlobeOnBody());
  const double radius = globe.radius + 1200.0;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d up = Direction(170.0 * unit(random), 150.0 * unit(random) - 60.0);
    const Eigen::Vector3d along =
        (Direction(360.0 * unit(random), 60.0) - 0.2 * up).cross(up).normalized();
    const double half = 2.0 + 40.0 * unit(random); // of the chord
    const double out = 3000.0 * unit(random);
    const double nearest = std::sqrt((radius - half) * (radius + half));
    const RayHit hit = terrain->Intersect(nearest * up - (half + out) * along, along);
    ASSERT_TRUE(hit.hit) << i << ": " << half;
    EXPECT_NEAR(hit.distance, out, 1e-8 * radius / half) << half;
    EXPECT_FALSE(terrain->Intersect((radius + 1e-3) * up - out * along, along, 5e3).hit);
  }
}

// Over a pole, where longitude turns by half a turn at once, and along meridians and parallels.
TEST(StreamedGlobe, RaysAlongAndAcrossTheLinesOfTheGridMeetTheGround) {
  const TemporaryFolder folder;
  Globe globe;
  globe.height = Bulges;
  const auto terrain =
      StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), GlobeOnBody());
  const auto ground = [&](double lon, double lat) {
    return terrain->Sample(Direction(lon, lat)).position_S;
  };
  const double post = globe.Step() / std::ldexp(1.0, terrain->Subdivisions());
  std::mt19937 random(4);
  std::uniform_int_distribution<int> any(0, 9999);
  for (int i = 0; i < 3000; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const double lon = (any(random) - 5000) * 2.0 * post;
    const double lat = i % 3 == 0 ? side * (90.0 - 20.0 * post) : (any(random) - 5000) * post;
    const Eigen::Vector3d to = ground(lon, lat);
    Eigen::Vector3d from = to;
    if (i % 3 == 0) { // from beyond the pole, over it
      from = ground(lon + 180.0, side * (90.0 - 50.0 * post)) * 1.001;
    } else if (i % 3 == 1) { // along the meridian
      from = ground(lon, lat - 3.0) * 1.03;
    } else { // down
      from = 1.5 * to;
    }
    const RayHit hit = terrain->Intersect(from, to - from);
    ASSERT_TRUE(hit.hit) << i << ": " << lon << ", " << lat;
    EXPECT_LT(hit.distance, (to - from).norm() + 1e-3) << i << ": " << lon << ", " << lat;
    if (i % 3 == 2) {
      EXPECT_NEAR(hit.distance, (to - from).norm(), 1e-6) << i;
    }
    EXPECT_NEAR(terrain->Sample(hit.position_S).position_S.norm(), hit.position_S.norm(), 2e-6);
  }
}

// The first crossing that small steps along the ray find, by heights made by hand.
TEST(StreamedGlobe, RaysMeetABodysGroundWhereStepsDo) {
  const TemporaryFolder folder;
  for (const int direction : {1, -1}) {
    Globe globe;
    globe.width = 48;
    globe.radius = 20000.0; // a small body: its ground's shape matters
    globe.direction = direction;
    globe.height = [](double lon, double lat) {
      return 0.3 * Bulges(lon, lat) +
             150.0 * std::sin(lon * Degree * 11.0) * std::cos(lat * Degree);
    };
    const auto terrain =
        StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), GlobeOnBody());
    const auto above = [&](const Eigen::Vector3d& p) {
      const double lat = std::atan2(p.z(), p.head<2>().norm()) / Degree;
      return p.norm() - globe.radius - ByHand(globe, std::atan2(p.y(), p.x()) / Degree, lat);
    };
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    int hits = 0;
    int fromBelow = 0;
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector3d at(normal(random), normal(random), normal(random));
      Eigen::Vector3d from = at.normalized() * (i % 4 == 0   ? 17000.0
                                                : i % 4 == 1 ? 21500.0
                                                             : 60000.0);
      Eigen::Vector3d to =
          15000.0 * Eigen::Vector3d(normal(random), normal(random), normal(random));
      if (i % 9 == 0) {
        to = Eigen::Vector3d(0, 0, i % 2 == 0 ? 18000.0 : -18000.0);
        from = i % 18 == 0 ? Eigen::Vector3d(30000.0, 0.0, to.z()) : from;
      }
      const Eigen::Vector3d d = (to - from).normalized();
      const RayHit hit = terrain->Intersect(from, d, 1.2e5);
      double before = above(from);
      double found = -1.0;
      for (double t = 5.0; t < 1.2e5 && found < 0.0; t += 5.0) {
        const double now = above(from + t * d);
        if ((now > 0.0) != (before > 0.0)) {
          double a = t - 5.0;
          double b = t;
          while (b - a > 1e-9 * b) {
            const double m = 0.5 * (a + b);
            ((above(from + m * d) > 0.0) == (before > 0.0) ? a : b) = m;
          }
          found = 0.5 * (a + b);
        }
        before = now;
      }
      // Steps may pass over a crest's tip; floats of posts are within a quarter of a millimetre.
      if (hit.hit && (found < 0.0 || hit.distance < found - 1.0)) {
        EXPECT_NEAR(above(from + hit.distance * d), 0.0, 1e-3) << i;
        continue;
      }
      ASSERT_EQ(hit.hit, found >= 0.0) << i;
      if (hit.hit) {
        ++hits;
        fromBelow += hit.fromBelow;
        const double steep = std::max(1e-3, std::abs(hit.normal_S.dot(d)));
        EXPECT_NEAR(hit.distance, found, 1e-3 / steep) << i;
        EXPECT_NEAR(terrain->Sample(hit.position_S).position_S.norm(), hit.position_S.norm(), 2e-6);
      }
    }
    EXPECT_GT(hits, 150);
    EXPECT_GT(fromBelow, 20);
  }
}

// The normal against differences of the surface's own places, made by hand.
TEST(StreamedGlobe, NormalsAreThoseOfTheCurvedSurface) {
  const TemporaryFolder folder;
  Globe globe;
  globe.radius = 30000.0;
  globe.height = Bulges;
  const auto terrain =
      StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), GlobeOnBody());
  const auto place = [&](double lon, double lat) {
    return Eigen::Vector3d((globe.radius + ByHand(globe, lon, lat)) * Direction(lon, lat));
  };
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int compared = 0;
  for (int i = 0; i < 3000; ++i) {
    const double lon = 180.0 * unit(random);
    const double lat =
        89.9 * (i % 3 == 0 ? std::copysign(1.0 - 0.02 * unit(random) * unit(random), unit(random))
                           : unit(random));
    if (std::abs(lat) > 89.8) {
      continue;
    }
    const double h = 1e-4; // degrees
    const Eigen::Vector3d east = place(lon + h, lat) - place(lon - h, lat);
    const Eigen::Vector3d north = place(lon, lat + h) - place(lon, lat - h);
    // Across an edge of triangles a difference is neither's.
    const Eigen::Vector3d here = place(lon, lat);
    const Eigen::Vector3d bends = place(lon + h, lat) + place(lon - h, lat) - 2.0 * here;
    const Eigen::Vector3d bendsNorth = place(lon, lat + h) + place(lon, lat - h) - 2.0 * here;
    if (bends.norm() > 1e-5 * east.norm() || bendsNorth.norm() > 1e-5 * north.norm()) {
      continue;
    }
    ++compared;
    const Eigen::Vector3d normal = east.cross(north).normalized();
    const SurfaceSample sample = terrain->Sample(3.0 * here);
    EXPECT_LT((sample.normal_S - normal).norm(), 2e-5) << lon << ", " << lat;
    EXPECT_NEAR(sample.slope_deg,
                std::acos(std::min(1.0, normal.dot(Direction(lon, lat)))) / Degree, 2e-3);
    EXPECT_LT((sample.position_S - here).norm(), 1e-2);
    // Downhill, from north to the east.
    Eigen::VectorXd aspect(1);
    terrain->Aspects(Rows3(here.transpose()), aspect);
    const double toEast =
        -(here.norm() > 0.0 ? place(lon + h, lat).norm() - place(lon - h, lat).norm() : 0.0) /
        std::cos(lat * Degree);
    const double toNorth = -(place(lon, lat + h).norm() - place(lon, lat - h).norm());
    EXPECT_NEAR(std::remainder(aspect[0] - std::atan2(toEast, toNorth) / Degree, 360.0), 0.0, 0.1);
  }
  EXPECT_GT(compared, 2000);
}

// From one small step to the next no height changes by more than the steepest ground allows.
TEST(StreamedGlobe, NoSeamAtTheDateLineNorAtThePoles) {
  const TemporaryFolder folder;
  for (const double west : {-180.0, 0.0}) {
    Globe globe;
    globe.west_deg = west;
    globe.height = Bulges;
    const auto terrain =
        StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), GlobeOnBody());
    const auto walk = [&](const std::function<Eigen::Vector3d(double)>& at, double stride) {
      constexpr int Steps = 2000;
      Rows3 points(Steps, 3);
      for (int i = 0; i < Steps; ++i) {
        points.row(i) = at(i - 0.5 * Steps + 0.3);
      }
      Eigen::VectorXd heights(Steps);
      terrain->Heights(points, heights);
      for (int i = 1; i < Steps; ++i) {
        // 0.2 m of height a metre is more than any slope of it; floats are a millimetre apart.
        ASSERT_NEAR(heights[i], heights[i - 1], 0.2 * stride + 1e-3) << points.row(i);
      }
    };
    const double metre = 1.0 / globe.radius / Degree;
    for (const double lat : {-89.9, -45.0, 0.0, 3.75, 60.0, 89.0}) {
      for (const double lon : {180.0, 0.0}) {
        walk([&](double s) { return Direction(lon + s * metre / std::cos(lat * Degree), lat); },
             1.0);
      }
    }
    for (const double pole : {90.0, -90.0}) {
      const SurfaceSample very = terrain->Sample({0.0, 0.0, pole});
      EXPECT_NEAR(very.height, ByHand(globe, 77.0, pole), 1e-3);
      EXPECT_NEAR(very.normal_S.norm(), 1.0, 1e-12);
      EXPECT_LT(very.slope_deg, 10.0);
      walk([&](double s) { return Direction(33.0, pole + s * metre); }, 1.0);
      // Around it, a metre and a kilometre away.
      walk([&](double s) { return Direction(s * 0.18, pole - std::copysign(metre, pole)); }, 0.01);
      walk([&](double s) { return Direction(s * 0.18, pole - std::copysign(1e3 * metre, pole)); },
           3.2);
    }
  }
}

// Heights that alternate from pixel to pixel, wherever the circle lies: over a pole, and the edge.
TEST(StreamedGlobe, RoughnessIsTakenAlongTheSphere) {
  const TemporaryFolder folder;
  Globe globe;
  globe.height = [&](double lon, double lat) {
    const auto column = std::lround((lon - globe.west_deg) / globe.Step() - 0.5);
    const auto row = std::lround((90.0 - lat) / globe.Step() - 0.5);
    return (column + row) % 2 == 0 ? 60.0 : 20.0;
  };
  const auto terrain =
      StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), GlobeOnBody());
  Rows3 points(5, 3);
  points.row(0) = Direction(10.0, 20.0);
  points.row(1) = Direction(179.9, -30.0);
  points.row(2) = Direction(50.0, 89.0);
  points.row(3) = Direction(50.0, -90.0);
  points.row(4) = Direction(-180.0, 60.0);
  Eigen::VectorXd roughness(5);
  terrain->Roughness(points, 16.0 * Degree * globe.radius, roughness);
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(roughness[i], 20.0, 0.3) << i; // 40 m from top to bottom
  }
  terrain->Roughness(points, 0.5 * Degree * globe.radius, roughness);
  EXPECT_TRUE(std::isnan(roughness[0])); // no four pixels
  // A slope is no roughness: 1000 m of height a radian of latitude.
  globe.height = [](double, double lat) { return 1000.0 * lat * Degree; };
  const auto slope = StreamedTerrain::Open(globe.File().Write(folder / "slope.tif"), GlobeOnBody());
  slope->Roughness(points.topRows(1), 16.0 * Degree * globe.radius, roughness.head(1));
  EXPECT_LT(roughness[0], 5.0); // 140 m without the plane
}

} // namespace
