// The node tree of a glTF file. Internal, not installed.
#ifndef DSPACE_IMPORT_GLTF_NODES_H
#define DSPACE_IMPORT_GLTF_NODES_H

#include <vector>

#include <dspace/import/gltf/GltfDocument.h>
#include <dspace/import/model/Model.h>

namespace dspace {

// The nodes of the default scene, parents first; `meshesOf` as in GltfGeometry. Throws
// Error(Corrupt).
std::vector<ModelNode> ReadGltfNodes(const GltfDocument& document,
                                     const std::vector<std::vector<int>>& meshesOf);

} // namespace dspace

#endif
