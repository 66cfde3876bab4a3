// Colour images that lie on a terrain.
#ifndef DSPACE_TERRAIN_DRAPEIMAGE_H
#define DSPACE_TERRAIN_DRAPEIMAGE_H

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <dspace/raster/RasterPlace.h>
#include <dspace/surface/GridTerrain.h>

namespace dspace {

// RGB, 8 bits a channel, sRGB-encoded; row 0 is the top row, rows tightly packed. It covers the
// terrain's raster from pixel edge to pixel edge: tile texture coordinates (0, 0) are the
// bottom-left corner of its bottom row, (1, 1) the top-right corner of its top row.
struct DrapeImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;   // r g b
  std::vector<std::uint8_t> coverage; // empty, or one a pixel: 0 where the image had nothing
  std::vector<std::string> warnings;
};

// Where the terrain's raster lies.
RasterPlace PlaceOf(const GridTerrain& terrain);

// `top` where it has coverage, else `bottom` (its nearest pixel), in the size of `top`: an image of
// a part of the terrain over the relief of all of it.
DrapeImage Over(const DrapeImage& top, const DrapeImage& bottom);

// Width and height of a drape image of a raster, at most `maximumSize` a side; throws
// Error(InvalidArgument) unless 1 <= maximumSize <= 32768.
std::array<int, 2> DrapeSize(int columns, int rows, int maximumSize);

} // namespace dspace

#endif
