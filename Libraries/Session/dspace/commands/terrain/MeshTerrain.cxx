#include <dspace/commands/terrain/MeshTerrain.h>

#include <utility>

#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

TerrainMeshOptions WithBudget(std::size_t triangleBudget) {
  TerrainMeshOptions options;
  if (triangleBudget != 0) {
    options.triangleBudget = triangleBudget;
  }
  return options;
}

std::shared_ptr<const Mesh> ToMesh(const TerrainTile& tile) {
  auto mesh = std::make_shared<Mesh>();
  mesh->name = "tile " + std::to_string(tile.column) + ", " + std::to_string(tile.row);
  mesh->positions = tile.positions;
  mesh->normals = tile.normals;
  mesh->tcoords = tile.tcoords;
  mesh->indices = tile.indices;
  return mesh;
}

} // namespace

MeshTerrain::MeshTerrain(std::string name, std::shared_ptr<const GridTerrain> grid,
                         std::shared_ptr<const Material> material, std::size_t triangleBudget)
    : TerrainObject(std::move(name)), Grid_(std::move(grid)), Material_(std::move(material)),
      Mesh_(Grid_, WithBudget(triangleBudget)), Parts_(Mesh_.Tiles().size()) {
  for (std::size_t i = 0; i < this->Parts_.size(); ++i) {
    this->TakeTile(i);
  }
}

void MeshTerrain::TakeTile(std::size_t index) {
  const TerrainTile& tile = *this->Mesh_.Tiles()[index];
  Part& part = this->Parts_[index];
  part.mesh = tile.indices.empty() ? nullptr : ToMesh(tile);
  part.material = this->Material_;
  part.X_OP = Eigen::Affine3d(Eigen::Translation3d(tile.origin_S));
}

std::vector<DetailLevel> MeshTerrain::Levels() const {
  std::vector<DetailLevel> levels(1);
  for (const Part& part : this->Parts_) {
    if (part.mesh) {
      levels[0].parts.push_back(part);
    }
  }
  return levels;
}

bool MeshTerrain::Focus(const std::vector<Eigen::Vector2d>& points_S, double radius) {
  std::vector<TerrainZone> zones;
  zones.reserve(points_S.size());
  for (const Eigen::Vector2d& point : points_S) {
    zones.push_back({{point}, radius});
  }
  const std::vector<std::size_t> changed = this->Mesh_.SetZones(zones);
  for (const std::size_t index : changed) {
    this->TakeTile(index);
  }
  return !changed.empty();
}

void MeshTerrain::Describe(v1::TerrainReply& reply) const {
  TerrainObject::Describe(reply);
  const GridTerrain& grid = *this->Grid_;
  reply.set_mode(v1::OpenTerrain::TRIANGLES);
  reply.set_columns(std::uint32_t(grid.Grid().GetColumns()));
  reply.set_rows(std::uint32_t(grid.Grid().GetRows()));
  reply.set_pixel_width(grid.PixelToMap().linear().col(0).norm());
  reply.set_pixel_height(grid.PixelToMap().linear().col(1).norm());
  reply.set_minimum_height(grid.Grid().GetMinimum());
  reply.set_maximum_height(grid.Grid().GetMaximum());
  const Eigen::Vector2d& origin = grid.Frame().GetOrigin();
  Put(Eigen::Vector3d(origin.x(), origin.y(), grid.Frame().GetOriginHeight()),
      reply.mutable_map_origin());
  reply.set_triangles(this->Report().triangles);
  reply.set_tiles_built(this->Report().tilesBuilt);
  reply.set_vertical_error(this->Report().verticalError);
}

} // namespace dspace::session
