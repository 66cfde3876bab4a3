// ReadModel on PLY: hand-made files in all three formats whose values are known.
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

// A pyramid: a square of side 2 and four triangles, with colours, normals, texture coordinates and
// things that nobody knows.
const char* const Declarations = "comment made by hand\n"
                                 "element junk 2\nproperty list uchar double values\n"
                                 "property short s\n"
                                 "element vertex 5\nproperty double x\nproperty float y\n"
                                 "property short z\nproperty list int uchar tags\n"
                                 "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                                 "property float nx\nproperty float ny\nproperty float nz\n"
                                 "property float s\nproperty float t\n"
                                 "element face 5\nproperty uint quality\n"
                                 "property list ushort uint vertex_index\n"
                                 "end_header\n";
const double Positions[5][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 3}};
const int Colors[5][3] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {10, 20, 30}, {40, 50, 60}};
const std::vector<std::vector<std::uint32_t>> Faces = {
    {3, 2, 1, 0}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};

std::string TextPyramid() {
  std::ostringstream out;
  out << "ply\nformat ascii 1.0\n" << Declarations << "2 0.5 1.5 -7\n0 8\n";
  for (int i = 0; i < 5; ++i) {
    const auto& p = Positions[i];
    const auto& c = Colors[i];
    out << p[0] << " " << p[1] << " " << p[2] << " " << i;
    for (int k = 0; k < i; ++k) {
      out << " " << k;
    }
    out << " " << c[0] << " " << c[1] << " " << c[2] << " 0 0 2 0.25 0.75\n";
  }
  for (const auto& face : Faces) {
    out << "9 " << face.size();
    for (const std::uint32_t i : face) {
      out << " " << i;
    }
    out << "\n";
  }
  return out.str();
}

std::string BinaryPyramid(bool big) {
  std::string out = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                    "_endian 1.0\n" + Declarations;
  out += '\2';
  AppendBinary(out, 0.5, big);
  AppendBinary(out, 1.5, big);
  AppendBinary<std::int16_t>(out, -7, big);
  out += '\0';
  AppendBinary<std::int16_t>(out, 8, big);
  for (int i = 0; i < 5; ++i) {
    AppendBinary(out, Positions[i][0], big);
    AppendBinary(out, static_cast<float>(Positions[i][1]), big);
    AppendBinary(out, static_cast<std::int16_t>(Positions[i][2]), big);
    AppendBinary<std::int32_t>(out, i, big);
    out.append(static_cast<std::size_t>(i), '\7');
    for (const int c : Colors[i]) {
      out += static_cast<char>(c);
    }
    for (const float v : {0.0f, 0.0f, 2.0f, 0.25f, 0.75f}) {
      AppendBinary(out, v, big);
    }
  }
  for (const auto& face : Faces) {
    AppendBinary<std::uint32_t>(out, 9, big);
    AppendBinary(out, static_cast<std::uint16_t>(face.size()), big);
    for (const std::uint32_t i : face) {
      AppendBinary(out, i, big);
    }
  }
  return out;
}

void ExpectPyramid(const Model& model) {
  ASSERT_EQ(model.meshes.size(), 1u);
  const Mesh& mesh = model.meshes[0];
  EXPECT_EQ(mesh.VertexCount(), 5u);
  EXPECT_EQ(model.TriangleCount(), 6u);
  EXPECT_EQ(model.Bounds().min(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(model.Bounds().max(), Eigen::Vector3d(2, 2, 3));
  ASSERT_EQ(mesh.colors.size(), 20u);
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(mesh.colors[4 * i + k], Colors[i][k]);
      EXPECT_EQ(mesh.normals[3 * i + k], k == 2 ? 1.0f : 0.0f); // made unit
    }
    EXPECT_EQ(mesh.colors[4 * i + 3], 255);
    EXPECT_EQ(mesh.tcoords[2 * i], 0.25f);
    EXPECT_EQ(mesh.tcoords[2 * i + 1], 0.75f);
  }
  // The colours are the vertices' own: the material does not tint them.
  EXPECT_EQ(model.materials.at(static_cast<std::size_t>(mesh.material)).color,
            (std::array<double, 3>{1, 1, 1}));
  double volume = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    Eigen::Vector3d p[3];
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = Eigen::Map<const Eigen::Vector3f>(&mesh.positions[3 * mesh.indices[i + k]])
                 .cast<double>();
    }
    volume += p[0].dot(p[1].cross(p[2])) / 6.0;
  }
  EXPECT_NEAR(volume, 2.0 * 2.0 * 3.0 / 3.0, 1e-6);
  EXPECT_TRUE(HasWarning(model.warnings, "element junk is not read"));
}

std::string Square(const std::string& vertexRows, const std::string& faceRows, int vertices = 4,
                   int faces = 1) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n" +
         vertexRows + faceRows;
}

const char* const SquareRows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

} // namespace

TEST(ImportPly, PyramidInAllFormats) {
  const TempFolder folder;
  ExpectPyramid(ReadModel(folder.Write("text.ply", TextPyramid())));
  ExpectPyramid(ReadModel(folder.Write("little.ply", BinaryPyramid(false))));
  ExpectPyramid(ReadModel(folder.Write("big.ply", BinaryPyramid(true))));
}

TEST(ImportPly, CarriageReturnsInHeader) {
  const TempFolder folder;
  std::string text;
  for (const char c : Square(SquareRows, "4 0 1 2 3\n")) {
    text += c == '\n' ? "\r\n" : std::string(1, c);
  }
  EXPECT_EQ(ReadModel(folder.Write("a.ply", text)).TriangleCount(), 2u);
}

TEST(ImportPly, ConcavePolygon) {
  const TempFolder folder;
  // An arrow head, whose fan from corner 0 would cover what lies outside of it.
  const Model model =
      ReadModel(folder.Write("a.ply", Square("2 2 0\n0 4 0\n1 2 0\n0 0 0\n", "4 1 2 3 0\n")));
  ASSERT_EQ(model.TriangleCount(), 2u);
  const Mesh& mesh = model.meshes[0];
  double area = 0.0;
  for (std::size_t i = 0; i < 6; i += 3) {
    const auto at = [&mesh](std::size_t k) {
      return Eigen::Vector2d(mesh.positions[3 * mesh.indices[k]],
                             mesh.positions[3 * mesh.indices[k] + 1]);
    };
    const Eigen::Vector2d a = at(i + 1) - at(i);
    const Eigen::Vector2d b = at(i + 2) - at(i);
    EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0.0) << "a triangle is turned over";
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  EXPECT_NEAR(area, 2.0, 1e-12); // shoelace formula
}

TEST(ImportPly, PointCloudEdgesAndStrips) {
  const TempFolder folder;
  const std::string file = folder.Write("points.ply", Square(SquareRows, "", 4, 0));
  ExpectReadError(Error::Kind::Corrupt, "points.ply': has 4 vertices and no faces", file);
  ExpectReadError(Error::Kind::Corrupt, "point_cloud=True", file);
  ImportOptions cloud;
  cloud.pointCloud = true;
  const Model points = ReadModel(file, cloud);
  ASSERT_EQ(points.meshes.size(), 1u);
  EXPECT_EQ(points.meshes[0].primitive, Mesh::Primitive::Points);
  EXPECT_EQ(points.meshes[0].PrimitiveCount(), 4u);

  const std::string header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                             "property float y\nproperty float z\n";
  const Model edges = ReadModel(
      folder.Write("edges.ply", header +
                                    "element edge 2\nproperty int vertex1\nproperty int vertex2\n"
                                    "end_header\n" +
                                    SquareRows + "0 1\n2 3\n"));
  ASSERT_EQ(edges.meshes.size(), 1u);
  EXPECT_EQ(edges.meshes[0].primitive, Mesh::Primitive::Lines);
  EXPECT_EQ(edges.meshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2, 3}));

  const Model strip = ReadModel(
      folder.Write("strip.ply", header +
                                    "element tristrips 1\nproperty list int int vertex_indices\n"
                                    "end_header\n" +
                                    SquareRows + "8 0 1 3 2 -1 0 1 2\n"));
  EXPECT_EQ(strip.meshes.at(0).indices, (std::vector<std::uint32_t>{0, 1, 3, 3, 1, 2, 0, 1, 2}));
}

TEST(ImportPly, FarFromOriginKeepsItsShape) {
  const TempFolder folder;
  // Map coordinates whose tenths of a millimetre a float would lose.
  const Model model = ReadModel(folder.Write(
      "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
               "property double z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n4000000.0001 500000 10\n4000001.0003 500000 10\n4000000 500001 11\n"
               "3 0 1 2\n"));
  const Eigen::Affine3d X = model.NodeToModel(0);
  const Mesh& mesh = model.meshes.at(0);
  const Eigen::Vector3d first =
      X * Eigen::Map<const Eigen::Vector3f>(mesh.positions.data()).cast<double>();
  EXPECT_NEAR(first.x(), 4000000.0001, 1e-6);
  EXPECT_NEAR(model.Bounds().max().x(), 4000001.0003, 1e-6);
}

TEST(ImportPly, BadInput) {
  const TempFolder folder;
  const auto bad = [&folder](const std::string& part, const std::string& bytes,
                             Error::Kind kind = Error::Kind::Corrupt) {
    ExpectReadError(kind, part, folder.Write("bad.ply", bytes));
  };
  ExpectReadError(Error::Kind::NotFound, "absent.ply", folder / "absent.ply");
  bad("is empty", "");
  bad("header line 1: 'ply' is expected", "plx\n");
  bad("no 'end_header'", "ply\nformat ascii 1.0\n");
  bad("format ascii|binary_little_endian", "ply\nformat ascii 2.0\nend_header\n");
  bad("there is no 'format' line", "ply\nend_header\n");
  bad("has no vertices", "ply\nformat ascii 1.0\nend_header\n");
  bad("'real' is not a type",
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty real x\nend_header\n1\n");
  bad("is given twice", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                        "property float x\nend_header\n1 1\n");
  bad("has no properties x, y and z",
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n");
  bad("vertex index 4.0", Square(SquareRows, "3 0 1 4\n"));
  bad("vertex index -1.0", Square(SquareRows, "3 0 1 -1\n"));
  bad("positions that are not finite are left out: 1",
      Square("0 0 0\nnan 0 0\n1 1 0\n0 1 0\n", "3 0 1 2\n"));
  bad("'x' is not a number", Square("0 0 0\nx 0 0\n1 1 0\n0 1 0\n", "3 0 1 2\n"));
  bad("'1.5' is not an integer", Square(SquareRows, "3 0 1 1.5\n"));
  bad("face 0: the file ends here", Square(SquareRows, "3 0 1\n"));
  bad("does not fit in the file", Square(SquareRows, "200 0 1 2\n"));
  bad("element vertex: 1000000000 rows",
      Square(SquareRows, "3 0 1 2\n", 1000000000)); // rejected before anything is allocated
  std::string cut = BinaryPyramid(false);
  bad("face 4: ", cut.substr(0, cut.size() - 1));
  std::string rows = BinaryPyramid(true);
  rows.replace(rows.find("face 5"), 6, "face 9");
  bad("face ", rows);
  ImportOptions few;
  few.maximumTriangles = 5;
  ExpectReadError(Error::Kind::Resource, "5 triangles", folder.Write("a.ply", TextPyramid()), few);
}

TEST(ImportPly, UnusableAttributesAreRepaired) {
  const TempFolder folder;
  std::string text = TextPyramid();
  const std::size_t at = text.find("0 0 2 0.25");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 10, "0 0 0 0.25");
  const Model model = ReadModel(folder.Write("a.ply", text));
  const Mesh& mesh = model.meshes.at(0);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (std::size_t v = 0; v < mesh.VertexCount(); ++v) {
    EXPECT_NEAR(Eigen::Map<const Eigen::Vector3f>(&mesh.normals[3 * v]).norm(), 1.0, 1e-6);
  }
  EXPECT_TRUE(HasWarning(model.warnings, "made from the faces: 1 (the first: vertex"));
}

// What other writers and readers agree on, beyond the format's first description.
TEST(ImportPly, VariantsOfHeadersAndNumbers) {
  const TempFolder folder;
  const std::string rows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const auto read = [&](const std::string& bytes, bool cloud = false) {
    ImportOptions options;
    options.pointCloud = cloud;
    return ReadModel(folder.Write("v.ply", bytes), options);
  };
  const auto header = [](const std::string& vertex, const std::string& face) {
    return "ply\nformat ascii 1.0\ncomment made by hand\nobj_info num_cols 2\nelement vertex 4\n" +
           vertex + face + "end_header\n";
  };
  const std::string xyz = "property float32 x\nproperty float64 y\nproperty double z\n";
  const std::string quad = "4 0 1 2 3\n";
  // Names of types and of the list; lists of other kinds beside it.
  for (const std::string list :
       {"property list uint8 int32 vertex_index\n", "property list int8 uint32 vertex_indices\n",
        "property list float int vertex_indices\n", "property list uchar uint corners\n"}) {
    EXPECT_EQ(read(header(xyz, "element face 1\n" + list) + rows + quad).TriangleCount(), 2u)
        << list;
  }
  EXPECT_EQ(
      read(header(xyz, "element face 1\nproperty int flags\nproperty list uchar float weights\n"
                       "property list uchar int vertex_indices\n") +
           rows + "7 2 0.5 0.5 4 0 1 2 3\n")
          .TriangleCount(),
      2u);
  // Elements that nobody knows, between and behind.
  EXPECT_EQ(
      read(header(xyz, "element camera 1\nproperty float view_px\nelement face 1\nproperty list "
                       "uchar int vertex_indices\nelement material 1\nproperty uchar red\n") +
           rows + "3.5\n" + quad + "9\n")
          .TriangleCount(),
      2u);
  // Lines that end in CR LF or CR, and numbers as programs write them.
  std::string text = header(xyz, "element face 1\nproperty list uchar int vertex_indices\n") +
                     "+0 0.0e0 -0\n1e0 0 1e-400\n1.0E+00 1. 0\n0 1 0\n4 0 1 2.0 3\n";
  const std::vector<float> unit = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string changed;
    for (const char c : text) {
      changed += c == '\n' ? end : std::string(1, c);
    }
    EXPECT_EQ(read(changed).meshes.at(0).positions, unit);
  }
  // Colours in each type, and of faces.
  const std::string colors =
      "property TYPE diffuse_red\nproperty TYPE diffuse_green\nproperty TYPE "
      "diffuse_blue\n";
  for (const auto& [type, full] :
       {std::pair("uchar", "255"), std::pair("float", "1"), std::pair("ushort", "65535")}) {
    std::string properties = colors;
    for (std::size_t at; (at = properties.find("TYPE")) != std::string::npos;) {
      properties.replace(at, 4, type);
    }
    std::string colored;
    for (const char* row : {"0 0 0 ", "1 0 0 ", "1 1 0 ", "0 1 0 "}) {
      colored += row + std::string(full) + " 0 0\n";
    }
    const Model model = read(header(xyz + properties, "element face 1\nproperty list uchar int "
                                                      "vertex_indices\n") +
                             colored + quad);
    EXPECT_EQ(model.meshes.at(0).colors[0], 255) << type;
    EXPECT_EQ(model.meshes.at(0).colors[1], 0) << type;
  }
  const Model faces =
      read(header(xyz, "element face 2\nproperty list uchar int vertex_indices\nproperty "
                       "uchar red\nproperty uchar green\nproperty uchar blue\n") +
           rows + "3 0 1 2 255 0 0\n3 0 2 3 0 0 255\n");
  const Mesh& each = faces.meshes.at(0);
  ASSERT_EQ(each.colors.size(), 24u); // six corners
  EXPECT_EQ(each.colors[0], 255);
  EXPECT_EQ(each.colors[12], 0);
  EXPECT_EQ(each.colors[14], 255);
  // Points that a sensor did not see are not numbers.
  const Model cloud = read(header(xyz, "") + "0 0 0\nnan nan nan\n1.#QNAN 0 0\n0 1 0\n", true);
  EXPECT_EQ(cloud.meshes.at(0).PrimitiveCount(), 2u);
  EXPECT_EQ(cloud.warnings.size(), 1u);
}

TEST(ImportPly, TexturesOfMeshLab) {
  const TempFolder folder;
  folder.Write("four colors.png", testing::DecodeBase64(testing::FourColorsPng));
  const Model model = ReadModel(folder.Write(
      "t.ply",
      "ply\nformat ascii 1.0\ncomment TextureFile four colors.png\nelement vertex 3\nproperty "
      "float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int "
      "vertex_indices\nproperty list uchar float texcoord\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 "
      "2 "
      "6 0 0 0.5 0 0 0.25\n"));
  const Mesh& mesh = model.meshes.at(0);
  EXPECT_EQ(mesh.tcoords, (std::vector<float>{0, 0, 0.5, 0, 0, 0.25}));
  ASSERT_EQ(mesh.material, 0);
  ASSERT_TRUE(model.materials[0].texture);
  EXPECT_EQ(model.materials[0].texture->width, 2);
}

} // namespace dspace
