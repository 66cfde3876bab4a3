// Meshes of a glTF file. Internal, not installed.
#ifndef DSPACE_IMPORT_GLTF_GEOMETRY_H
#define DSPACE_IMPORT_GLTF_GEOMETRY_H

#include <string>
#include <vector>

#include <dspace/import/files/ModelReader.h>
#include <dspace/import/gltf/GltfDocument.h>
#include <dspace/import/gltf/GltfMaterials.h>

namespace dspace {

// The meshes of the document, one dspace::Mesh a primitive.
struct GltfGeometry {
  std::vector<Mesh> meshes;
  std::vector<std::vector<int>> meshesOf; // for each mesh of the file, indices into `meshes`
};

GltfGeometry ReadGltfGeometry(const GltfDocument& document, const GltfMaterials& materials,
                              const ImportOptions& options, std::vector<std::string>& warnings);

} // namespace dspace

#endif
