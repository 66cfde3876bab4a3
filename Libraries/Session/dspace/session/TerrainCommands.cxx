// Terrain: opened, focused, removed.
#include <filesystem>

#include <dspace/scene/Checks.h>
#include <dspace/session/Convert.h>
#include <dspace/session/ObjectTools.h>
#include <dspace/session/TerrainTools.h>
#include <dspace/terrain/DrapeImage.h>

namespace dspace::session {

TerrainObject& FindTerrain(const Context& context, const std::string& name) {
  const auto found = context.scene->terrains.find(name);
  if (found == context.scene->terrains.end()) {
    throw Error(Error::Kind::NotFound, "terrain '" + name + "'",
                "there is no such terrain in scene '" + context.sceneName + "'");
  }
  return *found->second;
}

namespace {

// A path of GDAL's need not be a file ("/vsicurl/...", "PDS4:..."): only files are made absolute.
std::string AbsoluteFile(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) ? AbsolutePath(path) : path;
}

GridTerrainOptions ToOptions(const v1::OpenTerrain& command) {
  GridTerrainOptions options;
  ElevationOptions& elevation = options.elevation;
  if (command.band() != 0) {
    elevation.band = int(std::min<std::uint32_t>(command.band(), 1u << 30));
  }
  if (!command.crs().empty()) {
    elevation.crs = command.crs();
  }
  if (!command.vertical_datum().empty()) {
    elevation.verticalDatum = VerticalDatum::FromText(command.vertical_datum());
  }
  if (command.has_vertical_scale()) {
    elevation.verticalScale = command.vertical_scale();
  }
  if (command.has_vertical_offset()) {
    elevation.verticalOffset = command.vertical_offset();
  }
  if (command.has_pixel_size()) {
    elevation.pixelSize = command.pixel_size();
  }
  if (command.has_map_origin()) {
    options.origin = Eigen::Vector2d(command.map_origin().x(), command.map_origin().y());
    options.originHeight = command.map_origin().z();
  }
  return options;
}

DrapeImage Relief(const GridTerrain& grid, const v1::OpenTerrain::ShadedRelief& from) {
  ShadedReliefOptions options;
  if (from.has_sun_azimuth_deg()) {
    options.sunAzimuth_deg = from.sun_azimuth_deg();
  }
  if (from.has_sun_elevation_deg()) {
    options.sunElevation_deg = from.sun_elevation_deg();
  }
  if (from.color_by_height()) {
    options.ramp = TerrainRamp();
  }
  return ShadedRelief(grid, options);
}

DrapeImage Draped(const GridTerrain& grid, v1::OpenTerrain::Drape& from) {
  DrapeSource source;
  from.set_path(AbsoluteFile(from.path()));
  source.path = from.path();
  if (!from.crs().empty()) {
    source.crs = from.crs();
  }
  if (from.extent_size() != 0) {
    if (from.extent_size() != 4) {
      Refuse("file '" + from.path() + "'",
             "its extent holds " + std::to_string(from.extent_size()) +
                 " numbers; accepted: 4 (left, top, right, bottom) or none");
    }
    source.extent = {from.extent(0), from.extent(1), from.extent(2), from.extent(3)};
  }
  DrapeImage image = WarpImage(grid, source);
  if (image.coverage.empty()) {
    return image;
  }
  const std::vector<std::string> warnings = image.warnings;
  image = Over(image, ShadedRelief(grid));
  image.warnings = warnings;
  return image;
}

std::shared_ptr<const Material> MakeMaterial(const Context& context, const GridTerrain& grid,
                                             v1::OpenTerrain& command) {
  auto material = std::make_shared<Material>();
  material->name = "terrain";
  material->roughness = 1.0;
  material->repeatTexture = false;
  material->lit = !command.unlit();
  if (command.has_color()) {
    material->color = ToColor(command.color(), grid.GetName());
    return material;
  }
  DrapeImage drape =
      command.has_drape() ? Draped(grid, *command.mutable_drape()) : Relief(grid, command.relief());
  for (const std::string& warning : drape.warnings) {
    context.reply.add_warning(warning);
  }
  auto image = std::make_shared<Image>();
  image->name = command.has_drape() ? command.drape().path() : grid.GetName() + " relief";
  image->width = drape.width;
  image->height = drape.height;
  image->channels = 3;
  image->pixels = std::move(drape.pixels);
  material->color = {1, 1, 1};
  material->texture = std::move(image);
  return material;
}

std::string FreeTerrainName(const SceneState& state) {
  std::string name = "terrain";
  for (int n = 2; state.terrains.count(name); ++n) {
    name = "terrain " + std::to_string(n);
  }
  return name;
}

ObjectId AddTerrainObject(const Context& context, const v1::OpenTerrain& command,
                          const TerrainObject& terrain) {
  GraphicsObject object;
  object.id = command.object_id();
  object.name = FreeObjectName(context.TheScene(), terrain.Name());
  object.frame = ToFrame(command.frame());
  object.fragment = command.fragment();
  object.levels = terrain.Levels();
  return context.TheScene().AddObject(std::move(object));
}

void OpenTerrain(const Context& context, v1::OpenTerrain& command) {
  const std::string name =
      command.name().empty() ? FreeTerrainName(*context.scene) : command.name();
  RequireName("terrain", name);
  if (context.scene->terrains.count(name)) {
    throw Error(Error::Kind::AlreadyExists, "terrain '" + name + "'",
                "there is a terrain of this name already");
  }
  context.Frames().Name(ToFrame(command.frame())); // throws where there is none
  const std::string path = AbsoluteFile(command.path());
  const auto grid = GridTerrain::Load(path, ToOptions(command));
  for (const std::string& warning : grid->GetWarnings()) {
    context.reply.add_warning(warning);
  }
  auto terrain = std::make_unique<TerrainObject>(name, grid, MakeMaterial(context, *grid, command),
                                                 std::size_t(command.triangle_budget()));
  if (!terrain->Report().budgetMet) {
    context.reply.add_warning("terrain '" + name +
                              "': " + std::to_string(terrain->Report().triangles) +
                              " triangles are needed, more than the budget of " +
                              std::to_string(terrain->Report().budget));
  }
  terrain->SetObject(AddTerrainObject(context, command, *terrain));
  command.set_path(path);
  command.set_name(name);
  command.set_object_id(terrain->Object());
  DescribeTo(context, *terrain, context.reply.mutable_terrain());
  context.scene->terrains[name] = std::move(terrain);
}

void RemoveTerrain(const Context& context, v1::RemoveTerrain& command) {
  context.TheScene().RemoveObject(FindTerrain(context, command.terrain()).Object());
  context.scene->ForgetRemoved();
}

void FocusTerrain(const Context& context, v1::FocusTerrain& command) {
  TerrainObject& terrain = FindTerrain(context, command.terrain());
  const std::string label = "terrain '" + command.terrain() + "'";
  const std::size_t n = RowsOf(command.point_size(), 2, label, "point");
  RequireFinitePoints(label, command.point().data(), 2, n);
  Require(command.radius() >= 0 && std::isfinite(command.radius()), label, "the radius",
          command.radius(), "0 metres or more, finite");
  std::vector<Eigen::Vector2d> points(n);
  for (std::size_t i = 0; i < n; ++i) {
    points[i] = Eigen::Vector2d(command.point().data() + 2 * i);
  }
  if (terrain.Focus(points, command.radius())) {
    context.TheScene().SetObjectLevels(terrain.Object(), terrain.Levels());
  }
}

} // namespace

void AddTerrainCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kOpenTerrain, &C::mutable_open_terrain, Effect::Change, OpenTerrain);
  registry.Add(C::kRemoveTerrain, &C::mutable_remove_terrain, Effect::Change, RemoveTerrain);
  registry.Add(C::kFocusTerrain, &C::mutable_focus_terrain, Effect::Change, FocusTerrain);
  AddTerrainRequests(registry);
}

} // namespace dspace::session
