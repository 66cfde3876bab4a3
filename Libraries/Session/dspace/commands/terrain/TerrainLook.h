// How a terrain that is opened looks: a colour, an image laid on it, shaded relief.
#ifndef DSPACE_SESSION_TERRAIN_LOOK_H
#define DSPACE_SESSION_TERRAIN_LOOK_H

#include <memory>
#include <string>

#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/layers/ColorRamp.h>
#include <dspace/mesh/DrapeImage.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace::session {

// A path of GDAL's need not be a file ("/vsicurl/...", "PDS4:..."): only files are made absolute.
std::string AbsoluteRaster(const std::string& path);

// Of a mesh: its texture coordinates run over the raster. Paths in the command are made absolute,
// warnings go to the reply.
std::shared_ptr<const Material> MeshMaterial(const Context& context, const GridTerrain& grid,
                                             v1::OpenTerrain& command);

// Of a clipmap: its material, under its colour layers. Relief is the scene's own light on the
// posts' normals; its sun's angles are refused.
ClipmapOptions ClipmapLook(const StreamedTerrain& surface, const v1::OpenTerrain& command);

// A row of pixels: the ramp's colours, evenly spaced, linear between. At least one colour.
std::shared_ptr<const Image> RampImage(const ColorRamp& ramp);

} // namespace dspace::session

#endif
