// Text that is not UTF-8 in models and robots: every name, warning and error of an importer is.
#include <dspace/import/urdf/Urdf.h>

#include <filesystem>

#include <dspace/Utf8.h>

#include "GltfTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

namespace {

// "Mäst" in Latin-1 and in UTF-8.
const std::string Latin = "M\xE4st";
const std::string Name = "M\xC3\xA4st";
const std::string ObjFaces = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

void ExpectUtf8(const Model& model) {
  for (const Mesh& mesh : model.meshes) {
    EXPECT_TRUE(IsUtf8(mesh.name));
  }
  for (const Material& material : model.materials) {
    EXPECT_TRUE(IsUtf8(material.name));
    EXPECT_TRUE(!material.texture || IsUtf8(material.texture->name));
  }
  for (const ModelNode& node : model.nodes) {
    EXPECT_TRUE(IsUtf8(node.name));
  }
  for (const std::string& warning : model.warnings) {
    EXPECT_TRUE(IsUtf8(warning)) << warning;
  }
}

std::string Robot(const std::string& links, const std::string& name = Latin) {
  return "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><robot name=\"" + name + "\">" + links +
         "</robot>";
}

std::string Link(const std::string& name, const std::string& visual = "") {
  return "<link name=\"" + name + "\">" + visual + "</link>";
}

std::string Joint(const std::string& name, const std::string& child) {
  return "<joint name=\"" + name + "\" type=\"fixed\"><parent link=\"base\"/><child link=\"" +
         child + "\"/></joint>";
}

} // namespace

TEST(ImportText, ObjAndItsMaterials) {
  const TempFolder folder;
  folder.Write("M\xC3\xA4st.png", DecodeBase64(FourColorsPng));
  folder.Write("M\xC3\xA4st.mtl", "newmtl " + Latin + "\nKd 1 0 0\nmap_Kd " + Latin + ".png\n");
  const Model model = ReadModel(folder.Write("a.obj", "mtllib " + Latin + ".mtl\ng " + Latin +
                                                          "\nusemtl " + Latin + "\n" + ObjFaces +
                                                          "f 1 2 3\nusemtl nicht \xFC"
                                                          "berall\nf 1 2 3\n"));
  ExpectUtf8(model);
  EXPECT_EQ(model.meshes.at(0).name, Name);
  const Material& material = model.materials.at(std::size_t(model.meshes[0].material));
  EXPECT_EQ(material.name, Name);
  EXPECT_TRUE(material.texture); // the file's name is UTF-8, as the material's now is
  EXPECT_TRUE(HasWarning(model.warnings, "nicht \xC3\xBC"
                                         "berall"));
}

TEST(ImportText, MaterialsOfOneNameInTwoEncodings) {
  const TempFolder folder;
  folder.Write("a.mtl", "newmtl " + Name + "\nKd 1 0 0\nnewmtl " + Latin + "\nKd 0 1 0\n");
  const Model model = ReadModel(
      folder.Write("a.obj", "mtllib a.mtl\nusemtl " + Name + "\n" + ObjFaces + "f 1 2 3\n"));
  EXPECT_TRUE(HasWarning(model.warnings, "material '" + Name + "' is defined twice"));
  EXPECT_EQ(model.materials.at(std::size_t(model.meshes.at(0).material)).color[0], 1.0);
}

TEST(ImportText, ErrorsQuoteTheFileAsUtf8) {
  const TempFolder folder;
  ExpectReadError(Error::Kind::Corrupt, "v has '\xC3\xA4'", folder.Write("a.obj", "v \xE4 0 0\n"));
  // Cut to 40 bytes, of which the last would be half a letter.
  ExpectReadError(Error::Kind::Corrupt, "v has '" + std::string(39, 'x') + "';",
                  folder.Write("b.obj", "v " + std::string(39, 'x') + "\xC3\xA4 0 0\n"));
  ExpectReadError(Error::Kind::Corrupt, "\xC3\xA4",
                  folder.Write("a.ply", "ply\nformat ascii 1.0\n\xE4 1\nend_header\n"));
  ExpectReadError(Error::Kind::Corrupt, "\xC3\xA4",
                  folder.Write("a.stl", "solid a\nfacet normal 0 0 1\n\xE4\n"));
  ExpectReadError(Error::Kind::Corrupt, "\xC3\xA4",
                  folder.Write("a.wrl", "#VRML V2.0 utf8\nTransform { translation \xE4 0 0 }\n"));
  ExpectError(Error::Kind::Corrupt, Name, [&] {
    ReadUrdf(folder.Write("a.urdf", Robot(Link("base") + Link(Latin) + Link(Latin))));
  });
}

TEST(ImportText, GltfNodesMaterialsAndFiles) {
  const TempFolder folder;
  std::string json = Replaced(Quad, "\"turned\"", "\"" + Latin + "\"");
  json = Replaced(json, "\"paint\"", "\"\\udc80" + Latin + "\""); // half a character, escaped
  json = Replaced(json, "\"baseColorFactor\"",
                  "\"baseColorTexture\": {\"index\": 0}, \"baseColorFactor\"");
  json = Replaced(json, "\"materials\"",
                  "\"images\": [{\"uri\": \"M%E4st.png\"}], \"textures\": [{\"source\": 0}], "
                  "\"materials\"");
  folder.Write(Name + ".png", DecodeBase64(FourColorsPng));
  const Model text = ReadModel(WriteQuad(folder, json));
  ExpectUtf8(text);
  EXPECT_EQ(text.nodes.at(1).name, Name);
  EXPECT_NE(text.materials.at(0).name.find(Name), std::string::npos);
  EXPECT_TRUE(text.materials.at(0).texture);
  const Model binary = ReadModel(
      folder.Write("a.glb", Glb(Replaced(Replaced(Quad, "\"turned\"", "\"" + Latin + "\""),
                                         "\"uri\": \"quad.bin\", ", ""),
                                QuadBytes())));
  EXPECT_EQ(binary.nodes.at(1).name, Name);
}

TEST(ImportText, Vrml) {
  const TempFolder folder;
  const std::string shape = " { children Shape { geometry Box { } } }\n";
  const std::string two = "#VRML V2.0 utf8\nDEF " + Latin + " Transform" + shape +
                          "Inline { url \"" + Latin + ".wrl\" }\n";
  folder.Write(Name + ".wrl", "#VRML V2.0 utf8\nDEF " + Latin + " Group" + shape);
  const std::string one = "#VRML V1.0 ascii\nDEF " + Latin +
                          " Separator { Cube { } Texture2 { filename \"" + Latin +
                          ".png\" } Cube { width 1 } }\n";
  for (const std::string& bytes : {two, one}) {
    const Model model = ReadModel(folder.Write("a.wrl", bytes));
    ExpectUtf8(model);
    int named = 0;
    for (const ModelNode& node : model.nodes) {
      named += node.name == Name;
    }
    EXPECT_EQ(named, bytes == two ? 2 : 1);
    EXPECT_EQ(HasWarning(model.warnings, Name + ".png"), bytes == one);
  }
}

TEST(ImportText, PlyAndStl) {
  const TempFolder folder;
  const Model ply = ReadModel(folder.Write(
      "a.ply", "ply\nformat ascii 1.0\ncomment " + Latin +
                   "\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                   "property float " +
                   Latin +
                   "\nelement face 1\n"
                   "property list uchar int vertex_indices\nend_header\n"
                   "0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n"));
  ExpectUtf8(ply);
  const Model stl = ReadModel(
      folder.Write("a.stl", "solid " + Latin +
                                "\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                                "vertex 0 1 0\nendloop\nendfacet\nendsolid\n"));
  ExpectUtf8(stl);
  EXPECT_EQ(stl.meshes.at(0).name, Name);
}

TEST(ImportText, UrdfNamesFilesAndCharacterReferences) {
  const TempFolder folder;
  folder.Write(Name + ".obj", ObjFaces + "f 1 2 3\n");
  const Urdf robot = ReadUrdf(folder.Write(
      "a.urdf",
      Robot(Link("base", "<visual name=\"" + Latin + "\"><geometry><mesh filename=\"" + Latin +
                             ".obj\"/></geometry><material name=\"" + Latin +
                             "\"><color rgba=\"1 0 0 1\"/></material></visual>"
                             "<visual><geometry><mesh filename=\"file://M%E4st.obj\"/></geometry>"
                             "</visual>") +
            Link(Latin) + Joint(Latin, Latin) + Link("K&#228;fig") + Joint("j", "K&#228;fig"))));
  EXPECT_EQ(robot.name, Name);
  EXPECT_EQ(robot.links.at(1).name, Name);
  EXPECT_EQ(robot.links.at(2).name, "K\xC3\xA4"
                                    "fig");
  EXPECT_EQ(robot.joints.at(0).name, Name);
  const std::vector<UrdfVisual>& visuals = robot.links[0].visuals;
  EXPECT_EQ(visuals.at(0).name, Name);
  EXPECT_EQ(visuals[0].material.name, Name);
  EXPECT_FALSE(visuals[0].missing) << visuals[0].meshPath;
  EXPECT_FALSE(visuals.at(1).missing) << visuals[1].meshPath;
}

TEST(ImportText, UrdfNamesThatBecomeOneAreRejected) {
  const TempFolder folder;
  const std::string again = "K\xC3\xA4"
                            "fig";
  ExpectError(Error::Kind::Corrupt, "'" + again + "'", [&] {
    ReadUrdf(folder.Write("a.urdf", Robot(Link("base") +
                                          Link("K\xE4"
                                               "fig") +
                                          Link(again) +
                                          Joint("a", "K\xE4"
                                                     "fig") +
                                          Joint("b", again))));
  });
  ExpectError(Error::Kind::Corrupt, "link '" + again + "': two links have this name", [&] {
    ReadUrdf(folder.Write("b.urdf", Robot(Link("base") + Link(again) + Link("K&#228;fig") +
                                          Joint("a", again) + Joint("b", "K&#228;fig"))));
  });
}

TEST(ImportText, FilesWhoseNamesAreNotUtf8) {
  const TempFolder folder;
  // The reference is read as UTF-8, the file's own name is not: it is another one.
  folder.Write(Latin + ".mtl", "newmtl a\nKd 1 0 0\n");
  const Model model =
      ReadModel(folder.Write("a.obj", "mtllib " + Latin + ".mtl\n" + ObjFaces + "f 1 2 3\n"));
  EXPECT_TRUE(HasWarning(model.warnings, Name + ".mtl': does not exist"));
  ExpectReadError(Error::Kind::Unsupported, "is not UTF-8",
                  folder.Write(Latin + ".obj", ObjFaces + "f 1 2 3\n"));
  ExpectError(Error::Kind::Unsupported, "is not UTF-8",
              [&] { ReadUrdf(folder.Write(Latin + ".urdf", Robot(Link("base")))); });
}
