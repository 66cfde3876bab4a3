// What terrain answers.
#include <algorithm>
#include <cmath>

#include <dspace/scene/Checks.h>
#include <dspace/session/Convert.h>
#include <dspace/session/TerrainTools.h>

namespace dspace::session {

void DescribeTo(const Context& context, const TerrainObject& terrain, v1::TerrainReply* reply) {
  terrain.Describe(*reply);
  reply->set_name(terrain.Name());
  reply->set_object(terrain.Object());
  reply->set_frame(context.TheScene().Object(terrain.Object()).frame);
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

// Whether points of its frame need all three coordinates.
bool OnBody(const TerrainObject& terrain) {
  v1::TerrainReply info;
  terrain.Describe(info);
  return info.on_body();
}

void QueryTerrain(const Context& context, v1::QueryTerrain& command) {
  const TerrainObject& terrain = FindTerrain(context, command.terrain());
  const TerrainSurface& surface = command.undisturbed() ? terrain.Undisturbed() : terrain.Surface();
  const std::string label = "terrain '" + command.terrain() + "'";
  if (command.map() && command.spatial()) {
    Refuse(label, "points are of the map or of space, not both");
  }
  const bool body = OnBody(terrain);
  if (body && !command.map() && !command.spatial()) {
    Refuse(label, "it stands on its body; accepted: map coordinates, or x, y and z");
  }
  const int size = command.spatial() ? 3 : 2;
  const std::size_t n = RowsOf(command.point_size(), size, label, "point");
  if (!command.height() && !command.normal() && !command.slope()) {
    Refuse(label, "nothing is asked for; accepted: height, normal, slope");
  }
  RequireFinitePoints(label, command.point().data(), size, n);
  v1::TerrainQueryReply* reply = context.reply.mutable_terrain_values();
  if (command.height() && !command.normal() && !command.slope()) { // many at once
    Eigen::VectorXd heights(static_cast<Eigen::Index>(n));
    if (command.map()) {
      surface.HeightsMap(Eigen::Map<const Rows2>(command.point().data(), Eigen::Index(n), 2),
                         heights);
    } else {
      Rows3 points = Rows3::Zero(Eigen::Index(n), 3);
      points.leftCols(size) =
          Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
              command.point().data(), Eigen::Index(n), size);
      surface.Heights(points, heights);
      // In a plane's frame a height is a place along Z.
      const double zero = body ? 0.0 : surface.SceneToMap(Eigen::Vector3d::Zero()).z();
      heights.array() -= zero;
    }
    *reply->mutable_height() = {heights.data(), heights.data() + heights.size()};
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double* p = command.point().data() + std::size_t(size) * i;
    const SurfaceSample sample =
        command.map() ? surface.SampleMap(Eigen::Vector2d(p[0], p[1]))
                      : surface.Sample(Eigen::Vector3d(p[0], p[1], size == 3 ? p[2] : 0.0));
    if (command.height()) {
      reply->add_height(command.map() || body ? sample.height : sample.position_S.z());
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
  const TerrainSurface& grid = FindTerrain(context, command.terrain()).Surface();
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
