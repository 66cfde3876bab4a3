// Marks filled ground of a terrain, where the raster has no data.
#ifndef DSPACE_LAYERS_FILLEDLAYER_H
#define DSPACE_LAYERS_FILLEDLAYER_H

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <dspace/layers/ColorLayer.h>
#include <dspace/raster/ElevationSource.h>
#include <dspace/raster/RasterPlace.h>

namespace dspace {

struct FilledLayerOptions {
  std::array<double, 3> color = {1.0, 0.0, 1.0}; // sRGB, 0 to 1
  NetworkLimits network;
  std::string cacheFolder; // for averaged overviews, see RasterLayerOptions
};

// A raster that lies on the terrain's: where it has data, nothing is filled.
struct FilledLayerPatch {
  std::string path;
  int band = 1;
  std::optional<std::string> crs; // replaces the file's
};

// Opacity is the share of the texel that has no data: of the bilinear surface between pixels that
// are 1 without data and 0 with them, so that at a rim it rises within one pixel. Nothing outside
// the raster. `band` is of the raster at `path`; `terrain` is the place of its pixels `window`.
// Patches leave out as much as they cover; one that cannot be placed on the terrain is passed over.
// Throws Error as OpenFalseColorLayer does.
std::shared_ptr<const ColorLayer>
OpenFilledLayer(const std::string& path, int band, const RasterPlace& terrain,
                const RasterWindow& window, const FilledLayerOptions& options = {},
                const std::vector<FilledLayerPatch>& patches = {});

} // namespace dspace

#endif
