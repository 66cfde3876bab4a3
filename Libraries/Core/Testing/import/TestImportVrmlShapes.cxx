// ReadModel on VRML: shapes and their appearance, against geometry known by hand.
#include "VrmlTestSupport.h"

namespace dspace::testing {
namespace {

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
  folder.Write("maps/four.png", DecodeBase64(FourColorsPng));
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

} // namespace
} // namespace dspace::testing
