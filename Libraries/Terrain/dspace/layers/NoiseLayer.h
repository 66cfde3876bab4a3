// Structure below the data's resolution: it looks like ground and measures nothing.
#ifndef DSPACE_LAYERS_NOISELAYER_H
#define DSPACE_LAYERS_NOISELAYER_H

#include <memory>

#include <dspace/layers/ColorLayer.h>
#include <dspace/layers/PerlinNoise.h>

namespace dspace {

// Noise over the scene's own metres, at a texel's centre on the ground of height 0: the same for
// the same seed on every machine, at every zoom (but for what it is too coarse to show), across
// charts, the date line and the poles. Darkens (black) and brightens (white) with an opacity of
// `contrast` (0 to 1) times the noise over the sum of its gains; a third of that where it is
// already strong. Octaves shorter than two texels are left out and come in up to four.
// PixelSize() is a quarter of the shortest wavelength. Throws Error(InvalidArgument).
std::shared_ptr<const ColorLayer> MakeNoiseLayer(const NoiseOptions& options, double contrast);

} // namespace dspace

#endif
