// Turns the leaves of one tile into vertex arrays. Not a public header.
#ifndef DSPACE_TERRAIN_TILEBUILDER_H
#define DSPACE_TERRAIN_TILEBUILDER_H

#include <cstdint>
#include <vector>

#include <dspace/mesh/MeshQuadtree.h>
#include <dspace/mesh/TerrainTile.h>
#include <dspace/surface/GridTerrain.h>

namespace dspace {

// Least and greatest height of a tile's posts [m].
struct HeightRange {
  double least = 0.0;
  double greatest = 0.0;
  double Size() const { return this->greatest - this->least; }
};
HeightRange TileHeights(const HeightGrid& grid, int column, int row, int cells);

// Of the wheel tracks on a tile's posts and on those beside them, which turn its normals; 0 where
// there are none.
std::uint64_t TracksId(const GridTerrain& terrain, int column, int row, int cells);

// Of a tile's place, triangles and tracks; 0 when it has no triangles.
std::uint64_t ContentId(int column, int row, const std::vector<MeshQuadtree::Leaf>& leaves,
                        std::uint64_t tracks);

class TileBuilder {
public:
  // Positions are rounded to multiples of the steps [m], the tile's origin too.
  TileBuilder(const GridTerrain& terrain, int column, int row, int cells, double stepXY,
              double stepZ);

  void Add(const MeshQuadtree::Leaf& leaf);
  TerrainTile Take();

private:
  std::uint32_t Vertex(int c, int r);
  void Triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  const GridTerrain& Terrain_;
  int FirstC_;
  int FirstR_;
  int Side_; // posts along a side
  double StepXY_;
  double StepZ_;
  bool Mirrored_;                    // the grid's (c, r) and the scene's (x, y) turn the same way
  std::vector<std::uint32_t> Index_; // a post's vertex, or none
  std::vector<float> Rolled_;        // a vertex
  TerrainTile Tile_;
};

} // namespace dspace

#endif
