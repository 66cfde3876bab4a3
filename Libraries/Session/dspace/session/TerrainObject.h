// Terrain in a scene: a grid that answers, and tiles of it that are drawn.
#ifndef DSPACE_SESSION_TERRAIN_OBJECT_H
#define DSPACE_SESSION_TERRAIN_OBJECT_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/scene/GraphicsObject.h>
#include <dspace/terrain/TerrainMesh.h>

namespace dspace::session {

// Its frame S is the frame that its object hangs on: X east, Y north, Z up, metres.
class TerrainObject {
public:
  // Throws what TerrainMesh throws.
  TerrainObject(std::string name, std::shared_ptr<const GridTerrain> grid,
                std::shared_ptr<const Material> material, std::size_t triangleBudget);

  const std::string& Name() const { return this->Name_; }
  const GridTerrain& Surface() const { return *this->Grid_; }
  const TerrainMeshReport& Report() const { return this->Mesh_.Report(); }
  ObjectId Object() const { return this->Object_; }
  void SetObject(ObjectId object) { this->Object_ = object; }

  // One part a tile that is not empty. Tiles that stayed the same keep their mesh.
  std::vector<DetailLevel> Levels() const;

  // Every post is drawn within `radius` metres of the points (in S). Returns whether the drawing
  // changed. Throws Error(InvalidArgument) and changes nothing.
  bool Focus(const std::vector<Eigen::Vector2d>& points_S, double radius);

  // Map x, y and height above the datum; and back.
  Eigen::Vector3d SceneToMap(const Eigen::Vector3d& p_S) const {
    return this->Grid_->SceneToMap(p_S);
  }

private:
  void TakeTile(std::size_t index);
  std::string Name_;
  std::shared_ptr<const GridTerrain> Grid_;
  std::shared_ptr<const Material> Material_;
  TerrainMesh Mesh_;
  std::vector<Part> Parts_; // a tile; without a mesh where it is empty
  ObjectId Object_ = 0;
};

} // namespace dspace::session

#endif
