// Interface of layers on a terrain: an image, a raster in false colour, shapes, noise, normals.
#ifndef DSPACE_LAYERS_COLORLAYER_H
#define DSPACE_LAYERS_COLORLAYER_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <dspace/layers/ColorGrid.h>

namespace dspace {

// Texels of a zoom; may lie outside the grid's tiles, and where it is periodic in any turn.
struct ColorBlock {
  int zoom = 0;
  std::int64_t column = 0; // of the first texel
  std::int64_t row = 0;
  int width = 0; // texels
  int height = 0;
};

// What a layer changes: the ground's colour, or the normal that light falls on (NormalTexels.h).
enum class LayerContent : std::uint8_t { Colors, Normals };

// Bytes of a texel: sRGB colour and opacity; or of normals four numbers of 16 bits.
constexpr int TexelBytes(LayerContent content) {
  return content == LayerContent::Normals ? 8 : 4;
}

// Abstract. Immutable; called from several threads at once.
class ColorLayer {
public:
  virtual ~ColorLayer() = default;
  virtual const std::string& GetName() const = 0; // for messages: "image 'mars.tif'"
  virtual LayerContent Content() const { return LayerContent::Colors; }
  // Fills `rgba`, 4 bytes a texel, row by row: sRGB colour and straight opacity; where that is 0
  // the colour is 0, too. Of normals: NormalTexels, 8 bytes a texel, in the axes of ChartAxes. A
  // texel is the mean over its area. Returns false, and writes nothing, if the whole block is
  // transparent. Throws Error when the data cannot be read.
  virtual bool Read(const ColorGrid& grid, const ColorBlock& block, std::uint8_t* rgba) const = 0;
  // Size of its finest detail [m] on the ground: closer texels show nothing more. Infinity where
  // any zoom will do.
  virtual double PixelSize() const = 0;
  // Memory of a file that is decoded as a whole [bytes].
  virtual std::size_t KeptBytes() const { return 0; }
  // Assumptions made at opening; each names the option that replaces it.
  virtual const std::vector<std::string>& Warnings() const = 0;
};

} // namespace dspace

#endif
