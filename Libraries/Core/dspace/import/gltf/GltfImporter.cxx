// ReadGltf: the parts put together.
#include <dspace/import/files/Importers.h>

#include <dspace/import/gltf/GltfDocument.h>
#include <dspace/import/gltf/GltfGeometry.h>
#include <dspace/import/gltf/GltfMaterials.h>
#include <dspace/import/gltf/GltfNodes.h>

namespace dspace {

Model ReadGltf(const std::string& path, const ImportOptions& options) {
  const GltfDocument document(path);
  Model model;
  model.path = path;
  if (!document.Array("skins").empty()) {
    model.warnings.push_back("skins are left out: meshes stand as they were modelled");
  }
  if (!document.Array("animations").empty()) {
    model.warnings.push_back("animations are left out");
  }
  GltfMaterials materials = ReadGltfMaterials(document, model.warnings);
  GltfGeometry geometry = ReadGltfGeometry(document, materials, options, model.warnings);
  model.nodes = ReadGltfNodes(document, geometry.meshesOf);
  model.meshes = std::move(geometry.meshes);
  model.materials = std::move(materials.materials);
  return model;
}

} // namespace dspace
