// The extensions of a glTF file that are read, and what the others leave out. Internal.
#ifndef DSPACE_IMPORT_GLTF_EXTENSIONS_H
#define DSPACE_IMPORT_GLTF_EXTENSIONS_H

#include <string>
#include <vector>

#include <dspace/import/gltf/GltfDocument.h>

namespace dspace {

// Throws Error(Unsupported), naming the extension, where the file requires one that its geometry
// cannot be decoded without (a compression other than Draco's). Adds one warning for the others
// that it requires and that are not read, and names those that it merely uses in `leftOut`.
void CheckGltfExtensions(const GltfDocument& document, std::vector<std::string>& warnings,
                         std::vector<std::string>& leftOut);

} // namespace dspace

#endif
