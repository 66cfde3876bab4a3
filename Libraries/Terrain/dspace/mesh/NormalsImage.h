// Layers of normals as one image over a terrain of triangles.
#ifndef DSPACE_MESH_NORMALSIMAGE_H
#define DSPACE_MESH_NORMALSIMAGE_H

#include <memory>
#include <vector>

#include <dspace/import/model/Model.h>
#include <dspace/layers/LayerStack.h>
#include <dspace/surface/GridTerrain.h>

namespace dspace {

// The layers of normals that are visible, bottom first, in the axes of the terrain's scene frame,
// as Material::normalTexture has them with four channels. It covers the raster as a DrapeImage
// does, with pixels as fine as the finest layer's, at most `maximumSize` along a side. 8 bits a
// channel: light is right to 0.007. Null where no layer is visible. Throws what ColorLayer::Read
// throws, and Error(InvalidArgument) as DrapeSize does.
std::shared_ptr<const Image> NormalsImage(const GridTerrain& terrain,
                                          const std::vector<StackedLayer>& layers,
                                          int maximumSize = 4096);

} // namespace dspace

#endif
