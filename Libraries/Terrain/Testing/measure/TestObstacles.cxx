// The first of several obstacles, and places on and below the ground.
#include <memory>

#include <gtest/gtest.h>

#include "Grids.h"

#include <dspace/Error.h>
#include <dspace/measure/Obstacles.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace::testing {
namespace {

using V = Eigen::Vector3d;

// A triangle across the x axis at `x`, as object `id`.
void AddTriangle(Obstacles& obstacles, std::uint32_t id, double x) {
  auto mesh = std::make_shared<Mesh>();
  mesh->positions = {0, -9, -9, 0, 9, -9, 0, 0, 9};
  mesh->indices = {0, 1, 2};
  Eigen::Affine3d X_RM = Eigen::Affine3d::Identity();
  X_RM.translate(V(x, 0, 0));
  obstacles.Add(id, std::make_shared<MeshRays>(mesh), X_RM);
}

std::shared_ptr<const GridTerrain> Level(double height) {
  return Sampled(41, 41, NorthUp(-20.5, 20.5, 1.0), [=](const Eigen::Vector2d&) { return height; });
}

TEST(Obstacles, TheNearestOfSeveralIsTheFirst) {
  Obstacles obstacles;
  AddTriangle(obstacles, 3, 8.0);
  AddTriangle(obstacles, 5, 4.0);
  AddTriangle(obstacles, 7, 6.0);
  const Obstacles::Hit hit = obstacles.First({0, 0, 0}, {10, 0, 0}, "start", "end");
  ASSERT_TRUE(hit.hit);
  EXPECT_EQ(hit.object, 5u);
  EXPECT_NEAR(hit.distance, 4.0, 1e-12);
  EXPECT_NEAR((hit.point - V(4, 0, 0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(obstacles.First({10, 0, 0}, {0, 0, 0}, "start", "end").object, 3u);
  EXPECT_FALSE(obstacles.First({0, 0, 0}, {3.9, 0, 0}, "start", "end").hit);
  // What touches an end is no obstacle.
  EXPECT_FALSE(obstacles.First({0, 0, 0}, {4, 0, 0}, "start", "end").hit);
  EXPECT_EQ(obstacles.First({4, 0, 0}, {10, 0, 0}, "start", "end").object, 7u);
}

TEST(Obstacles, GroundAndObjectsInOneLine) {
  const auto ground = Level(0.0);
  const V origin = ground->MapToScene({0.0, 0.0, 0.0});
  Obstacles obstacles;
  obstacles.Add(Obstacles::Ground{"ground", ground, {}});
  const V above = origin + V(0, 0, 3);
  const V below = origin + V(6, 0, -3);
  EXPECT_THROW(obstacles.First(above, below, "start", "end"), Error);
  Pose lower; // the same ground 2 m deeper, in another frame
  lower.position = V(0, 0, -2);
  Obstacles both;
  both.Add(Obstacles::Ground{"deep", ground, lower});
  AddTriangle(both, 9, origin.x() + 5.0);
  const Obstacles::Hit hit = both.First(above, origin + V(8, 0, 3), "start", "end");
  EXPECT_EQ(hit.object, 9u);
  EXPECT_TRUE(hit.terrain.empty());
}

TEST(Obstacles, APlaceBelowTheGroundIsNamed) {
  const auto ground = Level(0.0);
  const V origin = ground->MapToScene({0.0, 0.0, 0.0});
  Obstacles obstacles;
  obstacles.Add(Obstacles::Ground{"ground", ground, {}});
  const Obstacles::Ground& first = obstacles.Grounds().front();
  EXPECT_NEAR(Obstacles::HeightOver(first, origin + V(0, 0, 2.5)), 2.5, 1e-12);
  EXPECT_GT(obstacles.Stand(first, origin, "the mast").z(), origin.z());
  try {
    obstacles.Stand(first, origin - V(0, 0, 1.5), "the mast");
    ADD_FAILURE() << "not rejected";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("the mast"), std::string::npos) << text;
    EXPECT_NE(text.find("1.5 m below the ground of terrain 'ground'"), std::string::npos) << text;
  }
}

TEST(Obstacles, TheCheckEndsAMeasurement) {
  const auto ground = Level(0.0);
  Obstacles obstacles;
  obstacles.Add(Obstacles::Ground{"ground", ground, {}});
  obstacles.SetCheck([] { throw Error(Error::Kind::DeadlineExceeded, "test", "late"); });
  const V high = ground->MapToScene({0.0, 0.0, 5.0});
  EXPECT_THROW(obstacles.First(high, high + V(1, 0, 0), "start", "end"), Error);
}

TEST(Obstacles, ARayMeetsTheNearestOfGroundAndTriangles) {
  // Ground that rises by 1 in 2 along x, in a frame that is turned, doubled and moved.
  const auto ground = Sampled(41, 41, NorthUp(-20.5, 20.5, 1.0),
                              [](const Eigen::Vector2d& map) { return 0.5 * map.x(); });
  Pose X_RS;
  X_RS.position = V(100, -50, 30);
  X_RS.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(0.4, V(1, 2, 3).normalized()));
  X_RS.scale = 2.0;
  Obstacles obstacles;
  obstacles.Add(Obstacles::Ground{"slope", ground, X_RS, 4});
  const V zero_S = ground->MapToScene({0.0, 0.0, 0.0});
  const V from_R = X_RS.Apply(zero_S + V(0, 0, 6));
  const V down_R = X_RS.rotation * V(0, 0, -1);
  Obstacles::Start start = obstacles.StartAt(from_R, "start");
  Obstacles::Met met = obstacles.Meet(start, down_R, 1e9);
  ASSERT_NE(met.ground, nullptr);
  EXPECT_EQ(met.ground->id, 4u);
  EXPECT_EQ(met.solid, nullptr);
  EXPECT_NEAR(met.distance, 12.0, 1e-9);
  const V normal_R = X_RS.rotation * V(-1, 0, 2).normalized();
  EXPECT_NEAR((met.normal - normal_R).norm(), 0.0, 1e-9);
  EXPECT_EQ(obstacles.Meet(start, down_R, 11.9).ground, nullptr);
  EXPECT_TRUE(std::isinf(obstacles.Meet(start, -down_R, 1e9).distance));
  // A triangle in front of it, in a mesh that is stretched along x: its normal turns with it.
  auto mesh = std::make_shared<Mesh>();
  mesh->positions = {-9, -9, -9, 9, -9, 9, 0, 9, 0}; // the plane x = z
  mesh->indices = {0, 1, 2};
  Eigen::Affine3d X_RM = Eigen::Affine3d::Identity();
  X_RM.translate(from_R + 5.0 * down_R).rotate(X_RS.rotation).scale(V(3, 1, 1));
  obstacles.Add(8, std::make_shared<MeshRays>(mesh), X_RM, 0.25);
  met = obstacles.Meet(start, down_R, std::numeric_limits<double>::infinity());
  ASSERT_NE(met.solid, nullptr);
  EXPECT_EQ(met.ground, nullptr);
  EXPECT_EQ(met.solid->id, 8u);
  EXPECT_EQ(met.solid->albedo, 0.25);
  EXPECT_NEAR(met.distance, 5.0, 1e-9);
  EXPECT_NEAR(std::abs(met.normal.dot(X_RS.rotation * V(1, 0, -3).normalized())), 1.0, 1e-9);
  // A start below the ground.
  EXPECT_THROW(obstacles.StartAt(X_RS.Apply(zero_S - V(0, 0, 1)), "start"), Error);
}

} // namespace
} // namespace dspace::testing
