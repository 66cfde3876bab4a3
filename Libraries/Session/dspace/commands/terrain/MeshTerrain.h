// Terrain as triangle tiles within a budget.
#ifndef DSPACE_SESSION_MESH_TERRAIN_H
#define DSPACE_SESSION_MESH_TERRAIN_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/commands/terrain/TerrainLayers.h>
#include <dspace/mesh/TerrainMesh.h>
#include <dspace/state/TerrainObject.h>

namespace dspace::session {

// Its frame S: X east, Y north, Z up, metres.
class MeshTerrain : public TerrainObject {
public:
  // Throws what TerrainMesh throws.
  MeshTerrain(std::string name, std::shared_ptr<GridTerrain> grid,
              std::shared_ptr<const Material> material, std::size_t triangleBudget);

  const GridTerrain& Surface() const override { return *this->Grid_; }
  std::shared_ptr<const TerrainSurface> HeldSurface() const override { return this->Grid_; }
  const GridTerrain& Undisturbed() const override { return this->Grid_->Undisturbed(); }
  TrackedGround& Ground() override { return *this->Grid_; }
  bool FollowTracks() override;
  const TerrainMeshReport& Report() const { return this->Mesh_.Report(); }
  // One part a tile that is not empty. Tiles that stayed the same keep their mesh.
  std::vector<DetailLevel> Levels() const;
  // Its layers, all of them of normals.
  TerrainLayers& Layers() { return this->Layers_; }
  void DescribeLayers(v1::TerrainLayerList& list) const;
  // Reads the layers again, so that the parts show what the stack has now. Throws what reading
  // throws, and then shows what it did before.
  void ShowLayers();
  RasterPlace Place() const override;
  void Draw(GraphicsObject& object) const override { object.levels = this->Levels(); }
  std::vector<Part> Triangles(std::size_t triangleBudget) const override;
  void Describe(v1::TerrainReply& reply) const override;
  bool Focus(const std::vector<Eigen::Vector2d>& points_S, double radius) override;

private:
  Part ToPart(const TerrainTile& tile) const;
  bool Take(const std::vector<std::size_t>& changed); // tiles

  std::shared_ptr<GridTerrain> Grid_;
  std::shared_ptr<const Material> Material_;
  TerrainLayers Layers_;
  TerrainMesh Mesh_;
  std::vector<Part> Parts_; // a tile; without a mesh where it is empty
};

} // namespace dspace::session

#endif
