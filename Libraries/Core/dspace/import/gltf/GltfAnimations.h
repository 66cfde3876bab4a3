// Animations of a glTF file. Internal, not installed.
#ifndef DSPACE_IMPORT_GLTF_ANIMATIONS_H
#define DSPACE_IMPORT_GLTF_ANIMATIONS_H

#include <string>
#include <vector>

#include <dspace/import/gltf/GltfDocument.h>
#include <dspace/import/model/Model.h>

namespace dspace {

// The animations that move nodes of the scene; `indexOf` as in GltfNodes. Channels that move
// anything else (morph targets, properties of extensions) are named in `leftOut`.
// Throws Error(Corrupt), naming the animation and the channel.
std::vector<ModelAnimation> ReadGltfAnimations(const GltfDocument& document,
                                               const std::vector<int>& indexOf,
                                               std::vector<std::string>& leftOut);

} // namespace dspace

#endif
