// ReadModel on VRML: nodes, both dialects, and real files.
#include "TestData.h"
#include "VrmlTestSupport.h"

namespace dspace::testing {
namespace {

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

// ---- grouping, PROTO, Inline ------------------------------------------------------------------

TEST(ImportVrml, SwitchShowsOneChild) {
  const TempFolder folder;
  const auto boxAt = [](int x) {
    return "Transform { translation " + std::to_string(x) +
           " 0 0 children Shape { geometry Box { } } } ";
  };
  const Model model = Read(folder, Head2 + "Switch { whichChoice 1 choice [ " + boxAt(100) +
                                       boxAt(10) + "] } Switch { choice [ " + boxAt(200) +
                                       "] } Switch { whichChoice 7 choice [ " + boxAt(300) +
                                       "] } LOD { level [ " + boxAt(20) + boxAt(400) + "] }");
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
    Separator { FontStyle { size 1 } AsciiText { string "hello" } }
    Extension { fields [ SFLong a ] a 1 }
  })");
  const std::size_t letters = model.meshes.back().PrimitiveCount(); // "hello"
  EXPECT_GT(letters, 50u);
  EXPECT_EQ(model.TriangleCount(), 12u + 960u + 94u + 12u + 12u + letters);
  EXPECT_EQ(model.Bounds().max().z(), 31.0);
  EXPECT_NEAR(model.Bounds().max().x(), 6.0, 1e-6); // the cube lies on its side
  EXPECT_EQ(MaterialOf(model, 0).color, (std::array<double, 3>{1, 0, 0}));
  EXPECT_EQ(MaterialOf(model, 1).color, (std::array<double, 3>{0, 0, 1}));
  EXPECT_EQ(MaterialOf(model, 2).color,
            (std::array<double, 3>{0, 0, 1})); // TransformSeparator leaks it
  EXPECT_EQ(MaterialOf(model, 4).color, (std::array<double, 3>{0, 0, 1}));
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

TEST(ImportVrml, LevelsKeepTheirDistances) {
  const TempFolder folder;
  const Model two =
      Read(folder, Head2 +
                       "Transform { scale 2 2 2 children LOD { center 0 1 0 range [ 5, 20 ] "
                       "level [ " +
                       Shape("Box { }") + Shape("Sphere { }") + " Group { } ] } }");
  std::vector<DistanceRange> ranges;
  for (const ModelNode& node : two.nodes) {
    if (node.range) {
      ranges.push_back(*node.range);
      EXPECT_EQ(node.range->center, Eigen::Vector3d(0, 1, 0));
    }
  }
  ASSERT_EQ(ranges.size(), 3u);
  EXPECT_EQ(ranges[0].from, 0.0);
  EXPECT_EQ(ranges[0].to, 5.0);
  EXPECT_EQ(ranges[1].from, 5.0);
  EXPECT_EQ(ranges[1].to, 20.0);
  EXPECT_EQ(ranges[2].from, 20.0);
  EXPECT_TRUE(std::isinf(ranges[2].to));
  const Model one = Read(folder, Head1 + "LOD { range [ 7 ] Cube { } Sphere { } Cone { } }");
  ranges.clear();
  for (const ModelNode& node : one.nodes) {
    if (node.range) {
      ranges.push_back(*node.range);
    }
  }
  ASSERT_EQ(ranges.size(), 2u); // the third has no distance
  EXPECT_EQ(ranges[1].from, 7.0);
  // Without ranges the finest level is shown.
  EXPECT_EQ(Read(folder, Head2 + "LOD { level [ " + Shape("Box { }") + Shape("Sphere { }") + " ] }")
                .TriangleCount(),
            12u);
}

TEST(ImportVrml, WhatIsLeftOutIsListed) {
  const TempFolder folder;
  const Model model =
      Read(folder, Head2 +
                       "Background { } Fog { } Viewpoint { } Viewpoint { } PointLight { } "
                       "NavigationInfo { }" +
                       Shape("Box { }"));
  EXPECT_TRUE(model.warnings.empty());
  EXPECT_EQ(LeftOutWarning(model, false, false),
            "file '" + folder / "test.wrl" +
                "': left out: 1 Background, 1 Fog, 1 PointLight, 2 Viewpoint");
}

TEST(ImportVrml, EmissionDoesNotHideATextureOfVrml1) {
  const TempFolder folder;
  folder.Write("t.png", DecodeBase64(FourColorsPng));
  const auto read = [&](const std::string& emission) {
    return MaterialOf(Read(folder, Head1 +
                                       "Separator { Texture2 { filename \"t.png\" } Material { "
                                       "diffuseColor 0.5 0.5 0.5 emissiveColor " +
                                       emission + " } Cube { } }"));
  };
  const Material white = read("1 1 1"); // as OpenGL 1 draws it: the texture itself
  ASSERT_TRUE(white.texture);
  EXPECT_FALSE(white.lit);
  EXPECT_EQ(white.emissive, (std::array<double, 3>{0, 0, 0}));
  EXPECT_EQ(white.color, (std::array<double, 3>{1, 1, 1}));
  const Material half = read("0.5 0.5 0.5"); // times the texture's mean: red, green, blue and white
  EXPECT_TRUE(half.lit);
  EXPECT_NEAR(half.emissive[0], 0.25, 1e-9);
}

TEST(ImportVrml, Samples) {
  DSPACE_REAL_DATA(folder, "models/vrml97_samples");
  const Model hello = ReadModel(folder + "/HelloWorld.wrl");
  ASSERT_EQ(hello.meshes.size(), 2u); // the globe, and the letters
  EXPECT_EQ(hello.meshes[0].PrimitiveCount(), 960u);
  EXPECT_GT(hello.meshes[1].PrimitiveCount(), 100u);
  ASSERT_TRUE(MaterialOf(hello).texture);
  EXPECT_GT(MaterialOf(hello).texture->width, 100);
  EXPECT_TRUE(hello.warnings.empty());
  const Model wuson = ReadModel(folder + "/Wuson.wrl");
  EXPECT_EQ(wuson.TriangleCount(), 3732u);
  EXPECT_TRUE(wuson.warnings.empty());
}

} // namespace
} // namespace dspace::testing
