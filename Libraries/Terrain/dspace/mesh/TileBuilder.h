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

// Of a tile's place and triangles; 0 when it has none. The grid itself never changes.
std::uint64_t ContentId(int column, int row, const std::vector<MeshQuadtree::Leaf>& leaves);

class TileBuilder {
public:
  // Positions are rounded to multiples of the steps [m], the tile's origin too.
  TileBuilder(const GridTerrain& terrain, int column, int row, int cells, double stepXY,
              double stepZ);

  void Add(const MeshQuadtree::Leaf& leaf);
  TerrainTile Take() { return std::move(this->Tile_); }

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
  TerrainTile Tile_;
};

} // namespace dspace

#endif
