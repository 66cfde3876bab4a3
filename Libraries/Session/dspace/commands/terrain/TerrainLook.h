// The appearance of a terrain: a colour, an image, shaded relief.
#ifndef DSPACE_SESSION_TERRAIN_LOOK_H
#define DSPACE_SESSION_TERRAIN_LOOK_H

#include <memory>
#include <string>

#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/mesh/DrapeImage.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace::session {

// Makes the path of a file absolute. Other names of GDAL ("/vsicurl/...", "PDS4:...") are
// unchanged.
std::string AbsoluteRaster(const std::string& path);

// The material of a mesh, whose texture coordinates cover the raster. Makes paths in the command
// absolute; warnings go to the reply.
std::shared_ptr<const Material> MeshMaterial(const Context& context, const GridTerrain& grid,
                                             v1::OpenTerrain& command);

// The material of a clipmap, under its colour layers. Relief is the scene's own light on the posts'
// normals; sun angles are rejected.
ClipmapOptions ClipmapLook(const StreamedTerrain& surface, const v1::OpenTerrain& command);

// A row of pixels: the ramp's colours, evenly spaced, linear between. At least one colour.
std::shared_ptr<const Image> RampImage(const ColorRamp& ramp);

} // namespace dspace::session

#endif
