// A clipmap's ground as triangles, for exports and for VTK.
#ifndef DSPACE_SESSION_CLIPMAP_MESH_H
#define DSPACE_SESSION_CLIPMAP_MESH_H

#include <cstddef>
#include <vector>

#include <dspace/clipmap/ClipmapTerrain.h>

namespace dspace::session {

// The posts of the finest level whose cells make at most `triangleBudget` triangles; of the
// coarsest level where that is not enough. They lie where drawing and queries have them; holes
// stay. Parts of at most 256 x 256 cells, each relative to its own origin, with normals, and
// texture coordinates for one image: the material's texture with the colour layers on top, at most
// 4096 texels a side. Styles (ramps, contours, grids, details) are left out. Waits for data; throws
// what reading them throws.
std::vector<Part> ClipmapMesh(const ClipmapTerrain& terrain, std::size_t triangleBudget);

} // namespace dspace::session

#endif
