// How tiles of layers of normals are composed. Not for public headers.
#ifndef DSPACE_LAYERS_NORMALCOMPOSER_H
#define DSPACE_LAYERS_NORMALCOMPOSER_H

#include <cstdint>
#include <vector>

#include <dspace/layers/NormalTexels.h>

namespace dspace {

// Bottom up: a layer's normals, blended by opacity with the sum of those below.
class NormalComposer {
public:
  // NormalTexels of a tile (ColorTiles::Side x Side); or nothing.
  void Add(const std::vector<std::uint8_t>& texels, double opacity);
  // NormalTexels; empty where all of it is transparent.
  std::vector<std::uint8_t> Encode() const;

private:
  std::vector<NormalTexel> Sums_; // empty: nothing yet
};

} // namespace dspace

#endif
