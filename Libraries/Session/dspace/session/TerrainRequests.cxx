// What terrain answers.
#include <algorithm>
#include <cmath>

#include <dspace/scene/Checks.h>
#include <dspace/session/Convert.h>
#include <dspace/session/TerrainTools.h>

namespace dspace::session {

void DescribeTo(const Context& context, const TerrainObject& terrain, v1::TerrainReply* reply) {
  const GridTerrain& grid = terrain.Surface();
  reply->set_name(terrain.Name());
  reply->set_object(terrain.Object());
  reply->set_frame(context.TheScene().Object(terrain.Object()).frame);
  reply->set_columns(std::uint32_t(grid.Grid().GetColumns()));
  reply->set_rows(std::uint32_t(grid.Grid().GetRows()));
  reply->set_pixel_width(grid.PixelToMap().linear().col(0).norm());
  reply->set_pixel_height(grid.PixelToMap().linear().col(1).norm());
  reply->set_crs(grid.GetCrs().GetWkt());
  reply->set_vertical_datum(grid.GetVerticalDatum().Text());
  reply->set_minimum_height(grid.Grid().GetMinimum());
  reply->set_maximum_height(grid.Grid().GetMaximum());
  const Eigen::Vector2d& origin = grid.Frame().GetOrigin();
  Put(Eigen::Vector3d(origin.x(), origin.y(), grid.Frame().GetOriginHeight()),
      reply->mutable_map_origin());
  const Eigen::AlignedBox3d bounds = grid.GetBounds().scene;
  reply->set_west(bounds.min().x());
  reply->set_east(bounds.max().x());
  reply->set_south(bounds.min().y());
  reply->set_north(bounds.max().y());
  reply->set_triangles(terrain.Report().triangles);
  reply->set_tiles_built(terrain.Report().tilesBuilt);
  reply->set_vertical_error(terrain.Report().verticalError);
}

void RequireFinitePoints(const std::string& label, const double* values, int size, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const double* point = values + i * std::size_t(size);
    if (!std::all_of(point, point + size, [](double value) { return std::isfinite(value); })) {
      std::string text;
      for (int k = 0; k < size; ++k) {
        text += (k ? ", " : "") + NumberText(point[k]);
      }
      Refuse(label, "point " + std::to_string(i) + " is (" + text + "); accepted: finite numbers");
    }
  }
}

namespace {

SurfaceSample SampleAt(const GridTerrain& grid, const double* xy, bool map) {
  return map ? grid.SampleMap(Eigen::Vector2d(xy[0], xy[1]))
             : grid.Sample(Eigen::Vector3d(xy[0], xy[1], 0.0));
}

void QueryTerrain(const Context& context, v1::QueryTerrain& command) {
  const GridTerrain& grid = FindTerrain(context, command.terrain()).Surface();
  const std::string label = "terrain '" + command.terrain() + "'";
  const std::size_t n = RowsOf(command.point_size(), 2, label, "point");
  if (!command.height() && !command.normal() && !command.slope()) {
    Refuse(label, "nothing is asked for; accepted: height, normal, slope");
  }
  RequireFinitePoints(label, command.point().data(), 2, n);
  v1::TerrainQueryReply* reply = context.reply.mutable_terrain_values();
  for (std::size_t i = 0; i < n; ++i) {
    const SurfaceSample sample = SampleAt(grid, command.point().data() + 2 * i, command.map());
    if (command.height()) {
      reply->add_height(command.map() ? sample.height : sample.position_S.z());
    }
    if (command.normal()) {
      for (const double value : sample.normal_S) {
        reply->add_normal(value);
      }
    }
    if (command.slope()) {
      reply->add_slope_deg(sample.slope_deg);
    }
  }
}

void ConvertTerrain(const Context& context, v1::ConvertTerrain& command) {
  const GridTerrain& grid = FindTerrain(context, command.terrain()).Surface();
  const std::string label = "terrain '" + command.terrain() + "'";
  const std::size_t n = RowsOf(command.point_size(), 3, label, "point");
  RequireFinitePoints(label, command.point().data(), 3, n);
  v1::TerrainPoints* reply = context.reply.mutable_terrain_points();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d point(command.point().data() + 3 * i);
    for (const double value : command.to_map() ? grid.SceneToMap(point) : grid.MapToScene(point)) {
      reply->add_point(value);
    }
  }
}

void DescribeTerrain(const Context& context, v1::DescribeTerrain& command) {
  DescribeTo(context, FindTerrain(context, command.terrain()), context.reply.mutable_terrain());
}

void ListTerrains(const Context& context, v1::ListTerrains&) {
  v1::TerrainList* list = context.reply.mutable_terrains();
  for (const auto& [name, terrain] : context.scene->terrains) {
    list->add_name(name);
  }
}

} // namespace

void AddTerrainRequests(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kQueryTerrain, &C::mutable_query_terrain, Effect::Request, QueryTerrain);
  registry.Add(C::kConvertTerrain, &C::mutable_convert_terrain, Effect::Request, ConvertTerrain);
  registry.Add(C::kDescribeTerrain, &C::mutable_describe_terrain, Effect::Request, DescribeTerrain);
  registry.Add(C::kListTerrains, &C::mutable_list_terrains, Effect::Request, ListTerrains);
}

} // namespace dspace::session
