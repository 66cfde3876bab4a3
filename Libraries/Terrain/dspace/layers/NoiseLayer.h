// Structure below the data's resolution: it looks like ground and measures nothing.
#ifndef DSPACE_LAYERS_NOISELAYER_H
#define DSPACE_LAYERS_NOISELAYER_H

#include <array>
#include <cstdint>
#include <memory>

#include <dspace/layers/ColorLayer.h>

namespace dspace {

// Perlin's improved gradient noise (SIGGRAPH 2002) in octaves of halved wavelength, over the
// scene's own metres: the same for the same seed on every machine, at every zoom, across charts.
struct NoiseOptions {
  double wavelength = 10.0; // [m] of the longest octave, 1e-3 to 1e7
  int octaves = 6;          // 1 to 16; those shorter than two texels or posts are left out
  double gain = 0.5;        // amplitude of an octave over that of the one before it, (0, 1]
  std::uint32_t seed = 0;
};

// Darkens (black) and brightens (white) by up to `contrast` (0 to 1) in opacity.
std::shared_ptr<const ColorLayer> MakeNoiseLayer(const NoiseOptions& options, double contrast);

} // namespace dspace

#endif
