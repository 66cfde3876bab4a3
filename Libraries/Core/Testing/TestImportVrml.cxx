// ReadModel on VRML: hand-made files whose geometry is known, and real ones.
#include "ImportTestSupport.h"
#include "TestData.h"

#include <zlib.h>

namespace dspace {

namespace {

using testing::ExpectReadError;
using testing::HasWarning;
using testing::TempFolder;

const std::string Head2 = "#VRML V2.0 utf8\n";
const std::string Head1 = "#VRML V1.0 ascii\n";

Model Read(const TempFolder& folder, const std::string& text) {
  return ReadModel(folder.Write("test.wrl", text));
}

// A right triangle in the plane z = 0 as a geometry node, with more fields.
std::string Triangle(const std::string& fields = "") {
  return "IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } coordIndex [ 0 1 2 "
         "-1 ] " +
         fields + " }";
}

std::string Shape(const std::string& geometry, const std::string& appearance = "") {
  return "Shape { geometry " + geometry + " " + appearance + " }\n";
}

Eigen::Vector3d Position(const Mesh& mesh, std::size_t vertex) {
  return Eigen::Map<const Eigen::Vector3f>(&mesh.positions[3 * vertex]).cast<double>();
}

Eigen::Vector3d Normal(const Mesh& mesh, std::size_t vertex) {
  return Eigen::Map<const Eigen::Vector3f>(&mesh.normals[3 * vertex]).cast<double>();
}

std::array<int, 4> Color(const Mesh& mesh, std::size_t vertex) {
  const std::uint8_t* c = &mesh.colors[4 * vertex];
  return {c[0], c[1], c[2], c[3]};
}

// Volume inside a closed mesh whose faces look outward (divergence theorem).
double Volume(const Mesh& mesh) {
  double volume = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    volume +=
        Position(mesh, mesh.indices[i])
            .dot(Position(mesh, mesh.indices[i + 1]).cross(Position(mesh, mesh.indices[i + 2])));
  }
  return volume / 6.0;
}

// Every normal looks to the side from which its triangle runs counter-clockwise.
void ExpectNormalsAgree(const Mesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const std::uint32_t* t = &mesh.indices[i];
    const Eigen::Vector3d area = (Position(mesh, t[1]) - Position(mesh, t[0]))
                                     .cross(Position(mesh, t[2]) - Position(mesh, t[0]));
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(area.dot(Normal(mesh, t[k])), 0.0) << "triangle " << i / 3;
      EXPECT_NEAR(Normal(mesh, t[k]).norm(), 1.0, 1e-6);
    }
  }
}

const Mesh& Only(const Model& model) {
  EXPECT_EQ(model.meshes.size(), 1u);
  return model.meshes.at(0);
}

const Material& MaterialOf(const Model& model, std::size_t mesh = 0) {
  return model.materials.at(static_cast<std::size_t>(model.meshes.at(mesh).material));
}

std::string Gzip(const std::string& text) {
  z_stream stream = {};
  deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

} // namespace

// ---- transforms -------------------------------------------------------------------------------

TEST(ImportVrml, TransformWithCentreAndScaleOrientation) {
  const TempFolder folder;
  const Model model = Read(folder, Head2 + R"(
    Transform { translation 1 2 3 center 4 5 6 rotation 0 0 1 0.7 scale 2 3 4
                scaleOrientation 1 0 0 0.4 children )" +
                                       Shape(Triangle()) + "}");
  // T * C * R * SR * S * -SR * -C with plain matrices, one factor after the other.
  const auto move = [](double x, double y, double z) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topRightCorner<3, 1>() << x, y, z;
    return m;
  };
  const auto aboutZ = [](double a) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.topLeftCorner<2, 2>() << std::cos(a), -std::sin(a), std::sin(a), std::cos(a);
    return m;
  };
  const auto aboutX = [](double a) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
    m.block<2, 2>(1, 1) << std::cos(a), -std::sin(a), std::sin(a), std::cos(a);
    return m;
  };
  Eigen::Matrix4d scale = Eigen::Matrix4d::Identity();
  scale.diagonal() << 2, 3, 4, 1;
  const Eigen::Matrix4d expected = move(1, 2, 3) * move(4, 5, 6) * aboutZ(0.7) * aboutX(0.4) *
                                   scale * aboutX(-0.4) * move(-4, -5, -6);
  ASSERT_EQ(model.nodes.size(), 2u);
  ASSERT_EQ(model.nodes[1].meshes.size(), 1u);
  // Coin keeps rotations as float quaternions: 1e-7 of lengths of about 20.
  EXPECT_LT((model.NodeToModel(1).matrix() - expected).cwiseAbs().maxCoeff(), 5e-6);
}

TEST(ImportVrml, TransformsNestAndUseSharesMeshes) {
  const TempFolder folder;
  const Model model = Read(folder, Head2 + R"(
    DEF Arm Transform { translation 1 0 0 children DEF Hand )" +
                                       Shape(Triangle()) + R"(}
    DEF Far Transform { translation 0 10 0 scale 2 2 2 children [ USE Arm USE Hand ] })");
  EXPECT_EQ(model.meshes.size(), 1u); // three instances of one mesh
  EXPECT_EQ(model.meshes[0].name, "Hand");
  EXPECT_EQ(model.TriangleCount(), 3u);
  ASSERT_EQ(model.nodes.size(), 4u);
  EXPECT_EQ(model.nodes[1].name, "Arm");
  EXPECT_EQ(model.nodes[2].name, "Far");
  EXPECT_EQ(model.nodes[3].name, "Arm");
  EXPECT_EQ(model.nodes[3].parent, 2);
  EXPECT_TRUE(
      (model.NodeToModel(3) * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(4, 10, 0)));
  EXPECT_EQ(model.Bounds().min(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(model.Bounds().max(), Eigen::Vector3d(4, 12, 0));
}

TEST(ImportVrml, RotationOfNoAxisTurnsNothing) {
  const TempFolder folder;
  const Model model =
      Read(folder, Head2 + "Transform { rotation 0 0 0 1 children " + Shape(Triangle()) + "}");
  EXPECT_EQ(model.Bounds().max(), Eigen::Vector3d(1, 1, 0));
}

// ---- faces ------------------------------------------------------------------------------------

TEST(ImportVrml, FlatNormalsWithoutCreaseAngleSmoothWithIt) {
  const TempFolder folder;
  // Two squares that meet at a right angle along the Y axis.
  const std::string roof =
      "IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 1 1 0, 0 1 0, 0 0 1, 0 1 1 ] } "
      "coordIndex [ 0 1 2 3 -1 0 3 5 4 -1 ] ";
  const Mesh flat = Only(Read(folder, Head2 + Shape(roof + "}")));
  EXPECT_EQ(flat.PrimitiveCount(), 4u);
  EXPECT_EQ(flat.VertexCount(), 8u); // each face has corners of its own
  ExpectNormalsAgree(flat);
  const Mesh sharp = Only(Read(folder, Head2 + Shape(roof + "creaseAngle 1.5 }")));
  EXPECT_EQ(sharp.normals, flat.normals); // 1.5 is less than the right angle
  const Mesh smooth = Only(Read(folder, Head2 + Shape(roof + "creaseAngle 1.6 }")));
  EXPECT_EQ(smooth.VertexCount(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const bool edge = Position(smooth, i).x() == 0 && Position(smooth, i).z() == 0;
    const Eigen::Vector3d n = Normal(smooth, i);
    EXPECT_NEAR(n.x(), edge ? std::sqrt(0.5) : (Position(smooth, i).z() == 1 ? 1.0 : 0.0), 1e-6);
    EXPECT_NEAR(n.z(), edge ? std::sqrt(0.5) : (Position(smooth, i).x() == 1 ? 1.0 : 0.0), 1e-6);
  }
}

TEST(ImportVrml, ClockwiseFacesAreTurned) {
  const TempFolder folder;
  const Mesh ccw = Only(Read(folder, Head2 + Shape(Triangle())));
  ExpectNormalsAgree(ccw);
  EXPECT_EQ(Normal(ccw, 0), Eigen::Vector3d(0, 0, 1));
  const Mesh cw = Only(Read(folder, Head2 + Shape(Triangle("ccw FALSE"))));
  ExpectNormalsAgree(cw);
  EXPECT_EQ(Normal(cw, 0), Eigen::Vector3d(0, 0, -1));
}

TEST(ImportVrml, ConcaveFaces) {
  const TempFolder folder;
  const std::string arrow =
      "IndexedFaceSet { coord Coordinate { point [ 2 2 0, 0 4 0, 1 2 0, 0 0 0 ] } "
      "coordIndex [ 1 2 3 0 ] ";
  const Mesh mesh = Only(Read(folder, Head2 + Shape(arrow + "convex FALSE }")));
  ASSERT_EQ(mesh.PrimitiveCount(), 2u);
  ExpectNormalsAgree(mesh); // no triangle is turned over
  double area = 0.0;
  for (std::size_t i = 0; i < 6; i += 3) {
    area += 0.5 * (Position(mesh, mesh.indices[i + 1]) - Position(mesh, mesh.indices[i]))
                      .cross(Position(mesh, mesh.indices[i + 2]) - Position(mesh, mesh.indices[i]))
                      .norm();
  }
  EXPECT_NEAR(area, 2.0, 1e-6);
}

TEST(ImportVrml, NormalsPerVertexAndPerFaceIndexed) {
  const TempFolder folder;
  const std::string normals = "normal Normal { vector [ 1 0 0, 0 2 0, 0 0 3 ] } ";
  const Mesh perVertex = Only(Read(folder, Head2 + Shape(Triangle(normals))));
  ASSERT_EQ(perVertex.VertexCount(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(Normal(perVertex, static_cast<std::size_t>(i)), Eigen::Vector3d::Unit(i));
  }
  const Mesh indexed =
      Only(Read(folder, Head2 + Shape(Triangle(normals + "normalIndex [ 2 2 0 -1 ]"))));
  EXPECT_EQ(Normal(indexed, 0), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(Normal(indexed, 2), Eigen::Vector3d(1, 0, 0));
  const Mesh perFace = Only(
      Read(folder, Head2 + Shape(Triangle(normals + "normalPerVertex FALSE normalIndex [ 1 ]"))));
  EXPECT_EQ(Normal(perFace, 2), Eigen::Vector3d(0, 1, 0));
}

TEST(ImportVrml, ColorsOfAllBindings) {
  const TempFolder folder;
  const std::array<int, 4> red = {255, 0, 0, 255};
  const std::array<int, 4> green = {0, 255, 0, 255};
  const std::array<int, 4> blue = {0, 0, 255, 255};
  // Two triangles side by side.
  const auto read = [&folder](const std::string& fields) {
    return Read(folder, Head2 + Shape("IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, "
                                      "0 1 0, 1 1 0 ] } coordIndex [ 0 1 2 -1 1 3 2 -1 ] color "
                                      "Color { color [ 1 0 0, 0 1 0, 0 0 1, 1 1 1 ] } " +
                                          fields + "}",
                                      "appearance Appearance { material Material { diffuseColor "
                                      "0.5 0.5 0.5 } }"));
  };
  const auto colorsOf = [](const Model& model) {
    std::vector<std::array<int, 4>> colors;
    for (const std::uint32_t i : model.meshes.at(0).indices) {
      colors.push_back(Color(model.meshes[0], i));
    }
    return colors;
  };
  const Model perVertex = read("");
  EXPECT_EQ(colorsOf(perVertex)[0], red);
  EXPECT_EQ(colorsOf(perVertex)[1], green);
  EXPECT_EQ(colorsOf(perVertex)[2], blue);
  // They replace the diffuse colour (VRML97 4.14), so the material is white.
  EXPECT_EQ(MaterialOf(perVertex).color, (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(colorsOf(read("colorIndex [ 2 2 2 -1 1 1 0 -1 ]")),
            (std::vector<std::array<int, 4>>{blue, blue, blue, green, green, red}));
  EXPECT_EQ(colorsOf(read("colorPerVertex FALSE")),
            (std::vector<std::array<int, 4>>{red, red, red, green, green, green}));
  EXPECT_EQ(colorsOf(read("colorPerVertex FALSE colorIndex [ 2 0 ]")),
            (std::vector<std::array<int, 4>>{blue, blue, blue, red, red, red}));
}

TEST(ImportVrml, ShortNodesAndBadIndicesAreRepaired) {
  const TempFolder folder;
  // One colour with colorPerVertex FALSE, as in real files: it goes for all faces.
  const Model one =
      Read(folder, Head2 + Shape("IndexedFaceSet { coord Coordinate { point [ 0 0 0, "
                                 "1 0 0, 0 1 0 ] } coordIndex [ 0 1 2 -1 2 1 0 -1 ] "
                                 "colorPerVertex FALSE color Color { color 0 1 0 } }"));
  EXPECT_EQ(Color(Only(one), one.meshes[0].indices[5]), (std::array<int, 4>{0, 255, 0, 255}));
  EXPECT_TRUE(HasWarning(one.warnings, "3 corners have no colour among 1 colours"));
  // Too few normals: made from the face.
  const Model normals = Read(folder, Head2 + Shape(Triangle("normal Normal { vector 1 0 0 }")));
  EXPECT_EQ(Normal(Only(normals), 2), Eigen::Vector3d(0, 0, 1));
  EXPECT_TRUE(HasWarning(normals.warnings, "corners have no normal among 1 normals"));
  const Model bad = Read(folder, Head2 + Shape("IndexedFaceSet { coord Coordinate { point [ 0 0 0, "
                                               "1 0 0, 0 1 0 ] } coordIndex [ 0 1 3 -1 0 1 2 -1 0 "
                                               "-2 1 -1 0 1 -1 2147483647 0 1 ] }"));
  EXPECT_EQ(bad.TriangleCount(), 1u);
  EXPECT_TRUE(HasWarning(bad.warnings, "3 faces with an index out of range of 3 points"));
  EXPECT_TRUE(HasWarning(bad.warnings, "1 faces with fewer than 3 corners"));
}

// ---- appearance -------------------------------------------------------------------------------

TEST(ImportVrml, MaterialsKeepTheirValues) {
  const TempFolder folder;
  const Model model = Read(
      folder, Head2 +
                  Shape(Triangle("solid FALSE"),
                        "appearance Appearance { material DEF Paint Material { diffuseColor "
                        "0.25 0.5 0.75 emissiveColor 0.125 0 0 transparency 0.25 shininess 1 } }") +
                  Shape(Triangle()));
  ASSERT_EQ(model.materials.size(), 2u);
  const Material& paint = MaterialOf(model, 0);
  EXPECT_EQ(paint.name, "Paint");
  EXPECT_EQ(paint.color, (std::array<double, 3>{0.25, 0.5, 0.75})); // exact in binary
  EXPECT_EQ(paint.emissive, (std::array<double, 3>{0.125, 0, 0}));
  EXPECT_EQ(paint.opacity, 0.75);
  EXPECT_NEAR(paint.roughness, std::sqrt(2.0 / 130.0), 1e-12); // Phong's exponent 128
  EXPECT_TRUE(paint.lit);
  EXPECT_TRUE(paint.doubleSided);
  const Material& none = MaterialOf(model, 1); // VRML97: unlit and white
  EXPECT_FALSE(none.lit);
  EXPECT_EQ(none.color, (std::array<double, 3>{1, 1, 1}));
  EXPECT_FALSE(none.doubleSided);
}

TEST(ImportVrml, Textures) {
  const TempFolder folder;
  folder.Write("maps/four.png", testing::DecodeBase64(testing::FourColorsPng));
  const std::string corners = "texCoord TextureCoordinate { point [ 0 0, 1 0, 0 1 ] }";
  const Model model =
      Read(folder, Head2 + Shape(Triangle(corners),
                                 "appearance Appearance { material Material { } texture "
                                 "ImageTexture { url [ \"absent.png\" \"maps/four.png\" ] "
                                 "repeatS FALSE } textureTransform TextureTransform { "
                                 "translation 0.5 0.25 scale 2 4 } }"));
  ASSERT_TRUE(MaterialOf(model).texture);
  EXPECT_EQ(MaterialOf(model).texture->width, 2);
  EXPECT_FALSE(MaterialOf(model).repeatTexture);
  // A texture with colours of its own replaces the diffuse colour.
  EXPECT_EQ(MaterialOf(model).color, (std::array<double, 3>{1, 1, 1}));
  const Mesh& mesh = Only(model);
  for (std::size_t i = 0; i < 3; ++i) { // first moved, then scaled
    EXPECT_FLOAT_EQ(mesh.tcoords[2 * i], 2.0f * (mesh.positions[3 * i] + 0.5f));
    EXPECT_FLOAT_EQ(mesh.tcoords[2 * i + 1], 4.0f * (mesh.positions[3 * i + 1] + 0.25f));
  }

  // The first pixel of a PixelTexture is at the lower left.
  const Model pixels =
      Read(folder, Head2 + Shape(Triangle(), "appearance Appearance { texture PixelTexture { image "
                                             "1 2 3 0xFF0000 0x0000FF } }"));
  ASSERT_TRUE(MaterialOf(pixels).texture);
  EXPECT_EQ(MaterialOf(pixels).texture->pixels, (std::vector<std::uint8_t>{0, 0, 255, 255, 0, 0}));
  // Without texture coordinates they come from the bounds.
  EXPECT_EQ(Only(pixels).tcoords, (std::vector<float>{0, 0, 1, 0, 0, 1}));

  const Model absent =
      Read(folder, Head2 + Shape(Triangle(), "appearance Appearance { texture ImageTexture { url "
                                             "\"gone.png\" } }"));
  EXPECT_FALSE(MaterialOf(absent).texture);
  EXPECT_TRUE(HasWarning(absent.warnings, "gone.png"));
  ImportOptions strict;
  strict.strict = true;
  ExpectReadError(Error::Kind::Corrupt, "gone.png", folder / "test.wrl", strict);
}

// ---- solids, grids, lines ---------------------------------------------------------------------

TEST(ImportVrml, Primitives) {
  const TempFolder folder;
  const auto only = [&folder](const std::string& node) {
    const Mesh mesh = Only(Read(folder, Head2 + Shape(node)));
    ExpectNormalsAgree(mesh);
    EXPECT_EQ(mesh.tcoords.size(), 2 * mesh.VertexCount());
    return mesh;
  };
  const double polygon = 16.0 * std::sin(M_PI / 16.0); // area of the 32-gon of radius 1
  EXPECT_NEAR(Volume(only("Box { size 2 3 4 }")), 24.0, 1e-5);
  EXPECT_NEAR(Volume(only("Cylinder { radius 2 height 3 }")), polygon * 4 * 3, 1e-4);
  EXPECT_NEAR(Volume(only("Cone { bottomRadius 2 height 3 }")), polygon * 4 * 3 / 3, 1e-4);
  const Mesh sphere = only("Sphere { radius 2 }");
  EXPECT_NEAR(Volume(sphere), 4.0 / 3.0 * M_PI * 8.0, 0.03 * 4.0 / 3.0 * M_PI * 8.0);
  for (std::size_t i = 0; i < sphere.VertexCount(); ++i) {
    EXPECT_NEAR(Position(sphere, i).norm(), 2.0, 1e-6);
  }
  EXPECT_EQ(only("Cylinder { side FALSE bottom FALSE }").PrimitiveCount(), 30u);
  // A cone's tip is up; a texture's middle is in front (+Z), its left edge at the back.
  const Mesh cone = only("Cone { bottom FALSE }");
  for (std::size_t i = 0; i < cone.VertexCount(); ++i) {
    const Eigen::Vector3d p = Position(cone, i);
    EXPECT_NEAR(std::hypot(p.x(), p.z()), p.y() > 0 ? 0.0 : 1.0, 1e-6);
    if (cone.tcoords[2 * i] == 0.5f) {
      EXPECT_NEAR(p.z(), 1.0, 1e-6);
    }
  }
  const Model bad = Read(folder, Head2 + Shape("Sphere { radius -1 }") + Shape("Box { }"));
  EXPECT_EQ(bad.TriangleCount(), 12u);
  EXPECT_TRUE(HasWarning(bad.warnings, "not positive"));
}

TEST(ImportVrml, ElevationGridTakesItsColoursFromTheField) {
  const TempFolder folder;
  const Model model =
      Read(folder,
           Head2 + Shape("ElevationGrid { xDimension 3 zDimension 2 xSpacing 2 zSpacing 5 height "
                         "[ 0 1 2 0 1 2 ] colorPerVertex FALSE color Color { color [ 1 0 0, 0 0 "
                         "1 ] } }"));
  const Mesh& mesh = Only(model);
  EXPECT_EQ(mesh.PrimitiveCount(), 4u);
  ExpectNormalsAgree(mesh);
  EXPECT_EQ(model.Bounds().max(), Eigen::Vector3d(4, 2, 5));
  for (std::size_t i = 0; i < mesh.VertexCount(); ++i) {
    EXPECT_TRUE(Normal(mesh, i).isApprox(Eigen::Vector3d(-1, 2, 0).normalized(), 1e-6));
    EXPECT_FLOAT_EQ(mesh.positions[3 * i + 1], mesh.positions[3 * i] / 2); // height of the slope
    EXPECT_FLOAT_EQ(mesh.tcoords[2 * i], mesh.positions[3 * i] / 4);
  }
  EXPECT_EQ(Color(mesh, mesh.indices[0]), (std::array<int, 4>{255, 0, 0, 255}));
  EXPECT_EQ(Color(mesh, mesh.indices[6]), (std::array<int, 4>{0, 0, 255, 255}));
  const Model bad = Read(folder, Head2 +
                                     Shape("ElevationGrid { xDimension 65536 zDimension 65536 "
                                           "height [ 0 0 0 0 ] }") +
                                     Shape("Box { }"));
  EXPECT_TRUE(HasWarning(bad.warnings, "65536 x 65536 with 4 heights"));
}

TEST(ImportVrml, Extrusions) {
  const TempFolder folder;
  // The default: a square prism along +Y.
  const Model prism = Read(folder, Head2 + Shape("Extrusion { spine [ 0 0 0, 0 3 0 ] }"));
  ExpectNormalsAgree(Only(prism));
  EXPECT_NEAR(Volume(Only(prism)), 2 * 2 * 3, 1e-5);
  EXPECT_EQ(prism.TriangleCount(), 8u + 4u);
  EXPECT_TRUE(prism.Bounds().min().isApprox(Eigen::Vector3d(-1, 0, -1)));
  // Along +X the section's X turns to -Y, and a scale of one half makes a frustum of a pyramid.
  const Model taper =
      Read(folder, Head2 + Shape("Extrusion { spine [ 0 0 0, 3 0 0 ] scale [ 2 1, 1 0.5 ] }"));
  EXPECT_NEAR(Volume(Only(taper)), 3.0 / 3.0 * (8 + 2 + std::sqrt(16.0)), 1e-4);
  EXPECT_TRUE(taper.Bounds().max().isApprox(Eigen::Vector3d(3, 2, 1), 1e-6));
  // A quarter turn at a mitred corner: two arms of length 3, section 2 x 2. Its middle plane is the
  // bisector, where the section keeps its width along the plane, so each arm thins to sqrt(1/2).
  const Model corner =
      Read(folder, Head2 + Shape("Extrusion { spine [ 0 0 0, 0 3 0, 3 3 0 ] convex FALSE }"));
  ExpectNormalsAgree(Only(corner));
  EXPECT_TRUE(corner.Bounds().max().isApprox(Eigen::Vector3d(3, 4, 1), 1e-5))
      << corner.Bounds().max().transpose();
  // Turned sections: a half turn of the square is the square again, an eighth is not.
  const Model turned = Read(
      folder, Head2 + Shape("Extrusion { spine [ 0 0 0, 0 3 0 ] orientation 0 1 0 0.78539816 }"));
  EXPECT_NEAR(turned.Bounds().max().x(), std::sqrt(2.0), 1e-6);
  const Model bad = Read(folder, Head2 + Shape("Extrusion { spine [ 0 0 0 ] }") + Shape("Box { }"));
  EXPECT_TRUE(HasWarning(bad.warnings, "an Extrusion of 1 spine points"));
}

TEST(ImportVrml, LinesAndPoints) {
  const TempFolder folder;
  const std::string data =
      "coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0, 0 0 1 ] } color Color { "
      "color [ 1 0 0, 0 1 0, 0 0 1, 1 1 1 ] } ";
  const Model lines = Read(
      folder, Head2 + Shape("IndexedLineSet { " + data + "coordIndex [ 0 1 2 -1 2 3 ] }") +
                  Shape("IndexedLineSet { " + data +
                        "coordIndex [ 0 1 2 -1 2 3 ] colorPerVertex FALSE colorIndex [ 2 1 ] }"));
  ASSERT_EQ(lines.meshes.size(), 2u);
  EXPECT_EQ(lines.meshes[0].primitive, Mesh::Primitive::Lines);
  EXPECT_EQ(lines.meshes[0].indices, (std::vector<std::uint32_t>{0, 1, 1, 2, 2, 3}));
  EXPECT_EQ(Color(lines.meshes[0], 1), (std::array<int, 4>{0, 255, 0, 255}));
  EXPECT_EQ(Color(lines.meshes[1], lines.meshes[1].indices[0]),
            (std::array<int, 4>{0, 0, 255, 255}));
  EXPECT_FALSE(MaterialOf(lines).lit);
  const std::string file = folder.Write(
      "points.wrl",
      Head2 + Shape("PointSet { " + data + "}") +
          Shape("PointSet { coord Coordinate { point 5 5 5 } }",
                "appearance Appearance { material Material { emissiveColor 1 0.5 0 } }"));
  ExpectReadError(Error::Kind::Corrupt, "has 5 vertices and no faces", file);
  ImportOptions cloud;
  cloud.pointCloud = true;
  const Model points = ReadModel(file, cloud);
  EXPECT_EQ(points.meshes.at(0).PrimitiveCount(), 4u);
  EXPECT_EQ(points.meshes.at(1).primitive, Mesh::Primitive::Points);
  EXPECT_EQ(MaterialOf(points, 1).color, (std::array<double, 3>{1, 0.5, 0}));
}

TEST(ImportVrml, ManyWarningsOfAKindAreOne) {
  const TempFolder folder;
  const auto read = [&folder](int textures) {
    std::string text = Head2;
    for (int i = 0; i < textures; ++i) {
      const std::string name = "t" + std::to_string(i) + ".png";
      text += Shape(Triangle(),
                    "appearance Appearance { texture ImageTexture { url \"" + name + "\" } }");
    }
    text += "Inline { url \"nowhere.wrl\" }";
    return Read(folder, text).warnings;
  };
  const std::vector<std::string> few = read(3);
  ASSERT_EQ(few.size(), 4u);
  EXPECT_TRUE(HasWarning(few, "texture 't2.png' is left out: "));
  const std::vector<std::string> many = read(4);
  ASSERT_EQ(many.size(), 2u);
  EXPECT_EQ(many[0].find("4 textures are left out: 't0.png', 't1.png', 't2.png', ..."), 0u)
      << many[0];
  EXPECT_NE(many[0].find("t0.png': does not exist"), std::string::npos) << many[0];
  EXPECT_NE(many[1].find("Inline of 'nowhere.wrl' is left out"), std::string::npos) << many[1];
  // Shapes whose flaws differ in numbers only.
  std::string shapes = Head2;
  for (int i = 0; i < 5; ++i) {
    std::string bad;
    for (int k = 0; k <= i; ++k) {
      bad += "0 1 " + std::to_string(7 + k) + " -1 ";
    }
    shapes += "DEF S" + std::to_string(i) + " " +
              Shape("IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 0 ] } "
                    "coordIndex [ 0 1 2 -1 " +
                    bad + "] }");
  }
  const std::vector<std::string> flaws = Read(folder, shapes).warnings;
  ASSERT_EQ(flaws.size(), 1u);
  EXPECT_EQ(flaws[0].find("5 shapes: N faces with an index out of range of N points"), 0u)
      << flaws[0];
  EXPECT_NE(flaws[0].find("shape 'S2', ..."), std::string::npos) << flaws[0];
}

// ---- grouping, PROTO, Inline ------------------------------------------------------------------

TEST(ImportVrml, SwitchAndLodShowOneChild) {
  const TempFolder folder;
  const auto boxAt = [](int x) {
    return "Transform { translation " + std::to_string(x) +
           " 0 0 children Shape { geometry Box { } } } ";
  };
  const Model model = Read(
      folder, Head2 + "Switch { whichChoice 1 choice [ " + boxAt(100) + boxAt(10) +
                  "] } Switch { choice [ " + boxAt(200) + "] } Switch { whichChoice 7 choice [ " +
                  boxAt(300) + "] } LOD { range [ 5 ] level [ " + boxAt(20) + boxAt(400) + "] }");
  EXPECT_EQ(model.TriangleCount(), 24u);
  EXPECT_EQ(model.Bounds().min().x(), 9.0);
  EXPECT_EQ(model.Bounds().max().x(), 21.0);
}

TEST(ImportVrml, Prototypes) {
  const TempFolder folder;
  const Model model = Read(folder, Head2 + R"(
    PROTO Part [ field SFVec3f where 0 0 0 exposedField SFColor tint 1 0 0 field MFNode more [ ]
                 eventIn SFBool ignored ] {
      Transform { translation IS where children [
        Shape { appearance Appearance { material Material { diffuseColor IS tint } }
                geometry Box { } }
        Group { children IS more } ] }
      Viewpoint { }
    }
    PROTO Pair [ field SFVec3f second 0 50 0 ] { Group { children [ Part { } Part { where IS second } ] } }
    Part { where 10 0 0 tint 0 1 0 more Shape { geometry Sphere { } } }
    Pair { second 0 70 0 }
    EXTERNPROTO Other [ field SFInt32 a ] "other.wrl"
    Other { a 1 })");
  EXPECT_EQ(model.TriangleCount(), 3u * 12u + 960u);
  EXPECT_EQ(model.Bounds().max(), Eigen::Vector3d(11, 71, 1));
  EXPECT_EQ(MaterialOf(model, 0).color, (std::array<double, 3>{0, 1, 0}));
  EXPECT_EQ(MaterialOf(model, 2).color, (std::array<double, 3>{1, 0, 0})); // the default
  EXPECT_TRUE(HasWarning(model.warnings, "external PROTO 'Other' is not read"));
}

TEST(ImportVrml, InlinedFiles) {
  const TempFolder folder;
  folder.Write("parts/box.wrl",
               Head2 + "DEF Box " + Shape("Box { }") + "Inline { url \"deep.wrl\" }");
  folder.Write("parts/deep.wrl",
               Gzip(Head1 + "Separator { Translation { translation 0 0 9 } Cube { } }"));
  const Model model = Read(folder, Head2 + R"(
    Inline { url [ "absent.wrl" "parts/box.wrl" ] }
    Transform { translation 5 0 0 children Inline { url "parts/box.wrl" } }
    Inline { url "nowhere.wrl" })");
  EXPECT_EQ(model.TriangleCount(), 4u * 12u);
  EXPECT_EQ(model.meshes.size(), 2u); // a file is read once
  EXPECT_EQ(model.Bounds().max(), Eigen::Vector3d(6, 1, 10));
  EXPECT_TRUE(HasWarning(model.warnings, "Inline of 'nowhere.wrl' is left out"));

  folder.Write("a.wrl", Head2 + "Group { children Inline { url \"b.wrl\" } }" + Shape("Box { }"));
  folder.Write("b.wrl", Head2 + "Inline { url \"./a.wrl\" }");
  ExpectReadError(Error::Kind::Corrupt, "circle of files", folder / "a.wrl");
  folder.Write("own.wrl", Head2 + "Inline { url \"own.wrl\" }");
  ExpectReadError(Error::Kind::Corrupt, "circle of files", folder / "own.wrl");
  const Model damaged = Read(folder, Head2 + Shape("Box { }") + "Inline { url \"broken.wrl\" }" +
                                         "Inline { url \"/etc/passwd\" }");
  EXPECT_TRUE(HasWarning(damaged.warnings, "broken.wrl"));
  EXPECT_TRUE(HasWarning(damaged.warnings, "/etc/passwd"));
}

// ---- VRML 1.0 ---------------------------------------------------------------------------------

TEST(ImportVrml, Vrml1StateAndSeparators) {
  const TempFolder folder;
  const Model model = Read(folder, Head1 + R"(Separator {
    Material { diffuseColor [ 1 0 0, 0 1 0 ] }
    Separator { Translation { translation 5 0 0 } Rotation { rotation 0 0 1 1.5707963 } Cube { width 4 } }
    TransformSeparator { Scale { scaleFactor 3 3 3 } Material { diffuseColor 0 0 1 } Sphere { } }
    Cylinder { parts (SIDES | TOP) height 1 }
    Switch { whichChild 1 Cone { } Cube { width 0.5 height 0.5 depth 0.5 } }
    Separator { MatrixTransform { matrix 1 0 0 0 0 1 0 0 0 0 1 0 0 0 30 1 } Cube { } }
    AsciiText { string "hello" }
    Extension { fields [ SFLong a ] a 1 }
  })");
  EXPECT_EQ(model.TriangleCount(), 12u + 960u + 94u + 12u + 12u);
  EXPECT_EQ(model.Bounds().max().z(), 31.0);
  EXPECT_NEAR(model.Bounds().max().x(), 6.0, 1e-6); // the cube lies on its side
  EXPECT_EQ(MaterialOf(model, 0).color, (std::array<double, 3>{1, 0, 0}));
  EXPECT_EQ(MaterialOf(model, 1).color, (std::array<double, 3>{0, 0, 1}));
  EXPECT_EQ(MaterialOf(model, 2).color,
            (std::array<double, 3>{0, 0, 1})); // TransformSeparator leaks it
  EXPECT_EQ(MaterialOf(model, 4).color, (std::array<double, 3>{0, 0, 1}));
  EXPECT_TRUE(HasWarning(model.warnings, "node AsciiText is not read"));
  EXPECT_TRUE(HasWarning(model.warnings, "unknown node Extension"));
}

TEST(ImportVrml, Vrml1Bindings) {
  const TempFolder folder;
  const Model model = Read(folder, Head1 + R"(Separator {
    Coordinate3 { point [ 0 0 0, 1 0 0, 0 1 0, 1 1 0 ] }
    Material { diffuseColor [ 1 0 0, 0 1 0, 0 0 1 ] transparency [ 0, 0.5, 0 ] }
    ShapeHints { vertexOrdering CLOCKWISE shapeType SOLID }
    MaterialBinding { value PER_FACE }
    IndexedFaceSet { coordIndex [ 0 2 1 -1 1 2 3 -1 ] }
    MaterialBinding { value PER_VERTEX_INDEXED }
    Normal { vector [ 0 0 1, 1 0 0 ] }
    NormalBinding { value PER_FACE_INDEXED }
    IndexedFaceSet { coordIndex [ 0 2 1 ] materialIndex [ 2 2 1 ] normalIndex [ 1 ] }
  })");
  ASSERT_EQ(model.meshes.size(), 2u);
  const Mesh& faces = model.meshes[0];
  EXPECT_EQ(Color(faces, faces.indices[0]), (std::array<int, 4>{255, 0, 0, 255}));
  EXPECT_EQ(Color(faces, faces.indices[3]), (std::array<int, 4>{0, 255, 0, 128}));
  EXPECT_EQ(Normal(faces, 0), Eigen::Vector3d(0, 0, 1)); // clockwise corners, seen from +Z
  ExpectNormalsAgree(faces);
  EXPECT_FALSE(MaterialOf(model).doubleSided);
  const Mesh& vertices = model.meshes[1];
  EXPECT_EQ(Color(vertices, 0), (std::array<int, 4>{0, 0, 255, 255}));
  EXPECT_EQ(Color(vertices, 2), (std::array<int, 4>{0, 255, 0, 128}));
  EXPECT_EQ(Normal(vertices, 1), Eigen::Vector3d(1, 0, 0));
}

// ---- bad input --------------------------------------------------------------------------------

TEST(ImportVrml, BadFiles) {
  const TempFolder folder;
  const auto bad = [&folder](Error::Kind kind, const std::string& part, const std::string& text) {
    ExpectReadError(kind, part, folder.Write("bad.wrl", text));
  };
  ExpectReadError(Error::Kind::NotFound, "absent.wrl", folder / "absent.wrl");
  bad(Error::Kind::Corrupt, "is empty", "");
  bad(Error::Kind::Corrupt, "does not begin with", "hello");
  bad(Error::Kind::Unsupported, "'#VRML V3.0 utf8' is not read", "#VRML V3.0 utf8\n");
  bad(Error::Kind::Unsupported, "binary", "#Inventor V2.1 binary\n");
  bad(Error::Kind::Corrupt, "nothing to draw", Head2);
  bad(Error::Kind::Corrupt, "nothing to draw", Head2 + "Group { }");
  bad(Error::Kind::Corrupt, "NUL bytes", Head2 + std::string("Group {\0}", 9));
  const std::string good = Head2 + "\n" + Shape(Triangle());
  for (std::size_t size = good.size() - 3; size > Head2.size() + 7; --size) {
    bad(Error::Kind::Corrupt, "line 3", good.substr(0, size)); // cut anywhere: it says where
  }
  bad(Error::Kind::Corrupt, "gzip stream", Gzip(good).substr(0, 60));
  bad(Error::Kind::Corrupt, "line 2: found 'nan' where a finite number is expected",
      Head2 + "Transform { translation nan 0 0 }");
  bad(Error::Kind::Corrupt, "found '1e39'", Head2 + "Transform { translation 1e39 0 0 }");
  bad(Error::Kind::Corrupt, "found '4294967296' where an integer",
      Head2 + Shape("IndexedFaceSet { coordIndex [ 4294967296 ] }"));
  bad(Error::Kind::Corrupt, "found 'Z' where TRUE or FALSE",
      Head2 + Shape("IndexedFaceSet { solid Z }"));
  bad(Error::Kind::Corrupt, "does not end", Head2 + "WorldInfo { title \"abc }");
}

TEST(ImportVrml, CirclesAndBombsAreRefusedBeforeParsing) {
  const TempFolder folder;
  const auto bad = [&folder](Error::Kind kind, const std::string& part, const std::string& text) {
    ExpectReadError(kind, part, folder.Write("bad.wrl", text));
  };
  bad(Error::Kind::Corrupt, "'A' is used inside itself",
      Head2 + "DEF A Group { children Group { children USE A } }");
  bad(Error::Kind::Corrupt, "'A' is used inside itself", Head1 + "DEF A Separator { USE A }");
  // Ten thousand levels of braces; a chain of USE as deep; thirty doublings by USE and by PROTO.
  std::string braces = Head2;
  for (int i = 0; i < 10000; ++i) {
    braces += "Group { children ";
  }
  bad(Error::Kind::Resource, "nested deeper than 256", braces);
  std::string chain = Head2 + "DEF N0 Group { }\n";
  std::string uses = Head2 + "DEF N0 Group { children " + Shape("Box { }") + "}\n";
  std::string protos = Head2 + "PROTO N0 [ ] { " + Shape("Box { }") + "}\n";
  std::string fields = Head2 + "PROTO N0 [ field MFNode x [ ] ] { Group { children IS x } }\n";
  for (int i = 1; i < 400; ++i) {
    const std::string n = std::to_string(i);
    const std::string b = std::to_string(i - 1);
    chain += "DEF N" + n + " Group { children USE N" + b + " }\n";
    uses += "DEF N" + n + " Group { children [ USE N" + b + " USE N" + b + " ] }\n";
    protos += "PROTO N" + n + " [ ] { Group { children [ N" + b + " { } N" + b + " { } ] } }\n";
    fields += "PROTO N" + n + " [ field MFNode x [ ] ] { Group { children [ N" + b +
              " { x IS x } N" + b + " { x IS x } ] } }\n";
  }
  bad(Error::Kind::Resource, "nested deeper than 256", chain);
  bad(Error::Kind::Resource, "multiply its nodes beyond", uses);
  bad(Error::Kind::Resource, "multiply its nodes beyond", protos);
  bad(Error::Kind::Resource, "", fields + "N399 { x " + Shape("Box { }") + "}");
  // The default of an image field may be unusable.
  const Model image = Read(folder, Head2 + "PROTO P [ field SFImage i 9 9 3 1 ] { Shape { geometry "
                                           "Box { } appearance Appearance { texture PixelTexture { "
                                           "image IS i } } } } P { }");
  EXPECT_TRUE(HasWarning(image.warnings, "9 x 9 x 3 that has 1 pixels"));
  bad(Error::Kind::Corrupt, "no type of a field", Head2 + "PROTO P [ field SFEnum e A ] { }");
  // A PROTO inside its own body is no node at that place.
  const Model own =
      Read(folder, Head2 + "PROTO P [ ] { Group { children [ P { } ] } } P { }" + Shape("Box { }"));
  EXPECT_TRUE(HasWarning(own.warnings, "unknown node P"));
  ImportOptions few;
  few.maximumTriangles = 100;
  ExpectReadError(Error::Kind::Resource, "more than 100 triangles",
                  folder.Write("many.wrl", Head2 + "DEF B " + Shape("Box { }") +
                                               "USE B USE B USE B USE B USE B USE B USE B USE B"),
                  few);
}

TEST(ImportVrml, UnknownThingsAreLeftOutWithAWarning) {
  const TempFolder folder;
  const Model model = Read(folder, Head2 + R"(
    Transform { metadata MetadataString { value "x" } extra 1 2 3 other USE Nothing
                children [ NurbsSurface { order 3 } USE Nowhere )" +
                                       Shape("Box { hasHole TRUE size 1 1 1 }") + R"(] }
    DEF T TimeSensor { loop TRUE } ROUTE T.time TO U.value
    Script { url "javascript: function f() { }" eventIn SFTime x field SFNode y Group { } }
    Shape { geometry Text { string [ "hi" ] } })");
  EXPECT_EQ(model.TriangleCount(), 12u);
  EXPECT_EQ(model.Bounds().max(), Eigen::Vector3d(0.5, 0.5, 0.5));
  for (const char* what : {"unknown field 'metadata' of Transform", "unknown field 'extra'",
                           "unknown node NurbsSurface", "unknown name 'Nowhere'",
                           "unknown field 'hasHole' of Box", "node Text is not read"}) {
    EXPECT_TRUE(HasWarning(model.warnings, what)) << what;
  }
}

// ---- real files -------------------------------------------------------------------------------

TEST(ImportVrml, Rocky7) {
  DSPACE_REAL_DATA(folder, "models/rocky7_vrml");
  const struct {
    const char* name;
    std::size_t triangles;
  } parts[] = {{"Body", 220}, {"Rocker", 356}, {"Bogie", 224}, {"Bracket", 308}, {"Wheel", 3738}};
  for (const auto& part : parts) {
    const Model model = ReadModel(folder + "/Rocky7" + part.name + ".wrl");
    EXPECT_EQ(model.TriangleCount(), part.triangles) << part.name;
    EXPECT_EQ(model.meshes.size(), 1u);
    EXPECT_EQ(model.meshes[0].colors.size(), 4 * model.meshes[0].VertexCount());
  }
  // The first face's colour, 0.792157 0.819608 0.933333, and a wheel 13 cm across.
  const Model body = ReadModel(folder + "/Rocky7Body.wrl");
  EXPECT_NEAR(body.Bounds().max().x(), 0.43075, 1e-6);
  const Model wheel = ReadModel(folder + "/Rocky7Wheel.wrl");
  EXPECT_NEAR(wheel.Bounds().sizes().x(), 0.13, 0.01);
  EXPECT_TRUE(HasWarning(ReadModel(folder + "/Rocky7Rocker.wrl").warnings, "among 1 colours"));
}

TEST(ImportVrml, Pathfinder) {
  DSPACE_REAL_DATA(folder, "models/pathfinder_vrml");
  const Model lander = ReadModel(folder + "/lander2.wrl");
  EXPECT_EQ(lander.TriangleCount(), 2333u); // as its own comment says
  EXPECT_EQ(lander.meshes.at(0).VertexCount(), 1367u);
  EXPECT_TRUE(lander.warnings.empty());
  const Model terrain = ReadModel(folder + "/terrain_full_80k.wrl"); // gzip
  EXPECT_EQ(terrain.meshes.size(), 96u);
  EXPECT_GT(terrain.TriangleCount(), 80000u);
  ASSERT_EQ(terrain.warnings.size(), 1u); // its textures are absent
  EXPECT_TRUE(HasWarning(terrain.warnings, "96 textures are left out: "));
  EXPECT_TRUE(HasWarning(terrain.warnings, "i1246924501p.img_0070060390.jpg"));
  for (const Mesh& mesh : terrain.meshes) {
    EXPECT_EQ(mesh.tcoords.size(), 2 * mesh.VertexCount());
  }
}

TEST(ImportVrml, Samples) {
  DSPACE_REAL_DATA(folder, "models/vrml97_samples");
  const Model hello = ReadModel(folder + "/HelloWorld.wrl");
  EXPECT_EQ(hello.TriangleCount(), 960u);
  ASSERT_TRUE(MaterialOf(hello).texture);
  EXPECT_GT(MaterialOf(hello).texture->width, 100);
  EXPECT_TRUE(HasWarning(hello.warnings, "node Text is not read"));
  EXPECT_EQ(hello.warnings.size(), 1u);
  const Model wuson = ReadModel(folder + "/Wuson.wrl");
  EXPECT_EQ(wuson.TriangleCount(), 3732u);
  EXPECT_TRUE(wuson.warnings.empty());
}

} // namespace dspace
