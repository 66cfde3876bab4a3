// OBJ and MTL: hand-made files with known answers, bad ones, and the VIPER parts.
#include <dspace/import/model/Model.h>

#include "ImportTestSupport.h"
#include "TestData.h"

using namespace dspace;
using namespace dspace::testing;

namespace {

double Area(const Mesh& mesh) {
  double area = 0;
  const auto at = [&](std::size_t i) {
    const float* p = &mesh.positions[3 * mesh.indices[i]];
    return Eigen::Vector3d(p[0], p[1], p[2]);
  };
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    area += 0.5 * (at(i + 1) - at(i)).cross(at(i + 2) - at(i)).norm();
  }
  return area;
}

} // namespace

TEST(ImportObj, GroupsMaterialsAndTextureCoordinates) {
  const TempFolder folder;
  folder.Write("my textures/four colors.png", DecodeBase64(FourColorsPng));
  folder.Write("my materials.mtl", "# comment\n"
                                   "newmtl bright red\nKd 1 0 0.5\nd 0.25\nKe 0 0.5 0\nNs 198\n"
                                   "newmtl picture\nmap_Kd -clamp on -s 2 3 1 -o 0.5 0 0 "
                                   "my textures/four colors.png\n");
  const Model model =
      ReadModel(folder.Write("two parts.obj", "mtllib my materials.mtl\n"
                                              "o first thing\n"
                                              "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n"
                                              "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 2\n"
                                              "usemtl bright red\n"
                                              "f 1//1 2//1 3//1 4//1\n"
                                              "usemtl picture\n"
                                              "f -4/1 -3/2 \\\n  -2/3\n"
                                              "usemtl bright red\n"
                                              "f 1//1 2//1 3//1\r\n"));
  ASSERT_EQ(model.meshes.size(), 2u);
  const Mesh& red = model.meshes[0];
  EXPECT_EQ(red.name, "first thing");
  EXPECT_EQ(red.PrimitiveCount(), 3u); // both runs of the material in one mesh
  EXPECT_EQ(red.VertexCount(), 4u);
  EXPECT_TRUE(red.tcoords.empty());
  ASSERT_EQ(red.normals.size(), 12u);
  EXPECT_FLOAT_EQ(red.normals[2], 1.0f); // made unit length
  EXPECT_NEAR(Area(red), 3.0, 1e-6);
  const Material& material = model.materials[std::size_t(red.material)];
  EXPECT_EQ(material.name, "bright red");
  EXPECT_EQ(material.color, (std::array<double, 3>{1.0, 0.0, 0.5}));
  EXPECT_EQ(material.emissive, (std::array<double, 3>{0.0, 0.5, 0.0}));
  EXPECT_EQ(material.opacity, 0.25);
  EXPECT_NEAR(material.roughness, std::pow(0.01, 0.25), 1e-6); // Ns 198: alpha^2 = 1/100

  const Mesh& picture = model.meshes[1];
  const Material& textured = model.materials[std::size_t(picture.material)];
  ASSERT_TRUE(textured.texture);
  EXPECT_EQ(textured.texture->pixels[0], 255); // top-left is red
  EXPECT_FALSE(textured.repeatTexture);
  EXPECT_EQ(textured.color, (std::array<double, 3>{1.0, 1.0, 1.0}));
  // vt (1, 1), v upwards, scaled by (2, 3) and moved by (0.5, 0).
  EXPECT_EQ(picture.tcoords, (std::vector<float>{0.5f, 0, 2.5f, 0, 2.5f, 3}));
  EXPECT_TRUE(model.warnings.empty());
  const Eigen::AlignedBox3d box = model.Bounds();
  EXPECT_EQ(box.min(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(box.max(), Eigen::Vector3d(2, 1, 0));
}

TEST(ImportObj, PolygonsKeepTheirArea) {
  const TempFolder folder;
  // An L of area 3, a millimetre wide, listed from its inner corner; and one of 300 corners.
  std::string text = "v 0.001 0.001 0\nv 0.001 0.002 0\nv 0 0.002 0\nv 0 0 0\nv 0.002 0 0\n"
                     "v 0.002 0.001 0\nf 1 2 3 4 5 6\ng ring\n";
  std::string face = "f";
  for (int i = 0; i < 300; ++i) {
    const double a = 2 * M_PI * i / 300, r = i % 2 == 0 ? 2.0 : 1.0;
    text += "v " + std::to_string(r * std::cos(a)) + " 0 " + std::to_string(r * std::sin(a)) + "\n";
    face += " " + std::to_string(7 + i);
  }
  const Model model = ReadModel(folder.Write("polygons.obj", text + face + "\n"));
  ASSERT_EQ(model.meshes.size(), 2u);
  EXPECT_EQ(model.meshes[0].PrimitiveCount(), 4u);
  EXPECT_NEAR(Area(model.meshes[0]), 3e-6, 1e-12);
  EXPECT_EQ(model.meshes[1].PrimitiveCount(), 298u);
  // A star of 150 teeth: 300 triangles with sides 2 and 1 at an angle of 2 pi / 300.
  EXPECT_NEAR(Area(model.meshes[1]), 300 * 0.5 * 2 * std::sin(2 * M_PI / 300), 1e-4);
}

TEST(ImportObj, ColorsLinesAndPoints) {
  const TempFolder folder;
  const Model model = ReadModel(folder.Write("c.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\n"
                                                      "v 0 1 0 0 0 0.5\nf 1 2 3\nl 1 2 3\np 2\n"));
  ASSERT_EQ(model.meshes.size(), 3u);
  EXPECT_EQ(model.meshes[0].colors,
            (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 128, 255}));
  EXPECT_EQ(model.meshes[1].primitive, Mesh::Primitive::Lines);
  EXPECT_EQ(model.meshes[1].PrimitiveCount(), 2u);
  EXPECT_EQ(model.meshes[2].primitive, Mesh::Primitive::Points);
  EXPECT_EQ(model.meshes[2].PrimitiveCount(), 1u);
  EXPECT_EQ(model.TriangleCount(), 1u);
}

TEST(ImportObj, VerticesAloneAreAPointCloudWhenAskedFor) {
  const TempFolder folder;
  const std::string vertices = "v 0 0 0 1 0 0\nv 1 2 3 0 1 0\nv 4 5 6 0 0 1\n";
  ImportOptions cloud;
  cloud.pointCloud = true;
  for (const std::string& content : {vertices, vertices + "p 1 2 3\n"}) {
    const std::string file = folder.Write("p.obj", content);
    ExpectReadError(Error::Kind::Corrupt, "p.obj': has 3 vertices and no faces", file);
    const Model model = ReadModel(file, cloud);
    ASSERT_EQ(model.meshes.size(), 1u);
    EXPECT_EQ(model.meshes[0].primitive, Mesh::Primitive::Points);
    EXPECT_EQ(model.meshes[0].positions, (std::vector<float>{0, 0, 0, 1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(model.meshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(model.meshes[0].colors,
              (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255}));
  }
  ExpectReadError(Error::Kind::Corrupt, "has no vertices", folder.Write("n.obj", "o thing\n"),
                  cloud);
}

TEST(ImportObj, MissingPartsAreWarnings) {
  const TempFolder folder;
  const std::string faces = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl x\nf 1 2 3\n";
  const std::string noLibrary = folder.Write("a.obj", "mtllib gone.mtl\n" + faces);
  EXPECT_TRUE(HasWarning(ReadModel(noLibrary).warnings, "gone.mtl"));
  ImportOptions strict;
  strict.strict = true;
  ExpectReadError(Error::Kind::Corrupt, "gone.mtl", noLibrary, strict);
  folder.Write("x.mtl", "newmtl x\nmap_Kd gone.png\n");
  EXPECT_TRUE(
      HasWarning(ReadModel(folder.Write("b.obj", "mtllib x.mtl\n" + faces)).warnings, "gone.png"));
  folder.Write("y.mtl", "newmtl y\n");
  for (const std::string& warning : ReadModel(folder / "b.obj").warnings) {
    EXPECT_NE(warning.find("file '"), std::string::npos) << warning; // each names one
  }
  EXPECT_TRUE(HasWarning(ReadModel(folder.Write("c.obj", "mtllib y.mtl\n" + faces)).warnings,
                         "'x' is in none"));
  EXPECT_TRUE(HasWarning(ReadModel(folder / "c.obj").warnings, "c.obj': "));
  EXPECT_TRUE(
      HasWarning(ReadModel(folder.Write("d.obj", "mtllib ../../../etc/passwd\n" + faces)).warnings,
                 "more than one folder above"));
  EXPECT_TRUE(HasWarning(ReadModel(folder.Write("e.obj", "mtllib /etc/passwd\n" + faces)).warnings,
                         "not a relative file name"));
}

TEST(ImportObj, BadFilesAreTypedErrors) {
  const TempFolder folder;
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const auto expect = [&](const std::string& part, const std::string& text) {
    ExpectReadError(Error::Kind::Corrupt, part, folder.Write("bad.obj", text));
  };
  expect("no faces", vertices);
  expect("no faces", "hello\n\n");
  expect("line 4: index 4 of 3 vertices", vertices + "f 1 2 4\n");
  expect("line 4: f names '0'", vertices + "f 0 1 2\n");
  expect("line 4: f names '-4'", vertices + "f -4 1 2\n");
  expect("line 4: f names '1x'", vertices + "f 1x 1 2\n");
  expect("line 4: f names '99999999999999999999'", vertices + "f 99999999999999999999 1 2\n");
  expect("texture coordinates", vertices + "f 1/1 2/1 3/1\n");
  expect("normals", vertices + "f 1//1 2//1 3//1\n");
  for (const char* number : {"nan", "inf", "-inf", "1e39", "1.#QNAN", "-nan(ind)"}) {
    expect("positions that are not finite are left out: 1 (the first: face 0)",
           "v 0 " + std::string(number) + " 0\n" + vertices + "f 1 2 3\n");
  }
  expect("line 1: v has '0x10'", "v 0 0x10 0\n" + vertices + "f 1 2 3\n");
  expect("line 1: v has 2 numbers", "v 0 0\n" + vertices + "f 1 2 3\n");
  expect("no faces", vertices + "f 1 2");
  ImportOptions few;
  few.maximumTriangles = 3;
  ExpectReadError(Error::Kind::Resource, "more than 3 triangles",
                  folder.Write("many.obj", vertices + "f 1 2 3 1 2 3\n"), few);
}

TEST(ImportObj, DamageIsRepairedWithOneWarning) {
  const TempFolder folder;
  // A corner of the second face has a bad normal, one a bad texture coordinate, one a bad position.
  const std::string path =
      folder.Write("d.obj", "o wing\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv nan 0 0\n"
                            "vt 0 0\nvt 0.5 inf\nvn 0 0 2\nvn nan 0 1\nvn 0 0 0\n"
                            "f 1/1/1 2/1/1 3/1/2\nf 1/1/1 3/2/1 4/1/3\nf 1/1/1 2/1/1 5/1/1\n");
  const Model model = ReadModel(path);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_TRUE(HasWarning(model.warnings, "mesh 'wing': "));
  EXPECT_TRUE(HasWarning(model.warnings,
                         "positions that are not finite are left out: 1 (the first: "
                         "face 2)"));
  EXPECT_TRUE(HasWarning(model.warnings, "made from the faces: 2 (the first: vertex 2)"));
  EXPECT_TRUE(HasWarning(model.warnings, "become 0: 1 (the first: vertex 3)"));
  const Mesh& mesh = model.meshes.at(0);
  EXPECT_EQ(mesh.PrimitiveCount(), 2u);
  ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    EXPECT_FLOAT_EQ(mesh.normals[i], i % 3 == 2 ? 1.0f : 0.0f); // the faces lie in XY
  }
  ImportOptions strict;
  strict.strict = true;
  ExpectReadError(Error::Kind::Corrupt, "mesh 'wing'", path, strict);
}

TEST(ImportObj, TruncationNeverCrashes) {
  const TempFolder folder;
  const std::string text =
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\no x\nusemtl y\n"
      "f 1/1/1 2/1/1 \\\n3/1/1\nl 1 2\ns off\np 1\n";
  std::size_t read = 0;
  for (std::size_t n = 1; n < text.size(); ++n) {
    try {
      ReadModel(folder.Write("cut.obj", text.substr(0, n)));
      ++read;
    } catch (const Error&) {
    }
  }
  EXPECT_GT(read, 0u);
  EXPECT_LT(read, text.size() / 2);
}

TEST(ImportObj, ViperParts) {
  DSPACE_REAL_DATA(folder, "models/viper_obj");
  std::size_t parts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".obj") {
      const Model model = ReadModel(entry.path().string());
      EXPECT_GT(model.TriangleCount(), 400u) << entry.path();
      const Eigen::Vector3d size = model.Bounds().sizes();
      EXPECT_GT(size.minCoeff(), 0.05) << entry.path(); // metres
      EXPECT_LT(size.maxCoeff(), 2.5) << entry.path();
      ++parts;
    }
  }
  EXPECT_EQ(parts, 8u);
  // As counted in its own header comment.
  EXPECT_EQ(ReadModel(folder + "/viper_chassis.obj").TriangleCount(), 13602u);
  EXPECT_TRUE(HasWarning(ReadModel(folder + "/viper_wheel.obj").warnings, "temp.mtl"));
}
