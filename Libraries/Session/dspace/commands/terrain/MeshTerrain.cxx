#include <dspace/commands/terrain/MeshTerrain.h>

#include <cmath>
#include <cstdint>
#include <utility>

#include <dspace/clipmap/ClipmapStyle.h>
#include <dspace/mesh/DrapeImage.h>
#include <dspace/mesh/NormalsImage.h>
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

// sRGB of linear light above the curve's straight foot.
double SrgbFromLinear(double light) {
  return 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
}

std::shared_ptr<const Mesh> ToMesh(const TerrainTile& tile) {
  auto mesh = std::make_shared<Mesh>();
  mesh->name = "tile " + std::to_string(tile.column) + ", " + std::to_string(tile.row);
  mesh->positions = tile.positions;
  mesh->normals = tile.normals;
  mesh->tcoords = tile.tcoords;
  mesh->indices = tile.indices;
  for (const float rolled : tile.rolled) { // as the standard style of a clipmap: black over it
    const double light = 1.0 - ClipmapStyle::Tracks().opacity * double(rolled);
    const auto level = std::uint8_t(std::lround(255.0 * SrgbFromLinear(light)));
    mesh->colors.insert(mesh->colors.end(), {level, level, level, 255});
  }
  return mesh;
}

} // namespace

MeshTerrain::MeshTerrain(std::string name, std::shared_ptr<GridTerrain> grid,
                         std::shared_ptr<const Material> material, std::size_t triangleBudget)
    : TerrainObject(name), Grid_(std::move(grid)), Material_(std::move(material)),
      Layers_(name, std::make_shared<LayerStack>("terrain '" + name + "'")),
      Mesh_(Grid_, WithBudget(triangleBudget)), Parts_(Mesh_.Tiles().size()) {
  for (std::size_t i = 0; i < this->Parts_.size(); ++i) {
    this->Parts_[i] = this->ToPart(*this->Mesh_.Tiles()[i]);
  }
}

Part MeshTerrain::ToPart(const TerrainTile& tile) const {
  Part part;
  part.mesh = tile.indices.empty() ? nullptr : ToMesh(tile);
  part.material = this->Material_;
  part.X_OP = Eigen::Affine3d(Eigen::Translation3d(tile.origin_S));
  return part;
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

void MeshTerrain::DescribeLayers(v1::TerrainLayerList& list) const {
  this->Layers_.Describe(list);
  const std::shared_ptr<const Image>& normals = this->Material_->normalTexture;
  list.set_bytes(normals ? normals->pixels.size() : 0);
}

void MeshTerrain::ShowLayers() {
  auto material = std::make_shared<Material>(*this->Material_);
  material->normalTexture = NormalsImage(*this->Grid_, this->Layers_.Stack().Layers());
  this->Material_ = std::move(material);
  for (Part& part : this->Parts_) {
    part.material = this->Material_;
  }
}

RasterPlace MeshTerrain::Place() const {
  return PlaceOf(*this->Grid_);
}

std::vector<Part> MeshTerrain::Triangles(std::size_t triangleBudget) const {
  if (this->Report().triangles <= triangleBudget) {
    return this->Levels()[0].parts; // those that are drawn
  }
  TerrainMeshOptions options;
  options.triangleBudget = triangleBudget;
  const TerrainMesh mesh(this->Grid_, options);
  std::vector<Part> parts;
  for (const auto& tile : mesh.Tiles()) {
    if (!tile->indices.empty()) {
      parts.push_back(this->ToPart(*tile));
    }
  }
  return parts;
}

bool MeshTerrain::Focus(const std::vector<Eigen::Vector2d>& points_S, double radius) {
  std::vector<TerrainZone> zones;
  zones.reserve(points_S.size());
  for (const Eigen::Vector2d& point : points_S) {
    zones.push_back({{point}, radius});
  }
  return this->Take(this->Mesh_.SetZones(zones));
}

bool MeshTerrain::FollowTracks() {
  return this->Take(this->Mesh_.FollowTracks(this->Grid_->TakeChanges()));
}

bool MeshTerrain::Take(const std::vector<std::size_t>& changed) {
  for (const std::size_t index : changed) {
    this->Parts_[index] = this->ToPart(*this->Mesh_.Tiles()[index]);
  }
  return !changed.empty();
}

void MeshTerrain::Describe(v1::TerrainReply& reply) const {
  TerrainObject::Describe(reply);
  const GridTerrain& grid = *this->Grid_;
  reply.set_mode(v1::OpenTerrain::TRIANGLES);
  const int parts = 1 << grid.Subdivisions();
  reply.set_columns(std::uint32_t((grid.Grid().GetColumns() - 1) / parts + 1));
  reply.set_rows(std::uint32_t((grid.Grid().GetRows() - 1) / parts + 1));
  reply.set_subdivisions(std::uint32_t(grid.Subdivisions()));
  reply.set_pixel_width(parts * grid.PixelToMap().linear().col(0).norm());
  reply.set_pixel_height(parts * grid.PixelToMap().linear().col(1).norm());
  const TrackStatistics tracks = grid.Tracks().Statistics();
  reply.set_track_bytes(tracks.bytes);
  reply.set_track_contacts(tracks.contacts);
  reply.set_track_length(tracks.length);
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
