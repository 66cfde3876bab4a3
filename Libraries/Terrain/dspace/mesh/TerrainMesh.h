// A grid terrain as tiles of triangles: full resolution where vehicles are, decimated elsewhere.
#ifndef DSPACE_TERRAIN_TERRAINMESH_H
#define DSPACE_TERRAIN_TERRAINMESH_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <dspace/mesh/MeshQuadtree.h>
#include <dspace/mesh/TerrainTile.h>
#include <dspace/surface/GridTerrain.h>

namespace dspace {

struct TerrainMeshOptions {
  // Triangles of the whole mesh. Far terrain is decimated to what the zones leave of it; zones, the
  // rims of holes and the right and bottom border are kept even where they alone exceed it.
  // Ground with wheel tracks comes on top of it.
  std::size_t triangleBudget = 200000;
  // Part of the budget kept for zones, in [0, 1). While zones fit into it, far terrain stays as it
  // is when they move, and only tiles near them change.
  double zoneShare = 0.25;
  int tileCells = 0; // cells a tile's side: a power of two from 8 to 1024; 0: at most 400 tiles
};

// Where nothing is decimated: all within `radius` metres of a path (one point: a vehicle's place),
// measured in the scene's XY plane.
struct TerrainZone {
  std::vector<Eigen::Vector2d> path_S; // [m], joined by straight lines
  double radius = 0.0;                 // [m]
};

struct TerrainMeshReport {
  std::size_t triangles = 0;
  std::size_t budget = 0;
  bool budgetMet = true;
  double verticalError = 0.0; // [m] bound on |drawn - queried| height at any point of the mesh,
                              // rounding to float left aside
  double roundingXY = 0.0;    // [m] greatest error of a vertex through rounding to float
  double roundingZ = 0.0;
  std::size_t tilesBuilt = 0; // by the last call
};

// The triangles: MeshQuadtree's, hence without cracks or T-junctions, with holes where there is no
// data. Within a zone, and where wheel tracks reach, they are GridTerrain's own. Texture
// coordinates run over the whole raster, pixel edge to pixel edge, so that an image of the raster's
// extent lies right.
//
// The mesh depends only on the options, the current zones and the current tracks, not on history.
// Not synchronised. Tiles are immutable and may be kept.
class TerrainMesh {
public:
  // Throws Error(InvalidArgument) for an option out of range.
  explicit TerrainMesh(std::shared_ptr<const GridTerrain> terrain,
                       const TerrainMeshOptions& options = {});

  // Replaces all zones; returns the indices of the tiles whose content changed. A zone moves in
  // steps of half its radius, or of a cell where that is more, and is larger by as much, so that
  // most small moves change nothing.
  // Throws Error(InvalidArgument) for a path that is empty or not finite, or a radius that is not
  // positive; the mesh is then as before.
  std::vector<std::size_t> SetZones(const std::vector<TerrainZone>& zones);

  // Wheel tracks have changed posts in rectangles of the terrain; returns the indices of the tiles
  // whose content changed.
  std::vector<std::size_t> FollowTracks(const std::vector<PostRectangle>& changed);

  // Row by row; the same number for the life of the mesh.
  const std::vector<std::shared_ptr<const TerrainTile>>& Tiles() const { return this->Tiles_; }
  int GetTileColumns() const { return this->Tree_.GetRootColumns(); }
  int GetTileRows() const { return this->Tree_.GetRootRows(); }
  const TerrainMeshReport& Report() const { return this->Report_; }
  const GridTerrain& Terrain() const { return *this->Terrain_; }

private:
  struct Disc {
    Eigen::Vector2d middle_S;
    double radius;
    bool operator==(const Disc& o) const {
      return this->middle_S == o.middle_S && this->radius == o.radius;
    }
  };

  std::vector<Disc> Discs(const std::vector<TerrainZone>& zones) const;
  double ToleranceFor(std::size_t budget);
  void MarkDiscs();
  std::vector<std::size_t> Rebuild();
  void PinTracks();
  TerrainTile Build(int column, int row, const std::vector<MeshQuadtree::Leaf>& leaves) const;
  void ChooseSteps();

  std::shared_ptr<const GridTerrain> Terrain_;
  TerrainMeshOptions Options_;
  MeshQuadtree Tree_;
  double FarTolerance_ = 0.0; // [m] of the mesh without zones
  double Tolerance_ = 0.0;    // [m] of the mesh with its zones, without tracks
  std::size_t Bare_ = 0;      // triangles of that mesh
  bool Chosen_ = false;       // both are of the current zones
  double StepXY_ = 0.0;       // [m] what positions are multiples of
  double StepZ_ = 0.0;
  std::vector<Disc> Discs_;
  std::vector<std::uint64_t> Tracks_; // a tile's TracksId
  std::vector<std::shared_ptr<const TerrainTile>> Tiles_;
  TerrainMeshReport Report_;
};

} // namespace dspace

#endif
