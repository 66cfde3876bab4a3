// Terrain as triangle tiles within a budget.
#ifndef DSPACE_SESSION_MESH_TERRAIN_H
#define DSPACE_SESSION_MESH_TERRAIN_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/mesh/TerrainMesh.h>
#include <dspace/state/TerrainObject.h>

namespace dspace::session {

// Its frame S: X east, Y north, Z up, metres.
class MeshTerrain : public TerrainObject {
public:
  // Throws what TerrainMesh throws.
  MeshTerrain(std::string name, std::shared_ptr<const GridTerrain> grid,
              std::shared_ptr<const Material> material, std::size_t triangleBudget);

  const GridTerrain& Surface() const override { return *this->Grid_; }
  const TerrainMeshReport& Report() const { return this->Mesh_.Report(); }
  // One part a tile that is not empty. Tiles that stayed the same keep their mesh.
  std::vector<DetailLevel> Levels() const;
  void Draw(GraphicsObject& object) const override { object.levels = this->Levels(); }
  void Describe(v1::TerrainReply& reply) const override;
  bool Focus(const std::vector<Eigen::Vector2d>& points_S, double radius) override;

private:
  void TakeTile(std::size_t index);
  std::shared_ptr<const GridTerrain> Grid_;
  std::shared_ptr<const Material> Material_;
  TerrainMesh Mesh_;
  std::vector<Part> Parts_; // a tile; without a mesh where it is empty
};

} // namespace dspace::session

#endif
