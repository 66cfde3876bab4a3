// Animations of glTF files, and damaged ones.
#include <fstream>

#include "GltfTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

// A translation of "moved" at 0 and 2 s, in the values' own words; and what is wrong with others.
TEST(GltfAnimations, AnimationsAreTheirKeys) {
  const TempFolder folder;
  const auto with = [&](const std::string& from = "", const std::string& to = "",
                        const std::vector<float>& times = {0, 2},
                        const std::vector<float>& places = {1, 2, 3, 4, 5, 6, 0, 0, 0, 1, 0, 0}) {
    std::string times8 = Bytes<float>({times[0], times[1]});
    std::string values;
    for (const float v : places) {
      values += Bytes<float>({v});
    }
    values.resize(48);
    folder.Write("keys.bin", times8 + values);
    std::string json = Replaced(Quad, "\"byteLength\": 92}",
                                "\"byteLength\": 92}, {\"uri\": \"keys.bin\", \"byteLength\": 56}");
    json = Replaced(json, "\"byteOffset\": 80, \"byteLength\": 12}",
                    "\"byteOffset\": 80, \"byteLength\": 12}, {\"buffer\": 1, \"byteLength\": 8}, "
                    "{\"buffer\": 1, \"byteOffset\": 8, \"byteLength\": 48}");
    json = Replaced(json, "\"count\": 6, \"type\": \"SCALAR\"}",
                    "\"count\": 6, \"type\": \"SCALAR\"}, "
                    "{\"bufferView\": 3, \"componentType\": 5126, \"count\": 2, \"type\": "
                    "\"SCALAR\", \"min\": [0], \"max\": [2]}, "
                    "{\"bufferView\": 4, \"componentType\": 5126, \"count\": 2, \"type\": "
                    "\"VEC3\"}, {\"bufferView\": 4, \"componentType\": 5126, \"count\": 2, "
                    "\"type\": \"VEC4\"}");
    json = Replaced(json, "\"scene\": 0", R"("scene": 0, "animations": [{"name": "go", "channels": [
      {"sampler": 0, "target": {"node": 2, "path": "translation"}},
      {"sampler": 0, "target": {"path": "translation"}},
      {"sampler": 0, "target": {"node": 2, "path": "weights"}}],
      "samplers": [{"input": 3, "output": 4, "interpolation": "STEP"}]}])");
    return WriteQuad(folder, from.empty() ? json : Replaced(json, from, to));
  };
  const Model model = ReadModel(with());
  ASSERT_EQ(model.animations.size(), 1u);
  EXPECT_EQ(model.animations[0].name, "go");
  ASSERT_EQ(model.animations[0].channels.size(), 1u); // one has no node, one moves none
  const ModelChannel& channel = model.animations[0].channels[0];
  EXPECT_EQ(model.nodes[std::size_t(channel.node)].name, "moved");
  EXPECT_EQ(channel.property, ModelChannel::Property::Translation);
  EXPECT_EQ(channel.interpolation, ModelChannel::Interpolation::Step);
  EXPECT_EQ(channel.time_s, (std::vector<double>{0, 2}));
  EXPECT_EQ(channel.value, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_NE(LeftOutWarning(model, true, true).find("1 channels of animations that move no node"),
            std::string::npos);

  const auto bad = [](const std::string& part, const std::string& path) {
    ExpectReadError(Error::Kind::Corrupt, part, path);
  };
  bad("times do not ascend at key 1", with("", "", {2, 2}));
  bad("not finite", with("", "", {0, NAN}));
  bad("not finite", with("", "", {0, 2}, {1, INFINITY, 0, 0, 0, 0}));
  bad("interpolation is 'WILD'", with("STEP", "WILD"));
  bad("2 values for 2 times", with("STEP", "CUBICSPLINE"));
  bad("of 1 samplers", with("\"sampler\": 0", "\"sampler\": 1"));
  bad("output is of type VEC3", with("path\": \"translation\"", "path\": \"rotation\""));
  bad("nodes", with("\"node\": 2", "\"node\": 9"));
  std::string turned = Replaced("\"output\": 4", "4", "5");
  const auto rotation = [&](const std::vector<float>& values) {
    const std::string path = with("\"output\": 4", turned, {0, 2}, values);
    std::ifstream file(path);
    const std::string json(std::istreambuf_iterator<char>(file), {});
    return folder.Write("quad.gltf", Replaced(json, "translation\"}}", "rotation\"}}"));
  };
  EXPECT_EQ(ReadModel(rotation({0, 0, 0, 1, 0, 1, 0, 0})).animations[0].channels[0].value,
            (std::vector<double>{0, 0, 0, 1, 0, 1, 0, 0}));
  bad("key 1 is not a rotation", rotation({0, 0, 0, 1, 0, 0, 0, 0}));
}
