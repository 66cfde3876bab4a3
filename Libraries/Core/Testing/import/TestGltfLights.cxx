// Lights of glTF files, and what is listed as left out beside them.
#include "GltfTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

TEST(GltfLights, LightsCamerasAndSkinsAreListed) {
  const TempFolder folder;
  std::string json =
      Replaced(Quad, "\"scene\": 0", R"("scene": 0, "cameras": [{"type": "perspective"}],
    "skins": [{"joints": [0]}], "extensionsUsed": ["KHR_materials_clearcoat", "KHR_lights_punctual"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"name": "lamp", "type": "spot",
      "color": [1, 0.5, 0], "intensity": 20, "spot": {"outerConeAngle": 0.5}}]}})");
  json = Replaced(json, "\"name\": \"base\"",
                  "\"name\": \"base\", \"extensions\": {\"KHR_lights_punctual\": {\"light\": 0}}");
  const Model model = ReadModel(WriteQuad(folder, json));
  EXPECT_TRUE(model.warnings.empty());
  ASSERT_EQ(model.lights.size(), 1u);
  EXPECT_EQ(model.lights[0].name, "lamp");
  EXPECT_EQ(model.lights[0].kind, ModelLight::Kind::Spot);
  EXPECT_EQ(model.lights[0].node, 0);
  EXPECT_EQ(model.lights[0].intensity, 20.0);
  EXPECT_EQ(model.lights[0].color[1], 0.5);
  EXPECT_NEAR(model.lights[0].cone_deg, 0.5 * 180 / M_PI, 1e-9);
  const std::string all = LeftOutWarning(model, false, false);
  for (const char* each : {"quad.gltf': left out: ", "1 camera", "1 skin", "1 light",
                           "the extension 'KHR_materials_clearcoat'"}) {
    EXPECT_NE(all.find(each), std::string::npos) << all;
  }
  EXPECT_EQ(LeftOutWarning(model, true, true).find("light"), std::string::npos);
  ImportOptions strict;
  strict.strict = true;
  EXPECT_NO_THROW(ReadModel(folder / "quad.gltf", strict)); // no damage
}

TEST(GltfLights, LightsThatAreNoneAreErrors) {
  const TempFolder folder;
  const auto with = [&](const std::string& light, const std::string& use) {
    return WriteQuad(
        folder,
        Replaced(Replaced(Quad, "\"scene\": 0",
                          "\"scene\": 0, \"extensions\": {\"KHR_lights_punctual\": {\"lights\": [" +
                              light + "]}}"),
                 "\"name\": \"base\"",
                 "\"name\": \"base\", \"extensions\": {\"KHR_lights_punctual\": {\"light\": " +
                     use + "}}"));
  };
  const Model model =
      ReadModel(with(R"({"type": "point", "color": [2, -1, 0.5], "intensity": -4})", "0"));
  ASSERT_EQ(model.lights.size(), 1u);
  EXPECT_EQ(model.lights[0].color, (std::array<double, 3>{1.0, 0.0, 0.5})); // within the range
  EXPECT_EQ(model.lights[0].intensity, 0.0);
  EXPECT_NEAR(ReadModel(with(R"({"type": "spot"})", "0")).lights[0].cone_deg, 45.0, 1e-9);
  EXPECT_EQ(ReadModel(with(R"({"type": "directional"})", "0")).lights[0].intensity, 1.0);
  ExpectReadError(Error::Kind::Corrupt, "type is 'area'", with(R"({"type": "area"})", "0"));
  ExpectReadError(Error::Kind::Corrupt, "light is 1 of 1 lights",
                  with(R"({"type": "point"})", "1"));
  ExpectReadError(Error::Kind::Corrupt, "color", with(R"({"type": "point", "color": [1]})", "0"));
}
