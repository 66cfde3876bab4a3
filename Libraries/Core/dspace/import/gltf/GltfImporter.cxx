// ReadGltf: the parts put together.
#include <dspace/import/files/Importers.h>

#include <dspace/import/gltf/GltfAnimations.h>
#include <dspace/import/gltf/GltfDocument.h>
#include <dspace/import/gltf/GltfExtensions.h>
#include <dspace/import/gltf/GltfGeometry.h>
#include <dspace/import/gltf/GltfLights.h>
#include <dspace/import/gltf/GltfMaterials.h>
#include <dspace/import/gltf/GltfNodes.h>

namespace dspace {

namespace {

void NoteCount(std::size_t count, const std::string& one, const std::string& many,
               std::vector<std::string>& leftOut) {
  if (count > 0) {
    leftOut.push_back(std::to_string(count) + " " + (count == 1 ? one : many));
  }
}

std::size_t MorphedMeshes(const GltfDocument& document) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < document.Array("meshes").size(); ++i) {
    const Json::Value& primitives = document.Element("meshes", i)["primitives"];
    count += primitives.isArray() && !primitives.empty() && primitives[0].isObject() &&
             !primitives[0]["targets"].isNull();
  }
  return count;
}

} // namespace

Model ReadGltf(const std::string& path, const ImportOptions& options) {
  const GltfDocument document(path);
  Model model;
  model.path = path;
  CheckGltfExtensions(document, model.warnings, model.leftOut);
  GltfMaterials materials = ReadGltfMaterials(document, model.warnings);
  GltfGeometry geometry = ReadGltfGeometry(document, materials, options, model.warnings);
  GltfNodes nodes = ReadGltfNodes(document, geometry.meshesOf);
  model.lights = ReadGltfLights(document, nodes.indexOf);
  model.animations = ReadGltfAnimations(document, nodes.indexOf, model.leftOut);
  NoteCount(document.Array("cameras").size(), "camera", "cameras", model.leftOut);
  NoteCount(document.Array("skins").size(), "skin (meshes stand as they were modelled)",
            "skins (meshes stand as they were modelled)", model.leftOut);
  NoteCount(MorphedMeshes(document), "mesh's morph targets", "meshes' morph targets",
            model.leftOut);
  model.nodes = std::move(nodes.nodes);
  model.meshes = std::move(geometry.meshes);
  model.materials = std::move(materials.materials);
  return model;
}

} // namespace dspace
