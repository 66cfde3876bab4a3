// What terrain answers.
#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Checks.h>
#include <dspace/commands/terrain/TerrainTools.h>
#include <dspace/layers/raster/RasterField.h>
#include <dspace/messages/Convert.h>
#include <dspace/state/TerrainPlaces.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace::session {

void DescribeTo(const Context& context, const TerrainObject& terrain, v1::TerrainReply* reply) {
  terrain.Describe(*reply);
  reply->set_name(terrain.Name());
  reply->set_object(terrain.Object());
  reply->set_frame(context.GetScene().Object(terrain.Object()).frame);
}

void RequireFinitePoints(const std::string& label, const double* values, int size, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const double* point = values + i * std::size_t(size);
    if (!std::all_of(point, point + size, [](double value) { return std::isfinite(value); })) {
      std::string text;
      for (int k = 0; k < size; ++k) {
        text += (k ? ", " : "") + NumberText(point[k]);
      }
      Reject(label, "point " + std::to_string(i) + " is (" + text + "); accepted: finite numbers");
    }
  }
}

namespace {

// The command's points in the terrain's frame; those of the map at height 0.
Rows3 PointsOf(const TerrainSurface& surface, const v1::QueryTerrain& command, std::size_t n) {
  const int size = command.spatial() ? 3 : 2;
  Rows3 points = Rows3::Zero(Eigen::Index(n), 3);
  for (std::size_t i = 0; i < n; ++i) {
    const double* p = command.point().data() + std::size_t(size) * i;
    const Eigen::Vector3d given(p[0], p[1], size == 3 ? p[2] : 0.0);
    points.row(Eigen::Index(i)) = command.map() ? surface.MapToScene(given) : given;
  }
  return points;
}

using Values = google::protobuf::RepeatedField<double>;

void PutValues(const Eigen::Ref<const Eigen::VectorXd>& values, Values* field) {
  *field = {values.data(), values.data() + values.size()};
}

void Heights(const TerrainSurface& surface, const v1::QueryTerrain& command, const Rows3& points,
             bool body, Values* field) {
  Eigen::VectorXd heights(points.rows());
  if (command.map()) {
    surface.HeightsMap(Eigen::Map<const Rows2>(command.point().data(), points.rows(), 2), heights);
  } else {
    surface.Heights(points, heights);
    // In a plane's frame a height is a place along Z.
    heights.array() -= body ? 0.0 : surface.SceneToMap(Eigen::Vector3d::Zero()).z();
  }
  PutValues(heights, field);
}

// Values of fields at the command's points.
void FieldValues(const TerrainObject& terrain, const v1::QueryTerrain& command, const Rows3& points,
                 Values* field) {
  Eigen::Matrix2Xd map(2, points.rows());
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    map.col(i) = command.map() ? Eigen::Vector2d(command.point().data() + 2 * i)
                               : terrain.Surface().SceneToMap(points.row(i)).head<2>();
  }
  for (const std::string& name : command.field()) {
    const Eigen::VectorXd values = terrain.Fields().Get(name).field->Values(map);
    field->Add(values.data(), values.data() + values.size());
  }
}

void QueryTerrain(const Context& context, v1::QueryTerrain& command) {
  const TerrainObject& terrain = FindTerrain(context, command.terrain());
  const TerrainSurface& surface = command.undisturbed() ? terrain.Undisturbed() : terrain.Surface();
  const std::string label = "terrain '" + command.terrain() + "'";
  if (command.map() && command.spatial()) {
    Reject(label, "map and spatial are both set; accepted: one of them");
  }
  const bool body = terrain.OnBody();
  if (body && !command.map() && !command.spatial()) {
    Reject(label, "it is on a body; accepted: map coordinates, or x, y and z");
  }
  const int size = command.spatial() ? 3 : 2;
  const std::size_t n = RowsOf(command.point_size(), size, label, "point");
  if (!command.height() && !command.normal() && !command.slope() && !command.aspect() &&
      !command.has_roughness_radius() && !command.filled() && command.field_size() == 0) {
    Reject(label, "no quantity is requested; accepted: height, normal, slope, aspect, roughness, "
                  "filled, fields");
  }
  for (const std::string& name : command.field()) {
    terrain.Fields().Get(name); // throws where there is none
  }
  RequireFinitePoints(label, command.point().data(), size, n);
  const auto* streamed = dynamic_cast<const StreamedTerrain*>(&surface);
  if (command.has_roughness_radius() && !streamed) {
    throw Error(Error::Kind::Unsupported, label,
                "triangles have no roughness; accepted: mode clipmap");
  }
  if (command.filled() && !streamed) {
    throw Error(Error::Kind::Unsupported, label,
                "triangles have no filled holes; accepted: mode clipmap");
  }
  const Rows3 points = PointsOf(surface, command, n);
  Eigen::VectorXd values(points.rows());
  v1::TerrainQueryReply reply;
  if (command.height()) {
    Heights(surface, command, points, body, reply.mutable_height());
  }
  if (command.normal()) {
    Rows3 normals(points.rows(), 3);
    surface.Normals(points, normals);
    *reply.mutable_normal() = {normals.data(), normals.data() + normals.size()};
  }
  if (command.slope()) {
    surface.Slopes(points, values);
    PutValues(values, reply.mutable_slope_deg());
  }
  if (command.aspect()) {
    surface.Aspects(points, values);
    PutValues(values, reply.mutable_aspect_deg());
  }
  if (command.has_roughness_radius()) {
    streamed->Roughness(points, command.roughness_radius(), values);
    PutValues(values, reply.mutable_roughness());
  }
  if (command.filled()) {
    const auto* drawn = static_cast<const StreamedTerrain*>(&terrain.Surface());
    if (command.map()) {
      drawn->FilledMap(Eigen::Map<const Rows2>(command.point().data(), points.rows(), 2), values);
    } else {
      drawn->Filled(points, values);
    }
    PutValues(values, reply.mutable_filled());
  }
  if (command.field_size() != 0) {
    FieldValues(terrain, command, points, reply.mutable_field());
  }
  context.reply.mutable_terrain_values()->Swap(&reply);
}

void IntersectTerrain(const Context& context, v1::IntersectTerrain& command) {
  const TerrainObject& terrain = FindTerrain(context, command.terrain());
  const TerrainSurface& surface = command.undisturbed() ? terrain.Undisturbed() : terrain.Surface();
  const std::string label = "terrain '" + command.terrain() + "'";
  const std::size_t n = RowsOf(command.ray_size(), 6, label, "ray");
  RequireFinitePoints(label, command.ray().data(), 6, n);
  const double maximum =
      command.has_maximum() ? command.maximum() : std::numeric_limits<double>::infinity();
  Require(maximum >= 0.0, label, "the greatest distance of rays", maximum, "0 m or more");
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>> rays(
      command.ray().data(), Eigen::Index(n), 6);
  const Rows3 origins = rays.leftCols<3>();
  const Rows3 directions = rays.rightCols<3>();
  Eigen::VectorXd distances(origins.rows());
  surface.Intersect(origins, directions, maximum, distances);
  PutValues(distances, context.reply.mutable_terrain_rays()->mutable_distance());
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

void LocateTerrain(const Context& context, v1::LocateTerrain& command) {
  const TerrainObject& terrain = FindTerrain(context, command.terrain());
  const TerrainSurface& surface = terrain.Surface();
  const std::string label = "terrain '" + command.terrain() + "'";
  const std::size_t n = RowsOf(command.point_size(), 3, label, "point");
  RequireFinitePoints(label, command.point().data(), 3, n);
  if (command.map() && command.degrees()) {
    Reject(label, "map and degrees are both set; accepted: one of them");
  }
  Rows3 given = Eigen::Map<const Rows3>(command.point().data(), Eigen::Index(n), 3);
  for (Eigen::Index i = 0; command.degrees() && i < given.rows(); ++i) {
    const double latitude = given(i, 1);
    Require(std::abs(latitude) <= 90.0, label, "a latitude", latitude, "-90 to 90 degrees");
    given.row(i) = surface.GeographicToMap(given.row(i));
  }
  const bool map = command.map() || command.degrees();
  Rows3 other(given.rows(), 3);
  for (Eigen::Index i = 0; i < given.rows(); ++i) {
    other.row(i) = map ? surface.MapToScene(given.row(i)) : surface.SceneToMap(given.row(i));
  }
  const FrameId frame = context.GetScene().Object(terrain.Object()).frame;
  PutCoordinates(terrain, context.Frames().WorldPose(frame), map ? other : given,
                 map ? given : other, *context.scene->sky.kernels, context.GetScene().Time(),
                 *context.reply.mutable_coordinates());
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
  registry.Add(C::kQueryTerrain, &C::mutable_query_terrain, QueryTerrain);
  registry.Add(C::kIntersectTerrain, &C::mutable_intersect_terrain, IntersectTerrain);
  registry.Add(C::kConvertTerrain, &C::mutable_convert_terrain, ConvertTerrain);
  registry.Add(C::kLocateTerrain, &C::mutable_locate_terrain, LocateTerrain);
  registry.Add(C::kDescribeTerrain, &C::mutable_describe_terrain, DescribeTerrain);
  registry.Add(C::kListTerrains, &C::mutable_list_terrains, ListTerrains);
}

} // namespace dspace::session
