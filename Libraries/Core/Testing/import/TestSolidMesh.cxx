// IsSolid on shapes whose answer is known by geometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <dspace/import/model/SolidMesh.h>
#include <dspace/scene/Primitives.h>

using namespace dspace;

namespace {

Mesh FromCorners(const std::vector<std::array<float, 3>>& points,
                 const std::vector<std::uint32_t>& indices) {
  Mesh mesh;
  for (const auto& p : points) {
    mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
  }
  mesh.indices = indices;
  return mesh;
}

// A prism along Z over a polygon in XY, its caps fans about the polygon's corner 0.
Mesh Prism(const std::vector<std::array<float, 2>>& polygon) {
  std::vector<std::array<float, 3>> points;
  for (const float z : {0.0f, 1.0f}) {
    for (const auto& p : polygon) {
      points.push_back({p[0], p[1], z});
    }
  }
  const auto n = static_cast<std::uint32_t>(polygon.size());
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    indices.insert(indices.end(), {i, j, n + j, i, n + j, n + i});
    if (i > 0 && j > 0) {
      indices.insert(indices.end(), {0, j, i, n, n + i, n + j});
    }
  }
  return FromCorners(points, indices);
}

Mesh Joined(const Mesh& a, const Mesh& b, float shift) {
  Mesh both = a;
  for (std::size_t i = 0; i < b.positions.size(); ++i) {
    both.positions.push_back(b.positions[i] + (i % 3 == 0 ? shift : 0.0f));
  }
  for (const std::uint32_t index : b.indices) {
    both.indices.push_back(index + static_cast<std::uint32_t>(a.VertexCount()));
  }
  return both;
}

Mesh Reversed(Mesh mesh) {
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    std::swap(mesh.indices[i], mesh.indices[i + 1]);
  }
  return mesh;
}

} // namespace

TEST(SolidMesh, ConvexPrimitivesAreSolidAtAnySize) {
  for (const double size : {1e-6, 1.0, 1e9}) {
    EXPECT_TRUE(IsSolid(MakeBox({size, 2 * size, 3 * size})));
    EXPECT_TRUE(IsSolid(MakeSphere(size, 24)));
    EXPECT_TRUE(IsSolid(MakeCylinder(size, 50 * size, 16)));
    EXPECT_TRUE(IsSolid(MakeCone(size, size, 7)));
  }
  EXPECT_TRUE(MakeBox({1, 1, 1}).solid) << "primitives carry the answer";
}

TEST(SolidMesh, OpenOrEmptyOrOtherThingsAreNot) {
  EXPECT_FALSE(IsSolid(MakePlane(1, 1)));
  EXPECT_FALSE(IsSolid(MakeDisc(1, 12)));
  EXPECT_FALSE(IsSolid(MakeLineSet({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, true)));
  EXPECT_FALSE(IsSolid(Mesh{}));
  Mesh box = MakeBox({1, 1, 1});
  box.indices.resize(box.indices.size() - 3); // a hole of one triangle
  EXPECT_FALSE(IsSolid(box));
  EXPECT_FALSE(IsSolid(FromCorners({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {0, 1, 2})));
}

// Its integrals are those of a closed surface, and all its faces look outwards: only its edges
// tell.
TEST(SolidMesh, ACubeWithAWindowInEachFaceIsOpen) {
  const auto cube = [](bool windows) {
    std::vector<std::array<float, 3>> points;
    std::vector<std::uint32_t> indices;
    for (int axis = 0; axis < 3; ++axis) {
      for (const float side : {-1.0f, 1.0f}) {
        const auto first = static_cast<std::uint32_t>(points.size());
        for (const float reach : {1.0f, 0.5f}) {
          for (const auto& uv : {std::array<float, 2>{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
            std::array<float, 3> p = {};
            p[axis] = side;
            p[(axis + 1) % 3] = side * reach * uv[0]; // the order turns with the side
            p[(axis + 2) % 3] = reach * uv[1];
            points.push_back(p);
          }
        }
        for (std::uint32_t i = 0; i < 4; ++i) {
          const std::uint32_t a = first + i;
          const std::uint32_t b = first + (i + 1) % 4;
          indices.insert(indices.end(), {a, b, b + 4, a, b + 4, a + 4});
        }
        if (!windows) {
          indices.insert(indices.end(), {first + 4, first + 5, first + 6});
          indices.insert(indices.end(), {first + 4, first + 6, first + 7});
        }
      }
    }
    return FromCorners(points, indices);
  };
  EXPECT_TRUE(IsSolid(cube(false)));
  EXPECT_FALSE(IsSolid(cube(true)));
}

TEST(SolidMesh, WindingDecidesWhatIsInside) {
  EXPECT_FALSE(IsSolid(Reversed(MakeBox({1, 1, 1}))));
  const Mesh tetrahedron = FromCorners({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                       {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
  EXPECT_TRUE(IsSolid(tetrahedron));
  Mesh turned = tetrahedron;
  std::swap(turned.indices[9], turned.indices[10]); // one face against the others
  EXPECT_FALSE(IsSolid(turned));
}

TEST(SolidMesh, PiecesAreJudgedEachByItself) {
  const Mesh box = MakeBox({1, 1, 1});
  EXPECT_TRUE(IsSolid(Joined(box, box, 5.0f)));
  EXPECT_FALSE(IsSolid(Joined(box, Reversed(box), 5.0f)));
  EXPECT_FALSE(IsSolid(Joined(box, MakePlane(1, 1), 5.0f)));
}

TEST(SolidMesh, ShapesThatCouldShowTheirInsideAreNotTrusted) {
  EXPECT_TRUE(IsSolid(Prism({{0, 0}, {2, 0}, {2, 1}, {0, 1}})));
  // A bow tie: closed, but half of it is inside out.
  EXPECT_FALSE(IsSolid(Prism({{0, 0}, {2, 1}, {2, 0}, {0, 1}})));
  // Embedded but not star-shaped: rejected, which only costs time.
  EXPECT_FALSE(IsSolid(MakeTorus(2, 0.5, 24)));
}

// A sphere with waves on it: star-shaped, not convex.
TEST(SolidMesh, StarShapedButDentedIsSolid) {
  Mesh dented = MakeSphere(1.0, 16);
  for (std::size_t i = 0; i < dented.positions.size(); i += 3) {
    const float r = 1.0f + 0.1f * std::sin(7.0f * dented.positions[i + 2]);
    for (std::size_t k = 0; k < 3; ++k) {
      dented.positions[i + k] *= r;
    }
  }
  EXPECT_TRUE(IsSolid(dented));
}
