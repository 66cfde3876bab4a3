// The parts of a mesh hold all of it, and are smaller than it.
#include <gtest/gtest.h>

#include <cmath>

#include <dspace/import/model/Model.h>
#include <dspace/render/shadows/CasterParts.h>

using namespace dspace;

namespace {

// A square of n x n cells of 1 m whose heights are x squared over 100.
Mesh Bowl(int n) {
  Mesh mesh;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const float x = float(i) - 0.5f * float(n);
      mesh.positions.insert(mesh.positions.end(), {x, float(j), 0.01f * x * x});
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const auto a = std::uint32_t(j * (n + 1) + i);
      const auto b = a + std::uint32_t(n) + 1;
      mesh.indices.insert(mesh.indices.end(), {a, a + 1, b, a + 1, b + 1, b});
    }
  }
  return mesh;
}

} // namespace

TEST(CasterParts, HoldEveryTriangleAndAreSmall) {
  const Mesh mesh = Bowl(100);
  const std::vector<Eigen::AlignedBox3f> parts = PartsOf(mesh);
  ASSERT_GT(parts.size(), 500u);
  ASSERT_LT(parts.size(), 3u * MostParts);
  for (const Eigen::AlignedBox3f& part : parts) {
    // A cell of some 3.2 m, and a triangle more.
    EXPECT_LT(part.sizes().head<2>().maxCoeff(), 6.0f);
  }
  for (std::size_t i = 0; i < mesh.PrimitiveCount(); ++i) {
    Eigen::AlignedBox3f triangle;
    for (int k = 0; k < 3; ++k) {
      triangle.extend(Eigen::Map<const Eigen::Vector3f>(mesh.positions.data() +
                                                        3 * mesh.indices[3 * i + std::size_t(k)]));
    }
    bool held = false;
    for (const Eigen::AlignedBox3f& part : parts) {
      held = held || part.contains(triangle);
    }
    EXPECT_TRUE(held) << "triangle " << i;
  }
  // The middle of the bowl is low: no part there reaches the height of its rim.
  for (const Eigen::AlignedBox3f& part : parts) {
    if (std::abs(part.center().x()) < 10.0f) {
      EXPECT_LT(part.max().z(), 0.01f * 14.0f * 14.0f);
    }
  }
}

TEST(CasterParts, OfSmallMeshesLinesAndPlacesThereAreNone) {
  EXPECT_TRUE(PartsOf(Bowl(4)).empty());
  Mesh lines = Bowl(40);
  lines.primitive = Mesh::Primitive::Lines;
  EXPECT_TRUE(PartsOf(lines).empty());
  Mesh place = Bowl(40);
  std::fill(place.positions.begin(), place.positions.end(), 1.0f);
  EXPECT_TRUE(PartsOf(place).empty());
  EXPECT_TRUE(PartsOf(Mesh()).empty());
}

TEST(CasterParts, OfARodAreAlongIt) {
  Mesh rod = Bowl(60);
  for (std::size_t i = 0; i < rod.positions.size(); i += 3) {
    rod.positions[i] = 0.0f;
    rod.positions[i + 2] = 0.0f;
  }
  const std::vector<Eigen::AlignedBox3f> parts = PartsOf(rod);
  ASSERT_GT(parts.size(), 20u);
  for (const Eigen::AlignedBox3f& part : parts) {
    EXPECT_LT(part.sizes().y(), 3.0f);
  }
}
