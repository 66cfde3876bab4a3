#include <dspace/import/gltf/GltfExtensions.h>

#include <set>

namespace dspace {

namespace {

// Read, or without effect on a picture.
const std::set<std::string>& ReadExtensions() {
  static const std::set<std::string> names = {"KHR_draco_mesh_compression",
                                              "KHR_mesh_quantization",
                                              "KHR_texture_transform",
                                              "KHR_materials_unlit",
                                              "KHR_materials_emissive_strength",
                                              "KHR_materials_pbrSpecularGlossiness",
                                              "KHR_lights_punctual",
                                              "EXT_mesh_gpu_instancing",
                                              "EXT_texture_webp",
                                              "EXT_mesh_features",
                                              "EXT_structural_metadata",
                                              "KHR_xmp",
                                              "KHR_xmp_json_ld"};
  return names;
}

// Whether vertices or indices cannot be decoded without it.
bool HidesGeometry(const std::string& name) {
  return name.find("compression") != std::string::npos ||
         name.find("_mesh_") != std::string::npos ||
         name.find("primitive_restart") != std::string::npos;
}

std::set<std::string> NotRead(const GltfDocument& document, const char* list) {
  std::set<std::string> names;
  for (const Json::Value& extension : document.Array(list)) {
    const std::string name = extension.isString() ? extension.asString() : "";
    if (ReadExtensions().count(name) == 0) {
      names.insert("'" + name + "'");
    }
  }
  return names;
}

} // namespace

void CheckGltfExtensions(const GltfDocument& document, std::vector<std::string>& warnings,
                         std::vector<std::string>& leftOut) {
  const std::set<std::string> required = NotRead(document, "extensionsRequired");
  std::string list;
  for (const std::string& name : required) {
    if (HidesGeometry(name)) {
      document.Fail("requires the extension " + name +
                        ", without which its geometry cannot be decoded; of compressions "
                        "'KHR_draco_mesh_compression' is read",
                    Error::Kind::Unsupported);
    }
    list += (list.empty() ? "" : ", ") + name;
  }
  if (!list.empty()) {
    warnings.push_back("the file requires extensions that are not read: " + list +
                       "; its geometry is drawn without what they add");
  }
  for (const std::string& name : NotRead(document, "extensionsUsed")) {
    if (required.count(name) == 0 && !HidesGeometry(name)) {
      leftOut.push_back("the extension " + name);
    }
  }
}

} // namespace dspace
