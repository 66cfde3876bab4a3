// Typed views of a glTF file's buffers: internal.
#ifndef DSPACE_IMPORT_GLTF_ACCESSOR_H
#define DSPACE_IMPORT_GLTF_ACCESSOR_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <dspace/import/gltf/GltfDocument.h>

namespace dspace {

// One accessor (section 5.1) whose ranges have been checked.
struct GltfAccessor {
  static constexpr int Float = 5126;

  std::size_t index = 0;
  int componentType = 0;
  std::string type; // SCALAR, VEC2, VEC3, VEC4
  std::size_t components = 0;
  std::size_t count = 0;
  bool normalized = false;
  bool hasView = false;
  bool sparse = false;

  std::size_t ComponentSize() const;
};

// Reads and checks accessor `index`: known types, and every byte it names inside its buffer view,
// also the sparse ones. Throws Error(Corrupt); Error(Resource) for more than `maximumCount`.
GltfAccessor CheckGltfAccessor(const GltfDocument& document, std::size_t index,
                               std::size_t maximumCount);

// Its values as floats: integers are scaled to [-1, 1] or [0, 1] when `normalized` (section 3.11),
// else taken as they are (KHR_mesh_quantization); zeros where it has no buffer view; sparse values
// applied. `components` numbers an element; those beyond the accessor's own are `fill`.
std::vector<float> GltfAccessorFloats(const GltfDocument& document, const GltfAccessor& accessor,
                                      std::size_t components, float fill);

// Largest value of an accessor of unsigned integers that has a buffer view; exact.
std::uint32_t GltfAccessorMaximum(const GltfDocument& document, const GltfAccessor& accessor);

} // namespace dspace

#endif
