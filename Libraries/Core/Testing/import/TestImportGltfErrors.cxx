// glTF that is damaged or incomplete: each file gets a typed error or a warning.
#include "GltfTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

TEST(ImportGltf, MissingBufferIsNamed) {
  const TempFolder folder;
  ExpectReadError(Error::Kind::NotFound, "quad.bin", folder.Write("quad.gltf", Quad));
  ExpectReadError(Error::Kind::Unsupported, "not a relative",
                  folder.Write("quad.gltf", Replaced(Quad, "quad.bin", "/etc/passwd")));
  ExpectReadError(Error::Kind::Unsupported, "more than one folder",
                  folder.Write("quad.gltf", Replaced(Quad, "quad.bin", "../%2e%2e/etc/passwd")));
  ExpectReadError(Error::Kind::Unsupported, "not a relative",
                  folder.Write("quad.gltf", Replaced(Quad, "quad.bin", "http://a.b/c.bin")));
  folder.Write("quad.bin", QuadBytes().substr(0, 91));
  ExpectReadError(Error::Kind::Corrupt, "buffers[0] is truncated", folder.Write("quad.gltf", Quad));
  folder.Write("a b.bin", QuadBytes());
  EXPECT_NO_THROW(ReadModel(folder.Write("q.gltf", Replaced(Quad, "quad.bin", "a%20b.bin"))));
  EXPECT_NO_THROW(ReadModel(folder.Write("q.gltf", Replaced(Quad, "quad.bin", "a b.bin"))));
}

TEST(ImportGltf, MissingTextureIsAWarning) {
  const TempFolder folder;
  std::string json = Replaced(Quad, "\"baseColorFactor\"",
                              "\"baseColorTexture\": {\"index\": 0}, \"baseColorFactor\"");
  json = Replaced(json, "\"materials\"",
                  "\"images\": [{\"uri\": \"gone.webp\"}], \"textures\": [{\"extensions\": "
                  "{\"EXT_texture_webp\": {\"source\": 0}}}], \"materials\"");
  const std::string path = WriteQuad(folder, json);
  const Model model = ReadModel(path);
  EXPECT_TRUE(HasWarning(model.warnings, "gone.webp"));
  EXPECT_FALSE(model.materials[0].texture);
  ImportOptions strict;
  strict.strict = true;
  ExpectReadError(Error::Kind::Corrupt, "gone.webp", path, strict);
}

TEST(ImportGltf, Version1SaysSo) {
  const TempFolder folder;
  // Version 1 has objects where version 2 has arrays; its asset may be absent.
  ExpectReadError(
      Error::Kind::Unsupported, "is glTF 1.0",
      folder.Write("one.gltf", R"({"accessors": {}, "meshes": {"m": {}}, "nodes": {}})"));
}

TEST(ImportGltf, InstancesAreNodes) {
  const TempFolder folder;
  const std::string data = Bytes<float>({0, 0, 5, 0, 0, 9});
  folder.Write("t.bin", data);
  std::string json = Replaced(Quad, "\"byteLength\": 92}",
                              "\"byteLength\": 92}, {\"uri\": \"t.bin\", "
                              "\"byteLength\": 24}");
  json = Replaced(json, "\"byteOffset\": 80, \"byteLength\": 12}",
                  "\"byteOffset\": 80, \"byteLength\": 12}, {\"buffer\": 1, \"byteLength\": 24}");
  json =
      Replaced(json, "\"count\": 6, \"type\": \"SCALAR\"}",
               "\"count\": 6, \"type\": \"SCALAR\"}, {\"bufferView\": 3, \"componentType\": 5126, "
               "\"count\": 2, \"type\": \"VEC3\"}");
  json = Replaced(
      json, "\"name\": \"moved\"",
      "\"name\": \"moved\", \"extensions\": {\"EXT_mesh_gpu_instancing\": {\"attributes\": "
      "{\"TRANSLATION\": 3}}}");
  const Model model = ReadModel(WriteQuad(folder, json));
  EXPECT_EQ(model.TriangleCount(), 6u); // two of "turned", and twice two
  EXPECT_NEAR(model.Bounds().max().z(), 7 + 9, 1e-6);
}

TEST(ImportGltf, BadFilesAreTypedErrors) {
  const TempFolder folder;
  const auto expect = [&](Error::Kind kind, const std::string& part, const std::string& from,
                          const std::string& to) {
    ExpectReadError(kind, part, WriteQuad(folder, Replaced(Quad, from, to)));
  };
  const auto corrupt = Error::Kind::Corrupt;
  expect(Error::Kind::Unsupported, "glTF 1.0", "\"2.0\"", "\"1.0\"");
  expect(corrupt, "asset.version", "\"version\"", "\"verse\"");
  expect(Error::Kind::Unsupported, "EXT_meshopt", "\"scene\": 0",
         "\"extensionsRequired\": [\"EXT_meshopt_compression\"]");
  // Ranges.
  expect(corrupt, "bufferViews[0] has bytes 0 to 480", "\"byteLength\": 48}",
         "\"byteLength\": 480}");
  expect(corrupt, "accessors[0] needs 5", "\"count\": 4, \"type\": \"VEC3\"",
         "\"count\": 5, \"type\": \"VEC3\"");
  expect(corrupt, "for 4 vertices", "\"count\": 4, \"type\": \"VEC2\"",
         "\"count\": 3, \"type\": \"VEC2\"");
  expect(corrupt, "accessors[0].count", "\"count\": 4, \"type\": \"VEC3\"",
         "\"count\": -4, \"type\": \"VEC3\"");
  expect(corrupt, "accessors[0].count is 0", "\"count\": 4, \"type\": \"VEC3\"",
         "\"count\": 0, \"type\": \"VEC3\"");
  expect(Error::Kind::Resource, "accessors[0].count",
         "\"bufferView\": 0, \"componentType\": 5126, \"count\": 4",
         "\"componentType\": 5126, \"count\": 1000000000");
  expect(corrupt, "component type 5130", "\"bufferView\": 0, \"componentType\": 5126",
         "\"bufferView\": 0, \"componentType\": 5130");
  expect(corrupt, "byteStride", "\"byteLength\": 48}", "\"byteLength\": 48, \"byteStride\": 1}");
  expect(corrupt, "is 9 of the 3 accessors", "\"indices\": 2", "\"indices\": 9");
  expect(corrupt, "POSITION", "\"POSITION\": 0", "\"POSITION\": \"zero\"");
  expect(corrupt, "is of type VEC2", "\"POSITION\": 0", "\"POSITION\": 1");
  expect(corrupt, ".mode is 9", "\"indices\": 2", "\"mode\": 9, \"indices\": 2");
  expect(corrupt, "is 4 of the 1 materials", "\"material\": 0", "\"material\": 4");
  expect(corrupt, "is 5 of the 1 meshes", "\"mesh\": 0}", "\"mesh\": 5}");
  // Nodes.
  expect(corrupt, "two parents or is its own ancestor", "\"mesh\": 0}",
         "\"mesh\": 0, \"children\": [0]}");
  expect(corrupt, "two parents", "\"children\": [1, 2]", "\"children\": [1, 1]");
  expect(corrupt, "names a node", "\"children\": [1, 2]", "\"children\": [1, 77]");
  expect(corrupt, "rotation", "[0, 0, 0.70710678118654757, 0.70710678118654757]", "[0, 0, 0, 0]");
  expect(corrupt, "'1e999' is not a number", "[10, 0, 0]", "[1e999, 0, 0]");
  expect(corrupt, "translation", "[10, 0, 0]", "[10, 0]");
  // Shapes of the JSON.
  expect(corrupt, "'meshes' is not an array", "\"meshes\": [", "\"meshes\": 3, \"x\": [");
  expect(corrupt, "has no primitives", "\"primitives\"", "\"primitive\"");
  expect(corrupt, "nothing to draw", "\"scenes\": [{\"nodes\": [0]}]", "\"scenes\": [{}]");
  expect(corrupt, "mesh 'quad' has 8 vertices and no faces", "\"indices\": 2,", "\"mode\": 0,");
  expect(corrupt, "not glTF", "\"asset\"", "asset");
  ExpectReadError(corrupt, "not glTF",
                  folder.Write("deep.gltf", "{\"a\":" + std::string(1000000, '[')));
  std::string deep = "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [";
  for (int i = 0; i < 20000; ++i) {
    deep += "{\"children\": [" + std::to_string(i + 1) + "]},";
  }
  ExpectReadError(corrupt, "nothing to draw", folder.Write("chain.gltf", deep + "{}]}"));
}

TEST(ImportGltf, BadGeometryIsTyped) {
  const TempFolder folder;
  const std::string path = WriteQuad(folder);
  const auto with = [&](std::size_t offset, const std::string& bytes) {
    std::string all = QuadBytes();
    folder.Write("quad.bin", all.replace(offset, bytes.size(), bytes));
  };
  with(82, Bytes<std::uint16_t>({4}));
  ExpectReadError(Error::Kind::Corrupt, "index 4 of 4 vertices", path);
  with(16, Bytes<float>({NAN}));
  EXPECT_TRUE(HasWarning(ReadModel(path).warnings, "left out: 1 (the first: face 0)"));
  with(52, Bytes<float>({INFINITY}));
  EXPECT_TRUE(HasWarning(ReadModel(path).warnings, "become 0: 1 (the first: vertex 0)"));
  ImportOptions strict;
  strict.strict = true;
  ExpectReadError(Error::Kind::Corrupt, "become 0", path, strict);
  with(0, "");
  EXPECT_NO_THROW(ReadModel(path));
  ImportOptions few;
  few.maximumTriangles = 3;
  ExpectReadError(Error::Kind::Resource, "4 triangles; at most 3", path, few);
  // One small buffer named by thousands of primitives.
  std::string bomb = "{\"attributes\": {\"POSITION\": 0}}";
  std::string all;
  for (int i = 0; i < 20000; ++i) {
    all += (i == 0 ? "" : ",") + bomb;
  }
  folder.Write("big.bin", std::string(12000, '\0'));
  ExpectReadError(Error::Kind::Resource, "number of vertices",
                  folder.Write("bomb.gltf", R"({"asset": {"version": "2.0"},
      "buffers": [{"uri": "big.bin", "byteLength": 12000}],
      "bufferViews": [{"buffer": 0, "byteLength": 12000}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 1000, "type": "VEC3"}],
      "meshes": [{"primitives": [)" + all + R"(]}], "nodes": [{"mesh": 0}]})"));
}

TEST(ImportGltf, TruncatedBinaryIsTyped) {
  const TempFolder folder;
  const std::string glb = Glb(Replaced(Quad, "\"uri\": \"quad.bin\", ", ""), QuadBytes());
  for (std::size_t n = 1; n < glb.size(); n += 7) {
    EXPECT_THROW(ReadModel(folder.Write("cut.glb", glb.substr(0, n))), Error) << n;
  }
  std::string longer = glb;
  longer[12] = '\xff'; // the JSON chunk's length
  longer[15] = '\x7f';
  ExpectReadError(Error::Kind::Corrupt, "passes the end", folder.Write("long.glb", longer));
  std::string one = glb;
  one[4] = 1;
  ExpectReadError(Error::Kind::Unsupported, "GLB version 1", folder.Write("one.glb", one));
  EXPECT_NO_THROW(ReadModel(folder.Write("whole.glb", glb)));
}
