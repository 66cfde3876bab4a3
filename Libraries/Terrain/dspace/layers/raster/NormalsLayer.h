// Rasters of normals, of any size and in any CRS, read as tiles.
#ifndef DSPACE_LAYERS_NORMALSLAYER_H
#define DSPACE_LAYERS_NORMALSLAYER_H

#include <memory>
#include <string>

#include <dspace/layers/raster/ImageLayer.h>

namespace dspace {

// Which way x and y of a raster's normals run. z is up in both.
enum class NormalAxes {
  Map,  // along map x and y of the raster's CRS
  Local // east and north
};

// Three bands of one type, x, y and z of unit vectors out of the ground: 8 or 16 bits without a
// scale are coded, n = 2 v / 255 - 1 or 2 v / 65535 - 1; other types, and with a scale or offset of
// the file, are the numbers from -1 to 1. Lengths from 0.5 to 1.1 are made 1; z is at least 0, to
// 0.01. All pixels are checked at opening, of more than 16 million some rows; the others when they
// are read. No data in all three bands, or NaN in one, is transparent. A texel is the mean, made 1
// long, placed as an ImageLayer's, and turned into the axes of the terrain's chart.
//
// Throws Error as OpenImageLayer does; also Unsupported (bands; Map axes of another CRS than the
// terrain's that are not at right angles on the ground to a degree; Local axes on a terrain without
// longitude and latitude) and Corrupt (a vector that is no normal, also when it is read).
std::shared_ptr<const ColorLayer> OpenNormalsLayer(const std::string& path,
                                                   const RasterPlace& terrain, NormalAxes axes,
                                                   const RasterLayerOptions& options = {});

} // namespace dspace

#endif
