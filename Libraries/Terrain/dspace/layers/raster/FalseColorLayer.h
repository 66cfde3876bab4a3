// Rasters in false colour, of any size and in any CRS, read as tiles.
#ifndef DSPACE_LAYERS_FALSECOLORLAYER_H
#define DSPACE_LAYERS_FALSECOLORLAYER_H

#include <array>
#include <memory>
#include <optional>
#include <string>

#include <dspace/layers/raster/ImageLayer.h>

namespace dspace {

// One band of any type through a colour ramp, linear between its colours, beyond its ends their
// colours; no data is transparent. Values are means before they are coloured; the file's scale and
// offset are applied.
struct FalseColorOptions {
  int band = 1;
  ColorRamp ramp = TerrainRamp();
  std::optional<double> low; // of the band's values; its least and greatest by default
  std::optional<double> high;
};

class FalseColorLayer : public ColorLayer {
public:
  virtual const std::array<double, 2>& Range() const = 0; // of the ramp's ends
  virtual const ColorRamp& Ramp() const = 0;
  virtual const std::string& Unit() const = 0; // as the file states it; may be empty
};

std::shared_ptr<const FalseColorLayer> OpenFalseColorLayer(const std::string& path,
                                                           const RasterPlace& terrain,
                                                           const FalseColorOptions& colors,
                                                           const RasterLayerOptions& options = {});

} // namespace dspace

#endif
