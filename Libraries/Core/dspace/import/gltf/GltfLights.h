// KHR_lights_punctual. Internal, not installed.
#ifndef DSPACE_IMPORT_GLTF_LIGHTS_H
#define DSPACE_IMPORT_GLTF_LIGHTS_H

#include <vector>

#include <dspace/import/gltf/GltfDocument.h>
#include <dspace/import/model/Model.h>

namespace dspace {

// One light for each node that has one; `indexOf` as in GltfNodes. Throws Error(Corrupt).
std::vector<ModelLight> ReadGltfLights(const GltfDocument& document,
                                       const std::vector<int>& indexOf);

} // namespace dspace

#endif
