// glTF 2.0, text and binary: hand-made files with known answers, and real spacecraft.
#include <dspace/import/gltf/StatedBounds.h>

#include <cmath>
#include <set>

#include "GltfTestSupport.h"
#include "TestData.h"

using namespace dspace;
using namespace dspace::testing;

TEST(ImportGltf, NodesAndMaterials) {
  const TempFolder folder;
  const Model model = ReadModel(WriteQuad(folder));
  EXPECT_TRUE(model.warnings.empty());
  EXPECT_EQ(model.TriangleCount(), 4u);
  ASSERT_EQ(model.nodes.size(), 3u);
  EXPECT_EQ(model.nodes[1].name, "turned");
  EXPECT_EQ(model.nodes[1].parent, 0);
  // Turned a quarter: the quad's X, 0 to 2, becomes Y; its Y, stretched to 2, becomes -X.
  const Eigen::AlignedBox3d box = model.Bounds();
  EXPECT_LT((box.min() - Eigen::Vector3d(8, 0, 0)).norm(), 1e-12);
  EXPECT_LT((box.max() - Eigen::Vector3d(12, 2, 7)).norm(), 1e-12);
  const Material& paint = model.materials.at(0);
  EXPECT_EQ(paint.name, "paint");
  EXPECT_NEAR(paint.color[0], SrgbOf(0.5), 1e-12);
  EXPECT_NEAR(paint.color[1], SrgbOf(0.2), 1e-12);
  EXPECT_NEAR(paint.color[0], 0.735357, 1e-6); // sRGB of linear one half
  EXPECT_EQ(paint.color[2], 0.0);
  EXPECT_EQ(paint.opacity, 1.0); // opaque, whatever its alpha
  EXPECT_EQ(paint.metallic, 0.25);
  EXPECT_EQ(paint.roughness, 0.75);
  EXPECT_NEAR(paint.emissive[1], SrgbOf(0.1), 1e-12);
  EXPECT_FALSE(paint.doubleSided);
  EXPECT_TRUE(paint.lit);
}

TEST(ImportGltf, AlphaUnlitAndDoubleSided) {
  const TempFolder folder;
  const Model model = ReadModel(WriteQuad(
      folder, Replaced(Quad, "\"name\": \"paint\",",
                       "\"name\": \"paint\", \"alphaMode\": \"BLEND\", \"doubleSided\": true, "
                       "\"extensions\": {\"KHR_materials_unlit\": {}},")));
  EXPECT_EQ(model.materials[0].opacity, 0.5);
  EXPECT_TRUE(model.materials[0].doubleSided);
  EXPECT_FALSE(model.materials[0].lit);
}

TEST(ImportGltf, TextureLiesUpright) {
  const TempFolder folder;
  folder.Write("images/four colors.png", DecodeBase64(FourColorsPng));
  std::string json = Replaced(Quad, "\"baseColorFactor\"",
                              "\"baseColorTexture\": {\"index\": 0}, \"baseColorFactor\"");
  json = Replaced(json, "\"materials\"",
                  "\"images\": [{\"uri\": \"images/four%20colors.png\"}], "
                  "\"samplers\": [{\"wrapS\": 33071}], "
                  "\"textures\": [{\"source\": 0, \"sampler\": 0}], \"materials\"");
  const Model model = ReadModel(WriteQuad(folder, json));
  ASSERT_TRUE(model.materials[0].texture);
  const Image& image = *model.materials[0].texture;
  EXPECT_FALSE(model.materials[0].repeatTexture);
  // Vertex 3, the quad's top-left, must find the red pixel of the image's top row: with v = 0 at
  // the bottom its v is 1.
  const Mesh& mesh = model.meshes[0];
  ASSERT_EQ(mesh.tcoords.size(), 8u);
  EXPECT_FLOAT_EQ(mesh.tcoords[6], 0.0f);
  EXPECT_FLOAT_EQ(mesh.tcoords[7], 1.0f);
  EXPECT_FLOAT_EQ(mesh.tcoords[0], 0.0f);
  EXPECT_FLOAT_EQ(mesh.tcoords[1], 0.0f);
  EXPECT_EQ(image.pixels[0], 255);
  EXPECT_EQ(image.pixels[1], 0);

  // Moved and scaled by the extension: u' = 0.5 + 2 u, and v downwards likewise.
  const Model moved = ReadModel(
      WriteQuad(folder, Replaced(json, "{\"index\": 0}",
                                 "{\"index\": 0, \"extensions\": {\"KHR_texture_transform\": "
                                 "{\"offset\": [0.5, 0.25], \"scale\": [2, 1]}}}")));
  EXPECT_FLOAT_EQ(moved.meshes[0].tcoords[6], 0.5f);
  EXPECT_FLOAT_EQ(moved.meshes[0].tcoords[7], 0.75f);
  EXPECT_FLOAT_EQ(moved.meshes[0].tcoords[2], 2.5f);
  EXPECT_FLOAT_EQ(moved.meshes[0].tcoords[3], -0.25f);
}

TEST(ImportGltf, TextureAlphaFollowsTheMode) {
  const TempFolder folder;
  folder.Write("a.png", DecodeBase64(AlphaPng));
  const auto read = [&](const std::string& mode) {
    std::string json = Replaced(Quad, "\"baseColorFactor\": [0.5, 0.2, 0, 0.5]",
                                "\"baseColorTexture\": {\"index\": 0}");
    json = Replaced(json, "\"materials\"",
                    "\"images\": [{\"uri\": \"a.png\"}], \"textures\": [{\"source\": 0}], "
                    "\"materials\"");
    return ReadModel(WriteQuad(folder, Replaced(json, "\"name\": \"paint\",", mode))).materials[0];
  };
  EXPECT_EQ(read("").texture->pixels, (std::vector<std::uint8_t>{200, 100, 50, 10, 20, 30}));
  EXPECT_EQ(read("\"alphaMode\": \"BLEND\",").texture->pixels,
            (std::vector<std::uint8_t>{200, 100, 50, 64, 10, 20, 30, 255}));
  EXPECT_EQ(read("\"alphaMode\": \"MASK\",").texture->pixels,
            (std::vector<std::uint8_t>{200, 100, 50, 0, 10, 20, 30, 255}));
  EXPECT_EQ(read("\"alphaMode\": \"MASK\", \"alphaCutoff\": 0.2,").texture->pixels,
            (std::vector<std::uint8_t>{200, 100, 50, 255, 10, 20, 30, 255}));
}

TEST(ImportGltf, BinaryAndDataUriGiveTheSame) {
  const TempFolder folder;
  const Model text = ReadModel(WriteQuad(folder));
  const Model binary = ReadModel(
      folder.Write("quad.glb", Glb(Replaced(Quad, "\"uri\": \"quad.bin\", ", ""), QuadBytes())));
  EXPECT_EQ(binary.meshes[0].positions, text.meshes[0].positions);
  EXPECT_EQ(binary.meshes[0].indices, text.meshes[0].indices);
  const std::string zeros = "data:application/octet-stream;base64," + std::string(124, 'A');
  // As it is read, before normals are made.
  const Model data = ReadGltf(WriteQuad(folder, Replaced(Quad, "quad.bin", zeros)), {});
  EXPECT_EQ(data.meshes[0].positions, (std::vector<float>{0, 0, 0})); // all indices are 0
  // Found by content, whatever the name.
  EXPECT_EQ(ReadModel(folder.Write("quad.dat",
                                   Glb(Replaced(Quad, "\"uri\": \"quad.bin\", ", ""), QuadBytes())))
                .TriangleCount(),
            4u);
}

TEST(ImportGltf, QuantizedAttributesAreDecoded) {
  const TempFolder folder;
  // Positions as int16 (not normalised), padded to 8 bytes; texture coordinates as uint16,
  // normalised, which core glTF allows; colours as uint8, linear; indices as uint8.
  folder.Write("q.bin", Bytes<std::int16_t>({-100, 0, 0, 0, 200, 0, 0, 0, 0, 300, -32768, 0}) +
                            Bytes<std::uint16_t>({0, 0, 65535, 0, 0, 65535}) +
                            Bytes<std::uint8_t>({255, 0, 0, 0, 255, 0, 0, 55, 55, 0, 0, 1}) +
                            Bytes<std::uint8_t>({0, 1, 2}));
  const Model model = ReadModel(folder.Write("q.gltf", R"({"asset": {"version": "2.0"},
    "extensionsRequired": ["KHR_mesh_quantization"],
    "buffers": [{"uri": "q.bin", "byteLength": 51}],
    "bufferViews": [{"buffer": 0, "byteLength": 24, "byteStride": 8},
      {"buffer": 0, "byteOffset": 24, "byteLength": 12},
      {"buffer": 0, "byteOffset": 36, "byteLength": 12, "byteStride": 4},
      {"buffer": 0, "byteOffset": 48, "byteLength": 3}],
    "accessors": [{"bufferView": 0, "componentType": 5122, "count": 3, "type": "VEC3"},
      {"bufferView": 1, "componentType": 5123, "normalized": true, "count": 3, "type": "VEC2"},
      {"bufferView": 2, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC3"},
      {"bufferView": 3, "componentType": 5121, "count": 3, "type": "SCALAR"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2},
                                "indices": 3}]}],
    "nodes": [{"mesh": 0, "scale": [0.01, 0.01, 0.01]}], "scenes": [{"nodes": [0]}]})"));
  const Mesh& mesh = model.meshes.at(0);
  EXPECT_EQ(mesh.positions, (std::vector<float>{-100, 0, 0, 200, 0, 0, 0, 300, -32768}));
  EXPECT_EQ(mesh.tcoords, (std::vector<float>{0, 1, 1, 1, 0, 0}));
  // Linear 55/255 is sRGB 128: 1.055 * 0.2157^(1/2.4) - 0.055 = 0.5016.
  EXPECT_EQ(mesh.colors,
            (std::vector<std::uint8_t>{255, 0, 0, 255, 255, 0, 0, 255, 128, 0, 0, 255}));
  EXPECT_NEAR(model.Bounds().min().z(), -327.68, 1e-9);
}

TEST(ImportGltf, SparseStripsLinesAndPoints) {
  const TempFolder folder;
  // Four vertices at zero but for two that a sparse accessor moves.
  folder.Write("s.bin", Bytes<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}) +
                            Bytes<std::uint16_t>({1, 3}) + Bytes<float>({5, 0, 0, 5, 5, 0}));
  const char* const json = R"({"asset": {"version": "2.0"},
    "buffers": [{"uri": "s.bin", "byteLength": 76}],
    "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 4},
      {"buffer": 0, "byteOffset": 52, "byteLength": 24}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
      "sparse": {"count": 2, "indices": {"bufferView": 1, "componentType": 5123},
                 "values": {"bufferView": 2}}},
      {"componentType": 5126, "count": 4, "type": "VEC3",
      "sparse": {"count": 2, "indices": {"bufferView": 1, "componentType": 5123},
                 "values": {"bufferView": 2}}}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 5},
      {"attributes": {"POSITION": 0}, "mode": 6}, {"attributes": {"POSITION": 0}, "mode": 3},
      {"attributes": {"POSITION": 0}, "mode": 2}, {"attributes": {"POSITION": 0}, "mode": 1},
      {"attributes": {"POSITION": 1}, "mode": 0}]}],
    "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]})";
  const Model model = ReadModel(folder.Write("s.gltf", json));
  ASSERT_EQ(model.meshes.size(), 6u);
  EXPECT_EQ(model.meshes[0].positions, (std::vector<float>{0, 0, 0, 5, 0, 0, 0, 1, 0, 5, 5, 0}));
  const std::size_t counts[] = {2, 2, 3, 4, 2, 4}; // strip, fan, line strip, loop, lines, points
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(model.meshes[i].PrimitiveCount(), counts[i]) << i;
  }
  EXPECT_EQ(model.meshes[5].primitive, Mesh::Primitive::Points);
  EXPECT_EQ(model.meshes[5].positions, (std::vector<float>{0, 0, 0, 5, 0, 0, 0, 0, 0, 5, 5, 0}));
  // A strip keeps its winding: both triangles face the same way.
  const std::vector<std::uint32_t>& t = model.meshes[0].indices;
  const auto z = [&](std::size_t f) {
    const auto& p = model.meshes[0].positions;
    const auto at = [&](std::size_t k) {
      return Eigen::Vector3d(p[3 * t[f + k]], p[3 * t[f + k] + 1], p[3 * t[f + k] + 2]);
    };
    return (at(1) - at(0)).cross(at(2) - at(0)).z();
  };
  EXPECT_GT(z(0), 0);
  EXPECT_GT(z(3), 0);
}

TEST(ImportGltf, DracoBox) {
  // A box of 1 x 2 x 3 from the origin, compressed with 12 bits a coordinate: 8 vertices.
  const std::string draco = DecodeBase64(
      "RFJBQ08CAgEBAAAACAwBCwEAA68+CgEBEP8CNUEC/wAAAAAAAQAJAwAAAgEDCQIAAQIBAQEADQMBGAEIIwEgBACKDoKq"
      "uqoBAKYqAAQAAIBVASBVASAAAAAAAAD/DwAAAAAAAAAAAAAAAAAAAABAQAwBAQEAAwMBMAEQAwAoliMgAAAAAAD/AwAA"
      "AAAAAAAAAAAAAIA/Cg==");
  const TempFolder folder;
  const std::string json = R"({"asset": {"version": "2.0"},
    "extensionsRequired": ["KHR_draco_mesh_compression"],
    "buffers": [{"byteLength": 151}], "bufferViews": [{"buffer": 0, "byteLength": 151}],
    "accessors": [{"componentType": 5126, "count": 8, "type": "VEC3"},
      {"componentType": 5126, "count": 8, "type": "VEC2"},
      {"componentType": 5123, "count": 36, "type": "SCALAR"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2,
      "extensions": {"KHR_draco_mesh_compression":
        {"bufferView": 0, "attributes": {"POSITION": 0, "TEXCOORD_0": 1}}}}]}],
    "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]})";
  const Model model = ReadGltf(folder.Write("d.glb", Glb(json, draco)), {});
  EXPECT_EQ(model.TriangleCount(), 12u);
  EXPECT_EQ(model.meshes[0].VertexCount(), 8u);
  EXPECT_LT((model.Bounds().min() - Eigen::Vector3d(0, 0, 0)).norm(), 3.0 / 4095);
  EXPECT_LT((model.Bounds().max() - Eigen::Vector3d(1, 2, 3)).norm(), 3.0 / 4095);
  // The file tells other counts than the compressed data has.
  for (const std::string count : {"7", "9", "1000000"}) {
    const std::string bad = Replaced(json, "\"count\": 8", "\"count\": " + count);
    EXPECT_THROW(ReadModel(folder.Write("bad.glb", Glb(bad, draco))), Error) << count;
  }
  for (const std::string count : {"33", "39", "360000"}) {
    const std::string bad = Replaced(json, "\"count\": 36", "\"count\": " + count);
    try {
      EXPECT_LE(ReadModel(folder.Write("bad.glb", Glb(bad, draco))).TriangleCount(), 12u) << count;
    } catch (const Error&) {
    }
  }
  // Every byte of the compressed data changed, and cut: an error or a valid model, never a crash.
  for (std::size_t i = 0; i < draco.size(); ++i) {
    for (const int flip : {0x01, 0x80, 0xff}) {
      std::string bad = draco;
      bad[i] = static_cast<char>(bad[i] ^ flip);
      try {
        ReadModel(folder.Write("bad.glb", Glb(json, bad)));
      } catch (const Error&) {
      }
    }
  }
}

TEST(ImportGltf, RoverParts) {
  DSPACE_REAL_DATA(folder, "models/m2020_rover/meshes");
  std::set<std::string> missing;
  std::size_t parts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".gltf") {
      continue;
    }
    ++parts;
    try {
      const Model model = ReadModel(entry.path().string());
      EXPECT_TRUE(model.warnings.empty()) << entry.path();
      EXPECT_GT(model.TriangleCount(), 100u) << entry.path();
      // Each lies within the rover, which is 3 m long, and is larger than a centimetre.
      EXPECT_LT(model.Bounds().sizes().maxCoeff(), 3.2) << entry.path();
      EXPECT_GT(model.Bounds().sizes().minCoeff(), 0.01) << entry.path();
      ASSERT_TRUE(model.materials.at(0).texture) << entry.path();
      EXPECT_EQ(model.materials[0].texture->width, 1024) << entry.path();
    } catch (const Error& e) {
      EXPECT_EQ(static_cast<int>(e.GetKind()), static_cast<int>(Error::Kind::NotFound)) << e.what();
      EXPECT_NE(std::string(e.what()).find(entry.path().stem().string() + ".bin"),
                std::string::npos);
      missing.insert(entry.path().stem().string());
    }
  }
  EXPECT_EQ(parts, 36u);
  EXPECT_EQ(missing, (std::set<std::string>{"CHASSIS", "Turret"}));
  // The wheel's own file lists these, as minimum and maximum of its positions.
  const Eigen::AlignedBox3d wheel = ReadModel(folder + "/Wheel_LeftFront.gltf").Bounds();
  EXPECT_LT((wheel.min() - Eigen::Vector3d(0.83992302, -1.227789998, 0.616035998)).norm(), 1e-7);
  EXPECT_LT((wheel.max() - Eigen::Vector3d(1.34967995, -0.897202015, 1.12578999)).norm(), 1e-7);
}

TEST(ImportGltf, Spacecraft) {
  DSPACE_REAL_DATA(folder, "models/spacecraft_glb");
  const Model iss = ReadModel(folder + "/iss.glb");
  EXPECT_EQ(iss.TriangleCount(), 174440u);
  EXPECT_EQ(iss.materials.size(), 19u);
  EXPECT_EQ(iss.nodes.size(), 11u);
  for (const std::string name : {"/tdrs_b.glb", "/parker.glb"}) {
    const Model model = ReadModel(folder + name);
    std::set<const Image*> images;
    for (const Material& material : model.materials) {
      if (material.texture) {
        images.insert(material.texture.get());
      }
    }
    EXPECT_EQ(images.size(), name == "/tdrs_b.glb" ? 3u : 2u) << name;
    for (const Mesh& mesh : model.meshes) {
      EXPECT_EQ(mesh.normals.size(), mesh.positions.size()) << name;
    }
    EXPECT_GT(model.TriangleCount(), 20000u) << name;
  }
}

// What files state of themselves, against what their buffers hold. No node of these is turned.
TEST(ImportGltf, StatedBoundsAreTheGeometrys) {
  int files = 0;
  std::vector<std::string> folders = {ShippedDataFolder() + "/rover"};
  if (!RealDataFolder().empty()) {
    folders.push_back(RealDataFolder() + "/models/m2020_rover/meshes");
  }
  for (const std::string& folder : folders) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      const std::string extension = entry.path().extension().string();
      const std::string name = entry.path().stem().string();
      if ((extension != ".glb" && extension != ".gltf") || name == "CHASSIS" || name == "Turret") {
        continue; // the buffers of these two are absent
      }
      const Eigen::AlignedBox3d stated = ReadStatedBounds(entry.path().string());
      const Eigen::AlignedBox3d real = ReadModel(entry.path().string()).Bounds();
      ASSERT_FALSE(stated.isEmpty()) << entry.path();
      EXPECT_LT((stated.min() - real.min()).norm(), 1e-5) << entry.path();
      EXPECT_LT((stated.max() - real.max()).norm(), 1e-5) << entry.path();
      ++files;
    }
  }
  EXPECT_GE(files, 15);
  EXPECT_TRUE(ReadStatedBounds("/nowhere/absent.gltf").isEmpty());
  EXPECT_TRUE(ReadStatedBounds(folders[0] + "/rover.urdf").isEmpty());
}
