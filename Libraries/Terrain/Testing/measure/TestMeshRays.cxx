// Rays and distances against triangles, by brute force over random triangles.
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/measure/MeshRays.h>

namespace dspace::testing {
namespace {

using V = Eigen::Vector3d;

std::shared_ptr<Mesh> RandomMesh(std::mt19937& random, int triangles) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  auto mesh = std::make_shared<Mesh>();
  for (int t = 0; t < triangles; ++t) {
    const V center(4.0 * unit(random), 4.0 * unit(random), 4.0 * unit(random));
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        mesh->positions.push_back(float(center[axis] + unit(random)));
      }
      mesh->indices.push_back(std::uint32_t(mesh->indices.size()));
    }
  }
  return mesh;
}

V Corner(const Mesh& mesh, std::size_t i) {
  return {mesh.positions[3 * i], mesh.positions[3 * i + 1], mesh.positions[3 * i + 2]};
}

// By the plane of the triangle and the areas that its corners span with the crossing.
double FirstByHand(const Mesh& mesh, const V& origin, const V& direction) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
    const V a = Corner(mesh, t);
    const V b = Corner(mesh, t + 1);
    const V c = Corner(mesh, t + 2);
    const V normal = (b - a).cross(c - a);
    const double at = normal.dot(a - origin) / normal.dot(direction);
    const V p = origin + at * direction;
    const double areas =
        (b - p).cross(c - p).norm() + (c - p).cross(a - p).norm() + (a - p).cross(b - p).norm();
    if (at >= 0.0 && at <= 1.0 && areas <= normal.norm() * (1.0 + 1e-9)) {
      best = std::min(best, at);
    }
  }
  return best;
}

TEST(MeshRays, FindTheFirstOfManyTriangles) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-6.0, 6.0);
  const auto mesh = RandomMesh(random, 200);
  const MeshRays rays(mesh);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const V a(unit(random), unit(random), unit(random));
    const V b(unit(random), unit(random), unit(random));
    const double expected = FirstByHand(*mesh, a, b - a);
    const double found = rays.Intersect(a, b - a, 0.0, 1.0);
    hits += std::isfinite(expected) ? 1 : 0;
    if (std::isfinite(expected)) {
      EXPECT_NEAR(found, expected, 1e-9) << i;
    } else {
      EXPECT_EQ(found, expected) << i;
    }
  }
  EXPECT_GT(hits, 200);
  EXPECT_LT(hits, 1800);
}

TEST(MeshRays, LeaveOutWhatIsBeforeTheFirstAndAfterTheLast) {
  auto mesh = std::make_shared<Mesh>();
  mesh->positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  mesh->indices = {0, 1, 2};
  const MeshRays rays(mesh);
  const V from(0.25, 0.25, 1.0);
  const V down(0.0, 0.0, -2.0);
  EXPECT_DOUBLE_EQ(rays.Intersect(from, down, 0.0, 1.0), 0.5);
  EXPECT_DOUBLE_EQ(rays.Intersect(from, -down, -1.0, 0.0), -0.5);
  EXPECT_FALSE(std::isfinite(rays.Intersect(from, down, 0.6, 1.0)));
  EXPECT_FALSE(std::isfinite(rays.Intersect(from, down, 0.0, 0.4)));
  mesh->primitive = Mesh::Primitive::Lines;
  EXPECT_TRUE(MeshRays(mesh).IsEmpty());
}

// Points of both, taken densely.
TEST(MeshRays, FindTheNearestPointInAStretchedFrame) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto mesh = RandomMesh(random, 40);
  const MeshRays rays(mesh);
  Eigen::Affine3d X = Eigen::Affine3d::Identity();
  X.translate(V(10.0, -3.0, 2.0)).rotate(Eigen::AngleAxisd(0.7, V(1, 2, 3).normalized()));
  X.scale(V(2.0, 0.5, 1.0));
  for (int i = 0; i < 30; ++i) {
    const V a = X * V(9.0 * unit(random), 9.0 * unit(random), 9.0 * unit(random));
    const V b = X * V(9.0 * unit(random), 9.0 * unit(random), 9.0 * unit(random));
    double least = std::numeric_limits<double>::infinity();
    constexpr int Steps = 40;
    for (std::size_t t = 0; t < mesh->indices.size(); t += 3) {
      for (int u = 0; u <= Steps; ++u) {
        for (int v = 0; u + v <= Steps; ++v) {
          const V p = X * V(Corner(*mesh, t) +
                            double(u) / Steps * (Corner(*mesh, t + 1) - Corner(*mesh, t)) +
                            double(v) / Steps * (Corner(*mesh, t + 2) - Corner(*mesh, t)));
          const double s = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
          least = std::min(least, (a + s * (b - a) - p).norm());
        }
      }
    }
    const double infinity = std::numeric_limits<double>::infinity();
    const MeshRays::Near near = rays.Nearest(X, a, b, infinity);
    EXPECT_LE(near.distance, least + 1e-9) << i;
    EXPECT_GE(near.distance, least - 0.06) << i; // the points are that far apart
    EXPECT_FALSE(std::isfinite(rays.Nearest(X, a, b, near.distance).distance)) << i;
  }
}

} // namespace
} // namespace dspace::testing
