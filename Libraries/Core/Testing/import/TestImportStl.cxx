// ReadModel on STL: hand-made files whose triangles, vertices and bounds are known.
#include "BinaryBytes.h"
#include "ImportTestSupport.h"

#include <dspace/import/files/Importers.h>

#include <limits>

namespace dspace {

namespace {

using testing::AppendBinary;
using testing::ExpectReadError;
using testing::HasWarning;
using testing::TempFolder;

// The twelve triangles of a box from (0, 0, 0) to `size`.
std::vector<std::array<float, 9>> BoxTriangles(float x, float y, float z) {
  const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  std::vector<std::array<float, 9>> triangles;
  for (const auto& q : quads) {
    for (const auto& [a, b, c] : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
      std::array<float, 9> t;
      std::size_t i = 0;
      for (const int corner : {a, b, c}) {
        t[i++] = corner & 1 ? x : 0.0f;
        t[i++] = corner & 2 ? y : 0.0f;
        t[i++] = corner & 4 ? z : 0.0f;
      }
      triangles.push_back(t);
    }
  }
  return triangles;
}

std::string Binary(const std::vector<std::array<float, 9>>& triangles,
                   const std::string& header = "binary") {
  std::string bytes = header;
  bytes.resize(80, ' ');
  AppendBinary(bytes, static_cast<std::uint32_t>(triangles.size()));
  for (const auto& t : triangles) {
    for (int i = 0; i < 3; ++i) {
      AppendBinary(bytes, 0.0f);
    }
    for (const float v : t) {
      AppendBinary(bytes, v);
    }
    AppendBinary<std::uint16_t>(bytes, 0);
  }
  return bytes;
}

std::string Text(const std::vector<std::array<float, 9>>& triangles, const std::string& name) {
  std::ostringstream out;
  out.precision(9);
  out << "solid " << name << "\n";
  for (const auto& t : triangles) {
    out << "facet normal 0 0 0\n outer loop\n";
    for (std::size_t i = 0; i < 9; i += 3) {
      out << "  vertex " << t[i] << " " << t[i + 1] << " " << t[i + 2] << "\n";
    }
    out << " endloop\nendfacet\n";
  }
  out << "endsolid " << name << "\n";
  return out.str();
}

// The reader itself: ReadModel adds normals, which splits vertices at creases.
Model Read(const std::string& path) {
  return ReadStl(path, {});
}

// A box: merged to its eight corners, its volume from the divergence theorem.
void ExpectBox(const Model& model, const Eigen::Vector3d& size) {
  ASSERT_EQ(model.meshes.size(), 1u);
  const Mesh& mesh = model.meshes[0];
  EXPECT_EQ(mesh.PrimitiveCount(), 12u);
  EXPECT_EQ(mesh.VertexCount(), 8u);
  EXPECT_EQ(model.TriangleCount(), 12u);
  EXPECT_TRUE(model.Bounds().min().isZero(0.0));
  EXPECT_TRUE(model.Bounds().max().isApprox(size, 1e-12));
  double volume = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    Eigen::Vector3d p[3];
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = Eigen::Map<const Eigen::Vector3f>(&mesh.positions[3 * mesh.indices[i + k]])
                 .cast<double>();
    }
    volume += p[0].dot(p[1].cross(p[2])) / 6.0;
  }
  EXPECT_NEAR(volume, size.prod(), 1e-6 * size.prod()); // outward, and closed
}

} // namespace

TEST(ImportStl, BinaryBox) {
  const TempFolder folder;
  const Model model = Read(folder.Write("box.stl", Binary(BoxTriangles(1, 2, 4))));
  ExpectBox(model, {1, 2, 4});
  EXPECT_TRUE(model.warnings.empty());
  EXPECT_EQ(model.nodes.at(0).name, "box");
}

TEST(ImportStl, BinaryThatBeginsWithSolid) {
  const TempFolder folder;
  ExpectBox(Read(folder.Write("box.stl", Binary(BoxTriangles(1, 2, 4), "solid facet"))), {1, 2, 4});
}

TEST(ImportStl, TextBoxes) {
  const TempFolder folder;
  ExpectBox(Read(folder.Write("a.stl", Text(BoxTriangles(1, 2, 4), "box"))), {1, 2, 4});
  // Two solids, in capitals, with other line ends.
  std::string text = Text(BoxTriangles(1, 1, 1), "one") + Text(BoxTriangles(3, 3, 3), "two");
  std::string loud;
  for (const char c : text) {
    loud += c == '\n' ? "\r\n" : std::string(1, static_cast<char>(std::toupper(c)));
  }
  const Model model = Read(folder.Write("b.stl", loud));
  ASSERT_EQ(model.meshes.size(), 2u);
  EXPECT_EQ(model.meshes[0].name, "ONE");
  EXPECT_EQ(model.meshes[1].name, "TWO");
  EXPECT_EQ(model.TriangleCount(), 24u);
  EXPECT_EQ(model.Bounds().max(), Eigen::Vector3d(3, 3, 3));
}

TEST(ImportStl, MergesOnlyEqualVertices) {
  const TempFolder folder;
  const float next = std::nextafter(1.0f, 2.0f);
  const Model model = Read(folder.Write(
      "a.stl", Binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {-0.0f, 0, 0, next, 0, 0, 0, 1, 0}})));
  EXPECT_EQ(model.meshes.at(0).VertexCount(), 4u); // -0 is 0, the next number is another
}

TEST(ImportStl, DegenerateTrianglesAreLeftOut) {
  const TempFolder folder;
  auto triangles = BoxTriangles(1, 1, 1);
  triangles.push_back({1, 1, 1, 1, 1, 1, 0, 0, 0});
  const std::string path = folder.Write("a.stl", Binary(triangles));
  const Model model = ReadModel(path);
  EXPECT_EQ(model.TriangleCount(), 12u);
  EXPECT_TRUE(HasWarning(model.warnings, "1 triangles with two equal corners"));
  ImportOptions strict;
  strict.strict = true;
  ExpectReadError(Error::Kind::Corrupt, "two equal corners", path, strict);
}

TEST(ImportStl, BadInput) {
  const TempFolder folder;
  const std::string good = Binary(BoxTriangles(1, 2, 4));
  ExpectReadError(Error::Kind::NotFound, "absent.stl", folder / "absent.stl");
  ExpectReadError(Error::Kind::Corrupt, "is empty", folder.Write("empty.stl", ""));
  ExpectReadError(Error::Kind::Corrupt, "says it has 12 triangles",
                  folder.Write("cut.stl", good.substr(0, good.size() - 1)));
  ExpectReadError(Error::Kind::Corrupt, "is not an STL file", folder.Write("short.stl", "hello"));
  ExpectReadError(Error::Kind::Corrupt, "has no triangles", folder.Write("none.stl", Binary({})));
  ExpectReadError(Error::Kind::Corrupt, "no-facets.stl': has no triangles",
                  folder.Write("no-facets.stl", "solid a\nendsolid a\n"));
  std::string many = good;
  many.replace(80, 4, "\xff\xff\xff\xff");
  ExpectReadError(Error::Kind::Corrupt, "says it has 4294967295", folder.Write("many.stl", many));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  ExpectReadError(Error::Kind::Corrupt, "positions that are not finite are left out: 1",
                  folder.Write("nan.stl", Binary({{0, 0, nan, 1, 0, 0, 0, 1, 0}})));
  const Model rest = ReadModel(folder.Write(
      "one.stl", Binary({{0, 0, nan, 1, 0, 0, 0, 1, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0}})));
  EXPECT_EQ(rest.TriangleCount(), 1u);
  EXPECT_TRUE(HasWarning(rest.warnings, "left out: 1 (the first: face 0)"));
  const std::string text = Text(BoxTriangles(1, 2, 4), "box");
  ExpectReadError(Error::Kind::Corrupt, "the end of the file",
                  folder.Write("cut-text.stl", text.substr(0, text.find("endloop"))));
  ExpectReadError(Error::Kind::Corrupt, "line 4: found 'x'",
                  folder.Write("x-text.stl", "solid a\nfacet normal 0 0 1\nouter loop\n"
                                             "vertex 0 x 0\n"));
  EXPECT_EQ(
      ReadModel(folder.Write("nan-text.stl",
                             "solid a\nfacet normal nan -nan(ind) 0\nouter loop\nvertex 0 0 0\n"
                             "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nfacet normal 0 0 0\n"
                             "outer loop\nvertex 0 nan 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                             "endfacet\nendsolid a\n"))
          .TriangleCount(),
      1u);
  ExpectReadError(Error::Kind::Corrupt, "line 5: found 'vertex'",
                  folder.Write("two.stl", "solid a\nfacet normal 0 0 1\nouter loop\n"
                                          "vertex 0 0\nvertex 0 0 0\n"));
  ImportOptions few;
  few.maximumTriangles = 11;
  ExpectReadError(Error::Kind::Resource, "11 triangles", folder.Write("good.stl", good), few);
}

} // namespace dspace
