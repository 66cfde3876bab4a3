// The step of reading glTF geometry that Assimp does: internal.
#ifndef DSPACE_IMPORT_GLTF_DECODER_H
#define DSPACE_IMPORT_GLTF_DECODER_H

#include <cstddef>
#include <string>
#include <vector>

#include <json/json.h>

#include <dspace/import/gltf/GltfDocument.h>
#include <dspace/import/gltf/GltfMaterials.h>

namespace dspace {

// One primitive of the file, as the document for Assimp has it.
struct GltfPrimitive {
  std::string name;
  std::string where;
  int material = -1;
  bool draco = false;
  std::size_t mode = 4;     // section 5.24.4: 0 points, ... 4 triangles, ... 6 fan
  std::size_t vertices = 0; // as the file says
  std::size_t corners = 0;  // indices, or vertices where there are none

  // Faces, lines or points that the corners make.
  std::size_t FaceCount() const {
    switch (this->mode) {
    case 0:
    case 2: // a loop has as many lines as corners
      return this->corners;
    case 1:
      return this->corners / 2;
    case 3:
      return this->corners > 1 ? this->corners - 1 : 0;
    case 4:
      return this->corners / 3;
    default:
      return this->corners > 2 ? this->corners - 2 : 0;
    }
  }
};

// A glTF document of our own making: one mesh a primitive, named "p0", "p1", ..., each on a node of
// its own; without its buffers, which are the file's and then `extra`.
struct GltfRequest {
  Json::Value json;
  std::string extra;
  std::vector<GltfPrimitive> primitives;
};

// Decodes a request through Assimp, one mesh a primitive. Throws Error(Corrupt) where Assimp
// rejects, or gives other counts than the file says.
std::vector<Mesh> DecodeGltf(const GltfDocument& document, const GltfMaterials& materials,
                             GltfRequest& request, std::vector<std::string>& warnings);

} // namespace dspace

#endif
