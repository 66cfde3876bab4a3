// Materials and textures of a glTF file. Internal, not installed.
#ifndef DSPACE_IMPORT_GLTF_MATERIALS_H
#define DSPACE_IMPORT_GLTF_MATERIALS_H

#include <string>
#include <vector>

#include <dspace/import/gltf/GltfDocument.h>
#include <dspace/import/model/Model.h>

namespace dspace {

// How a material's base colour texture finds its place on a mesh.
struct GltfTextureUse {
  std::size_t set = 0;                                     // TEXCOORD_<set>
  Eigen::Affine2d transform = Eigen::Affine2d::Identity(); // KHR_texture_transform, in glTF's u v
};

struct GltfMaterials {
  std::vector<Material> materials;
  std::vector<GltfTextureUse> uses; // one a material
  std::vector<bool> opaque;         // alpha of vertex colours is to be ignored
};

GltfMaterials ReadGltfMaterials(const GltfDocument& document, std::vector<std::string>& warnings);

} // namespace dspace

#endif
