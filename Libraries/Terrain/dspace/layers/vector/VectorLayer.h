// Polygons, paths and points painted on a terrain.
#ifndef DSPACE_LAYERS_VECTORLAYER_H
#define DSPACE_LAYERS_VECTORLAYER_H

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include <dspace/layers/ColorLayer.h>
#include <dspace/raster/RasterPlace.h>

namespace dspace {

// Colours are sRGB and opacity, 0 to 1. A feature's own "stroke", "stroke-width" (pixels),
// "stroke-opacity", "fill", "fill-opacity", "marker-color" (simplestyle 1.1; colours as #rgb or
// #rrggbb) go before these.
struct VectorLayerOptions {
  // Replaces the file's. Without one the terrain's is taken, with a warning; for GeoJSON its
  // longitude and latitude, if it has them: on the Earth those of WGS 84, without a warning.
  std::optional<std::string> crs;
  std::optional<std::string> layer; // of a file with several; else all of them
  std::array<double, 4> line = {1, 1, 0, 1};
  std::array<double, 4> fill = {1, 1, 0, 0.25};
  // Of lines: metres on the ground where given, (0, 1e7]; else texels of each zoom, which are about
  // pixels of the picture until PixelSize() is reached.
  std::optional<double> width; // [m]
  double pixels = 2.0;         // 0.1 to 64; 0: no lines
  double point = 6.0;          // diameter of points [pixels], or with `width` that many times it;
                               // (0, 256]; in the colour of lines
  std::size_t mostVertices = 10'000'000; // of all features together; long edges count as several
};

// Opens any vector file that OGR reads (GeoJSON, GeoPackage, Shapefile, ...). Edges are straight in
// the file's own CRS; in another they are followed to a quarter of a texel. Areas are even-odd:
// holes stay holes. In longitude and latitude the shorter way leads from one vertex to the next,
// also across the date line; a ring that so goes once around contains the nearer pole. What has no
// place in the terrain's CRS is left out, with a warning. Later features cover earlier ones, lines
// their fills; they mix in linear light. PixelSize() is the least of a thousandth of the extent of
// all of them, a 64th of the smallest area's or path's, a quarter of `width` and the terrain's own
// pixel, but no less than a millionth of the extent and 0.1 mm. Throws Error naming the file:
// NotFound (file, layer), Corrupt, Unsupported (a CRS of another body), InvalidArgument (an option,
// no features, places that are no longitude and latitude, no overlap with the terrain), Resource
// (too many vertices).
std::shared_ptr<const ColorLayer> OpenVectorLayer(const std::string& path,
                                                  const RasterPlace& terrain,
                                                  const VectorLayerOptions& options = {});

} // namespace dspace

#endif
