// Polygons, paths and points painted on a terrain.
#ifndef DSPACE_LAYERS_VECTORLAYER_H
#define DSPACE_LAYERS_VECTORLAYER_H

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include <dspace/layers/ColorLayer.h>
#include <dspace/terrain/DrapeImage.h>

namespace dspace {

// Colours are sRGB and opacity, 0 to 1. A feature's own "stroke", "stroke-width" (pixels),
// "stroke-opacity", "fill", "fill-opacity", "marker-color" (simplestyle 1.1) go before these.
struct VectorLayerOptions {
  std::optional<std::string> crs;   // replaces the file's; GeoJSON without one: the terrain's
  std::optional<std::string> layer; // of a file with several; else all of them
  std::array<double, 4> line = {1, 1, 0, 1};
  std::array<double, 4> fill = {1, 1, 0, 0.25};
  // Of lines: metres on the ground where given, else pixels of the picture, about.
  std::optional<double> width; // [m]
  double pixels = 2.0;         // 0.1 to 64; 0: no lines
  double point = 6.0;          // diameter of points [pixels], or with `width` that many times it
  std::size_t mostVertices = 10'000'000; // of all features together
};

// Whatever OGR opens (GeoJSON, GeoPackage, Shapefile, ...). Edges are straight in the file's own
// CRS; lines that are long in another are cut until they follow it to a quarter of a texel. Holes
// of polygons stay holes; shapes may cross the date line and contain a pole. Throws Error naming
// the file: NotFound, Corrupt, Unsupported (a CRS of another body), InvalidArgument (an option, no
// features, no overlap with the terrain), Resource (too many vertices).
std::shared_ptr<const ColorLayer> OpenVectorLayer(const std::string& path,
                                                  const RasterPlace& terrain,
                                                  const VectorLayerOptions& options = {});

} // namespace dspace

#endif
