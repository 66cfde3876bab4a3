// A piece of terrain, ready to draw: plain arrays, free of any renderer.
#ifndef DSPACE_TERRAIN_TERRAINTILE_H
#define DSPACE_TERRAIN_TERRAINTILE_H

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

namespace dspace {

// Immutable once made. A vertex in the scene is origin_S + its float position: both are multiples
// of one step (TerrainMeshReport), so that the sum is exact in double and two tiles that share a
// post have it at the same place to the last bit.
struct TerrainTile {
  std::uint64_t id = 0; // of the content: equal ids, equal arrays; 0 for an empty tile
  int column = 0;       // place among the mesh's tiles; (0, 0) holds post (0, 0)
  int row = 0;
  Eigen::Vector3d origin_S = Eigen::Vector3d::Zero(); // [m]
  Eigen::AlignedBox3d bounds_S;       // of the vertices [m]; empty for an empty tile
  std::vector<float> positions;       // x y z a vertex [m], relative to origin_S
  std::vector<float> normals;         // x y z a vertex, unit, from the full-resolution grid
  std::vector<float> tcoords;         // u v a vertex; (0, 0) the raster's bottom-left CORNER
  std::vector<std::uint32_t> indices; // three a triangle, counter-clockwise seen from above
  std::vector<float> rolled;          // a vertex: how much wheels rolled over it, 0 to 1; or empty
  double verticalError = 0.0; // [m] greatest difference between these triangles and the grid's

  std::size_t VertexCount() const { return this->positions.size() / 3; }
  std::size_t TriangleCount() const { return this->indices.size() / 3; }
};

} // namespace dspace

#endif
