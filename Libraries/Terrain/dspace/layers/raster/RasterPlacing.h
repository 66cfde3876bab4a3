// Where a raster lies against a terrain. Not for public headers.
#ifndef DSPACE_LAYERS_RASTERPLACING_H
#define DSPACE_LAYERS_RASTERPLACING_H

#include <dspace/layers/raster/BlockSampler.h>

namespace dspace {

struct RasterPlace;

struct PlacedRaster {
  RasterPosition position;
  double pixelSize = 0.0; // the lesser side [m] of a pixel, in the middle of what meets the terrain
};

// Adds what is assumed to the raster's warnings. Throws Error as ImageLayer.h says.
PlacedRaster PlaceRaster(RasterLevels& levels, const RasterPlace& terrain,
                         const RasterLayerOptions& options);

// The same, of a place that is known.
PlacedRaster PlaceRasterAt(RasterLevels& levels, const RasterPlace& terrain, const Crs& crs,
                           Eigen::Affine2d pixelToMap);

} // namespace dspace

#endif
