// The node tree of a glTF file. Internal, not installed.
#ifndef DSPACE_IMPORT_GLTF_NODES_H
#define DSPACE_IMPORT_GLTF_NODES_H

#include <vector>

#include <dspace/import/gltf/GltfDocument.h>
#include <dspace/import/model/Model.h>

namespace dspace {

struct GltfNodes {
  std::vector<ModelNode> nodes; // parents first
  std::vector<int> indexOf;     // of each node of the file, -1: not in the scene
};

// The nodes of the default scene; `meshesOf` as in GltfGeometry. Instances of
// EXT_mesh_gpu_instancing become children of their node, unless the document was opened without
// its buffers. Throws Error(Corrupt).
GltfNodes ReadGltfNodes(const GltfDocument& document,
                        const std::vector<std::vector<int>>& meshesOf);

} // namespace dspace

#endif
