// The ring of positions against a plain list, and its line's precision far from the frame's origin.
#include <cmath>
#include <deque>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/scene/GraphicsObject.h>
#include <dspace/scene/Trail.h>

namespace {

using dspace::Mesh;
using dspace::Trail;
using Eigen::Vector3d;

Vector3d At(const Mesh& mesh, std::size_t i) {
  return {mesh.positions[3 * i], mesh.positions[3 * i + 1], mesh.positions[3 * i + 2]};
}

} // namespace

TEST(Trail, AgreesWithAPlainList) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> step(-0.5, 0.5);
  Trail trail(20, 0.4);
  std::deque<Vector3d> list;
  Vector3d p = Vector3d::Zero();
  for (int i = 0; i < 500; ++i) {
    p += Vector3d(step(random), step(random), step(random));
    const bool kept = list.empty() || (p - list.back()).norm() >= 0.4;
    if (kept) {
      list.push_back(p);
    }
    if (list.size() > 20) {
      list.pop_front();
    }
    ASSERT_EQ(trail.Add(p), kept);
    ASSERT_EQ(trail.Size(), list.size());
    for (std::size_t k = 0; k < list.size(); ++k) {
      ASSERT_EQ(trail.Position(k), list[k]);
    }
    const Mesh mesh = trail.LineMesh(Vector3d::Zero());
    ASSERT_EQ(mesh.VertexCount(), list.size() + (kept ? 0 : 1));
    ASSERT_EQ(mesh.PrimitiveCount(), mesh.VertexCount() - 1);
    ASSERT_LT((At(mesh, mesh.VertexCount() - 1) - p).norm(), 1e-5); // ends where the thing is
    ASSERT_EQ(trail.End(), p);
    ASSERT_NO_THROW(dspace::CheckMesh(mesh, "trail"));
  }
  EXPECT_EQ(trail.Size(), trail.Capacity());
}

TEST(Trail, LineRunsFromOldestToNewest) {
  Trail trail(3, 0.0);
  for (int i = 0; i < 5; ++i) {
    trail.Add({double(i), 0, 0});
  }
  const Mesh mesh = trail.LineMesh({1, 0, 0});
  ASSERT_EQ(mesh.VertexCount(), 3u); // 2, 3, 4
  EXPECT_EQ(At(mesh, 0), Vector3d(1, 0, 0));
  EXPECT_EQ(At(mesh, 2), Vector3d(3, 0, 0));
  EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 1, 2}));
  EXPECT_EQ(mesh.primitive, Mesh::Primitive::Lines);
  EXPECT_TRUE(mesh.colors.empty());
}

TEST(Trail, MillimetresAtAnAstronomicalUnit) {
  // Doubles step by 3e-5 m there, floats by 16 km: only the subtraction first keeps the steps.
  const Vector3d far(1.5e11, -1.0e11, 0.5e11);
  Trail trail(100, 1e-4);
  for (int i = 0; i < 50; ++i) {
    trail.Add(far + Vector3d(0.001 * i, 0, 0));
  }
  const Mesh mesh = trail.LineMesh(trail.End());
  ASSERT_EQ(mesh.VertexCount(), 50u);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_LT((At(mesh, i) - Vector3d(0.001 * (double(i) - 49.0), 0, 0)).norm(), 5e-5);
  }
}

TEST(Trail, FadesTowardsTheOldest) {
  Trail trail(10, 1.0, true);
  for (int i = 0; i < 5; ++i) {
    trail.Add({double(i), 0, 0});
  }
  trail.Add({4.5, 0, 0}); // the end, not kept
  const Mesh mesh = trail.LineMesh(Vector3d::Zero());
  ASSERT_EQ(mesh.VertexCount(), 6u);
  ASSERT_EQ(mesh.colors.size(), 24u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(mesh.colors[4 * i], 255);
    EXPECT_EQ(mesh.colors[4 * i + 3], 51 * i); // 255 / 5 a step
  }
}

TEST(Trail, EmptyAndCleared) {
  Trail trail(4, 0.0, true);
  EXPECT_EQ(trail.LineMesh(Vector3d::Zero()).VertexCount(), 0u);
  trail.Add({1, 2, 3});
  const Mesh one = trail.LineMesh(Vector3d::Zero());
  EXPECT_EQ(one.VertexCount(), 1u);
  EXPECT_TRUE(one.indices.empty());
  EXPECT_EQ(one.colors[3], 255);
  for (int i = 0; i < 9; ++i) {
    trail.Add({double(i), 0, 0});
  }
  trail.Clear();
  EXPECT_EQ(trail.Size(), 0u);
  EXPECT_EQ(trail.End(), Vector3d(Vector3d::Zero()));
  trail.Add({7, 0, 0});
  EXPECT_EQ(trail.Position(0), Vector3d(7, 0, 0));
}

TEST(Trail, Rejections) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Trail(1, 0.0), dspace::Error);
  EXPECT_THROW(Trail(10000001, 0.0), dspace::Error);
  EXPECT_THROW(Trail(2, -1.0), dspace::Error);
  EXPECT_THROW(Trail(2, nan), dspace::Error);
  Trail trail(4, 0.0);
  trail.Add({1, 1, 1});
  EXPECT_THROW(trail.Add({nan, 0, 0}), dspace::Error);
  EXPECT_THROW(trail.LineMesh({0, nan, 0}), dspace::Error);
  EXPECT_THROW(trail.Position(1), dspace::Error);
  EXPECT_EQ(trail.Size(), 1u);
  EXPECT_EQ(trail.End(), Vector3d(1, 1, 1));
}
