// One layer's texels of a tile, and how those of a stack are composed. Not for public headers.
#ifndef DSPACE_LAYERS_LAYERTILES_H
#define DSPACE_LAYERS_LAYERTILES_H

#include <cstdint>
#include <vector>

#include <dspace/layers/ColorTiles.h>

namespace dspace {

// Whether any ground lies in the tile or next to it.
bool HasGround(const ColorGrid& grid, const ColorTile& tile);

// ColorTiles::Side x Side texels as ColorLayer::Read gives them, of colours or of normals; empty
// where there is nothing. The
// first texels outside the ground are those of its edge, so that interpolation does not bring in
// what is outside.
std::vector<std::uint8_t> ReadLayerTile(const ColorLayer& layer, const ColorGrid& grid,
                                        const ColorTile& tile);

// Bottom up, "over" in linear light.
class TileComposer {
public:
  void Add(const std::vector<std::uint8_t>& rgba, double opacity);
  // As ColorTiles::Tile::texels.
  std::vector<std::uint8_t> Encode() const;

private:
  std::vector<float> Sums_; // colour times opacity, opacity; empty: nothing yet
};

} // namespace dspace

#endif
