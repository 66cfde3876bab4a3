// Lines of sight over planes, spheres and rough ground, against closed forms and brute force.
#include <cmath>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "Globe.h"
#include "Grids.h"

#include <dspace/Error.h>
#include <dspace/measure/SightLine.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace::testing {
namespace {

using V = Eigen::Vector3d;

SightLine LineOver(const Obstacles& obstacles, const V& from, const V& to) {
  return {obstacles, from, to, "start", "end"};
}

Obstacles Over(const TerrainSurface& surface, const Pose& X_RS = {}) {
  Obstacles obstacles;
  obstacles.Add(Obstacles::Ground{"ground", {std::shared_ptr<void>(), &surface}, X_RS});
  return obstacles;
}

// A level plane at z = 0 with one post that is `height` above it, at (200, 0).
std::shared_ptr<const GridTerrain> WithPost(double height) {
  return Sampled(401, 21, NorthUp(-0.5, 10.5, 1.0), [height](const Eigen::Vector2d& p) {
    return std::abs(p.x() - 200.0) < 0.1 && std::abs(p.y()) < 0.1 ? height : 0.0;
  });
}

// The least height of the line over the triangles, where it crosses the lines between posts.
double LeastHeightByHand(const GridTerrain& ground, const V& from, const V& to) {
  double least = std::numeric_limits<double>::infinity();
  constexpr int Steps = 200000;
  for (int i = 0; i <= Steps; ++i) {
    const V p = from + double(i) / Steps * (to - from);
    const SurfaceSample sample = ground.Sample(p);
    least = sample.valid ? std::min(least, p.z() - sample.position_S.z()) : least;
  }
  return least;
}

TEST(SightLine, AHalfMetrePostFlipsTheAnswer) {
  const auto without = WithPost(0.0);
  const auto with = WithPost(0.5);
  const V from = without->MapToScene({0.0, 0.0, 0.4});
  const V to = without->MapToScene({400.0, 0.0, 0.4});
  const SightLine clear = LineOver(Over(*without), from, to);
  EXPECT_FALSE(clear.First().hit);
  const Obstacles obstacles = Over(*with);
  const SightLine blocked(obstacles, from, to, "start", "end");
  ASSERT_TRUE(blocked.First().hit);
  EXPECT_EQ(blocked.First().terrain, "ground");
  // The flank rises from the post before, 0.5 m in 1 m: 0.4 m after 0.8 m.
  EXPECT_NEAR(blocked.First().distance, 199.8, 1e-9);
  EXPECT_NEAR(blocked.Height(), -0.1, 2e-6);
  // The line must turn up so that it passes over the top half way.
  EXPECT_NEAR(blocked.Angle(), -std::atan2(0.1, 200.0) / Degree, 1e-7);
  // At 3 cm the first zone's radius half way is sqrt(0.03 * 400) / 2.
  EXPECT_NEAR(blocked.Fresnel(0.03), -0.1 / (0.5 * std::sqrt(12.0)), 1e-3);
}

TEST(SightLine, MarginsOfAClearLineAreThoseOfThePost) {
  const auto ground = WithPost(0.5);
  const Obstacles obstacles = Over(*ground);
  const V from = ground->MapToScene({100.0, 0.0, 1.7});
  const V to = ground->MapToScene({350.0, 0.0, 2.3});
  const SightLine line(obstacles, from, to, "start", "end");
  EXPECT_FALSE(line.First().hit);
  const double at = 1.7 + 0.6 * 100.0 / 250.0; // height of the line at the post
  EXPECT_NEAR(line.Height(), at - 0.5, 2e-6);
  const double least = std::atan2(0.6, 250.0) - std::atan2(0.5 - 1.7, 100.0);
  const double foot = std::atan2(0.6, 250.0) - std::atan2(-1.7, 250.0); // the end's own ground
  EXPECT_NEAR(line.Angle(), std::min(least, foot) / Degree, 1e-7);
  const double zone = std::sqrt(0.125 * 100.0 * 150.0 / 250.0);
  EXPECT_NEAR(line.Fresnel(0.125), (at - 0.5) / zone, 2e-3 * (at - 0.5) / zone);
}

TEST(SightLine, LowMastsLimitTheHeight) {
  const auto ground = WithPost(0.0);
  const Obstacles obstacles = Over(*ground);
  const SightLine line(obstacles, ground->MapToScene({50.0, 3.0, 2.0}),
                       ground->MapToScene({350.0, -4.0, 5.0}), "start", "end");
  EXPECT_FALSE(line.First().hit);
  EXPECT_NEAR(line.Height(), 2.0, 1e-6);
}

TEST(SightLine, RoughGroundAgreesWithPointsOfTheLine) {
  const auto ground = Rough(80, 60, 7);
  const Obstacles obstacles = Over(*ground);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int blocked = 0;
  for (int i = 0; i < 40; ++i) {
    const auto place = [&] {
      const V map(1001.0 + 53.0 * unit(random), 1999.0 - 38.0 * unit(random), 0.0);
      V p = ground->MapToScene(map);
      p.z() = ground->Sample(p).position_S.z() + 0.2 + 4.0 * unit(random);
      return p;
    };
    const V from = place();
    const V to = place();
    const SightLine line(obstacles, from, to, "start", "end");
    const double least = LeastHeightByHand(*ground, from, to);
    EXPECT_NEAR(line.Height(), least, 1e-3) << i;
    if (std::abs(least) > 1e-3) {
      EXPECT_EQ(line.First().hit, least < 0.0) << i;
    }
    EXPECT_EQ(line.Angle() < 0.0, line.First().hit) << i;
    blocked += line.First().hit ? 1 : 0;
  }
  EXPECT_GT(blocked, 5);
  EXPECT_LT(blocked, 35);
}

class OnSphere : public ::testing::Test {
protected:
  // A smooth sphere of 1,737.4 km.
  void SetUp() override {
    Globe globe;
    globe.height = [](double, double) { return 0.0; };
    const std::string path = globe.File().Write((this->Folder_.Path() / "globe.tif").string());
    StreamedTerrainOptions options;
    options.onBody = true;
    this->Terrain_ = StreamedTerrain::Open(path, options);
  }
  // On the equator, at an angle [rad] from longitude 10.
  V At(double angle, double height) const {
    return (this->Radius_ + height) * Direction(10.0 + angle / Degree, 0.0);
  }
  double Radius_ = 1737400.0;
  TemporaryFolder Folder_;
  std::shared_ptr<StreamedTerrain> Terrain_;
};

TEST_F(OnSphere, TwoMastsSeeEachOtherOverTheBulgeOrDoNot) {
  const Obstacles obstacles = Over(*this->Terrain_);
  // Masts of 10 m see each other up to 2 acos(R / (R + h)).
  const double most = 2.0 * std::acos(this->Radius_ / (this->Radius_ + 10.0));
  for (const double share : {0.5, 0.999, 1.001, 1.4}) {
    const double angle = share * most;
    const V from = this->At(0.0, 10.0);
    const V to = this->At(angle, 10.0);
    const SightLine line(obstacles, from, to, "start", "end");
    EXPECT_EQ(line.First().hit, share > 1.0) << share;
    // In the middle the line is at (R + h) cos(angle / 2) from the centre.
    const double middle = (this->Radius_ + 10.0) * std::cos(0.5 * angle) - this->Radius_;
    EXPECT_NEAR(line.Height(), middle, 1e-3) << share; // posts' chords are within a millimetre
    const double zone = 0.5 * std::sqrt(0.1 * line.Range());
    EXPECT_NEAR(line.Fresnel(0.1), middle / zone, 0.02) << share;
    // The elevation of the end over the tangent at the start.
    const double elevation = -0.5 * angle;
    const double tangent = -std::acos(this->Radius_ / (this->Radius_ + 10.0));
    EXPECT_NEAR(line.Angle(), (elevation - tangent) / Degree, 2e-5) << share;
  }
}

TEST_F(OnSphere, AnyPoseAndScaleOfTheTerrainGivesTheSame) {
  Pose X;
  X.position = V(1e6, -2e6, 5e5);
  X.rotation = Eigen::AngleAxisd(1.1, V(1, -2, 0.5).normalized());
  X.scale = 0.5;
  const Obstacles plain = Over(*this->Terrain_);
  const Obstacles moved = Over(*this->Terrain_, X);
  const V from = this->At(0.0, 30.0);
  const V to = this->At(0.004, 50.0);
  const SightLine a(plain, from, to, "start", "end");
  const SightLine b(moved, X.Apply(from), X.Apply(to), "start", "end");
  EXPECT_EQ(a.First().hit, b.First().hit);
  EXPECT_NEAR(0.5 * a.Height(), b.Height(), 1e-4);
  EXPECT_NEAR(a.Angle(), b.Angle(), 1e-6);
}

TEST(SightLine, TrianglesBlockAndLimit) {
  auto mesh = std::make_shared<Mesh>();
  mesh->positions = {0, -1, 0, 0, 1, 0, 0, 0, 3}; // upright at x = 0
  mesh->indices = {0, 1, 2};
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  X.translate(V(5.0, 0.0, 0.0));
  Obstacles obstacles;
  obstacles.Add(17, std::make_shared<MeshRays>(mesh), X);
  const SightLine blocked(obstacles, V(0, 0, 1), V(10, 0, 1), "start", "end");
  ASSERT_TRUE(blocked.First().hit);
  EXPECT_EQ(blocked.First().object, 17u);
  EXPECT_NEAR(blocked.First().distance, 5.0, 1e-12);
  const SightLine clear(obstacles, V(0, 0, 4), V(10, 0, 4), "start", "end");
  EXPECT_FALSE(clear.First().hit);
  EXPECT_NEAR(clear.Solids().distance, 1.0, 1e-12);
  EXPECT_NEAR(clear.Solids().angle_deg, std::atan2(1.0, 5.0) / Degree, 1e-9);
  EXPECT_TRUE(std::isinf(clear.Height())); // there is no ground
  EXPECT_TRUE(std::isinf(clear.Angle()));
  // A line that ends on a triangle is clear.
  EXPECT_FALSE(SightLine(obstacles, V(0, 0, 1), V(5, 0, 1), "start", "end").First().hit);
}

TEST(SightLine, APlaceBelowTheGroundIsAnError) {
  const auto ground = WithPost(0.0);
  const Obstacles obstacles = Over(*ground);
  try {
    LineOver(obstacles, ground->MapToScene({50.0, 0.0, 1.0}),
             ground->MapToScene({60.0, 0.0, -2.5}));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.GetObjectName(), "end");
    EXPECT_NE(std::string(error.what()).find("2.5 m below the ground of terrain 'ground'"),
              std::string::npos)
        << error.what();
  }
}

TEST(SightLine, TheCheckEndsTheMeasurement) {
  const auto ground = WithPost(0.5);
  Obstacles obstacles = Over(*ground);
  int left = 5;
  obstacles.SetCheck([&left] {
    if (--left < 0) {
      throw Error(Error::Kind::DeadlineExceeded, "measurement", "late");
    }
  });
  const SightLine line(obstacles, ground->MapToScene({0.0, 0.0, 1.0}),
                       ground->MapToScene({400.0, 0.0, 1.0}), "start", "end");
  EXPECT_THROW(line.Height(), Error);
}

} // namespace
} // namespace dspace::testing
