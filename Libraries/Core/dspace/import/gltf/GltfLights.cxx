#include <dspace/import/gltf/GltfLights.h>

#include <algorithm>

namespace dspace {

namespace {

constexpr double DegreesPerRadianOfCone = 180.0 / 3.14159265358979323846;

ModelLight ReadLight(const GltfDocument& document, const Json::Value& json,
                     const std::string& where) {
  ModelLight light;
  light.name = json["name"].isString() ? json["name"].asString() : "";
  const std::string type = json["type"].isString() ? json["type"].asString() : "";
  if (type == "directional") {
    light.kind = ModelLight::Kind::Directional;
  } else if (type == "point") {
    light.kind = ModelLight::Kind::Point;
  } else if (type == "spot") {
    light.kind = ModelLight::Kind::Spot;
    const Json::Value& spot = json["spot"];
    const double angle = spot.isObject()
                             ? document.Number(spot, "outerConeAngle", 0.7853981633974483, where)
                             : 0.7853981633974483; // a quarter of pi
    light.cone_deg = std::clamp(angle * DegreesPerRadianOfCone, 0.0, 90.0);
  } else {
    document.Fail(where + ".type is '" + type + "'; directional, point and spot are known");
  }
  const std::vector<double> color = document.Numbers(json, "color", 3, {1.0, 1.0, 1.0}, where);
  for (std::size_t c = 0; c < 3; ++c) {
    light.color[c] = std::clamp(color[c], 0.0, 1.0);
  }
  light.intensity = std::max(document.Number(json, "intensity", 1.0, where), 0.0);
  return light;
}

} // namespace

std::vector<ModelLight> ReadGltfLights(const GltfDocument& document,
                                       const std::vector<int>& indexOf) {
  std::vector<ModelLight> lights;
  for (std::size_t i = 0; i < indexOf.size(); ++i) {
    const Json::Value& use = document.Element("nodes", i)["extensions"]["KHR_lights_punctual"];
    if (indexOf[i] < 0 || !use.isObject()) {
      continue;
    }
    const Json::Value& all = document.Root()["extensions"]["KHR_lights_punctual"]["lights"];
    const std::string where = "nodes[" + std::to_string(i) + "].KHR_lights_punctual";
    const std::size_t index = document.Count(use, "light", all.size(), where);
    if (!all.isArray() || index >= all.size() || !all[Json::ArrayIndex(index)].isObject()) {
      document.Fail(where + ".light is " + std::to_string(index) + " of " +
                    std::to_string(all.size()) + " lights");
    }
    ModelLight light = ReadLight(document, all[Json::ArrayIndex(index)],
                                 "KHR_lights_punctual.lights[" + std::to_string(index) + "]");
    light.node = indexOf[i];
    lights.push_back(std::move(light));
  }
  return lights;
}

} // namespace dspace
