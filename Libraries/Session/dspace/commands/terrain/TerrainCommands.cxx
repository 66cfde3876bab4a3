// Terrain: opened, focused, removed.
#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/commands/terrain/ClipmapTerrainObject.h>
#include <dspace/commands/terrain/MeshTerrain.h>
#include <dspace/commands/terrain/TerrainBeforehand.h>
#include <dspace/commands/terrain/TerrainLook.h>
#include <dspace/commands/terrain/TerrainTools.h>
#include <dspace/layers/ColorRamp.h>
#include <dspace/mesh/DrapeImage.h>
#include <dspace/messages/Convert.h>
#include <dspace/raster/ElevationCache.h>
#include <dspace/state/SunPlace.h>

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

// Of a terrain or a patch.
template<typename Message> ElevationOptions ToElevation(const Message& command) {
  ElevationOptions elevation;
  if (command.band() != 0) {
    elevation.band = int(std::min<std::uint32_t>(command.band(), 1u << 30));
  }
  if (!command.crs().empty()) {
    elevation.crs = command.crs();
  }
  if (!command.vertical_datum().empty()) {
    elevation.verticalDatum = VerticalDatum::FromText(command.vertical_datum());
  }
  if (command.has_no_data()) {
    elevation.noData = command.no_data();
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
  return elevation;
}

// Of a terrain, with its window.
ElevationOptions ToTerrainElevation(const v1::OpenTerrain& command, const std::string& label) {
  ElevationOptions elevation = ToElevation(command);
  if (command.window_size() != 0) {
    if (command.window_size() != 4) {
      Reject(label, "its window holds " + std::to_string(command.window_size()) +
                        " numbers; accepted: 4 (left, top, right, bottom) or none");
    }
    elevation.mapWindow = {command.window(0), command.window(1), command.window(2),
                           command.window(3)};
  }
  return elevation;
}

TerrainPatch ToPatch(v1::OpenTerrain::Patch& from) {
  TerrainPatch patch;
  from.set_path(AbsoluteRaster(from.path()));
  patch.path = from.path();
  patch.name = from.name();
  patch.elevation = ToElevation(from);
  if (from.has_margin()) {
    patch.margin = from.margin();
  }
  return patch;
}

// Absent angles of the shaded relief become those of the scene's Sun at the middle of the terrain,
// where it is above the horizon. `towards_S`: ReliefSun().
void PutReliefSun(const std::optional<Eigen::Vector3d>& towards_S, const GridTerrain& grid,
                  v1::OpenTerrain& command) {
  if (!towards_S || !command.has_relief()) {
    return;
  }
  const Eigen::Vector2d angles =
      ToHorizontal(HorizontalAxes(grid, PlaceOf(grid)).transpose() * *towards_S);
  if (!(angles[1] > 0.0)) {
    return;
  }
  v1::OpenTerrain::ShadedRelief* relief = command.mutable_relief();
  if (!relief->has_sun_azimuth_deg()) {
    relief->set_sun_azimuth_deg(angles[0]);
  }
  if (!relief->has_sun_elevation_deg()) {
    relief->set_sun_elevation_deg(angles[1]);
  }
}

// Uses nothing of the context's scene.
std::unique_ptr<TerrainObject> OpenMesh(const Context& context, const std::string& name,
                                        const std::string& path,
                                        const std::optional<Eigen::Vector3d>& sun_S,
                                        v1::OpenTerrain& command) {
  GridTerrainOptions options;
  options.elevation = ToTerrainElevation(command, "terrain '" + name + "'");
  if (command.has_map_origin()) {
    options.origin = Eigen::Vector2d(command.map_origin().x(), command.map_origin().y());
    options.originHeight = command.map_origin().z();
  }
  if (command.track_byte_budget() != 0) {
    options.tracks.byteBudget = std::size_t(command.track_byte_budget());
  }
  options.subdivisions = int(std::min<std::uint32_t>(command.subdivisions(), 1u << 30));
  const auto grid = GridTerrain::Load(path, options);
  PutReliefSun(sun_S, *grid, command);
  auto terrain = std::make_unique<MeshTerrain>(name, grid, MeshMaterial(context, *grid, command),
                                               std::size_t(command.triangle_budget()));
  if (!terrain->Report().budgetMet) {
    context.reply.add_warning("terrain '" + name +
                              "': " + std::to_string(terrain->Report().triangles) +
                              " triangles are needed, more than the budget of " +
                              std::to_string(terrain->Report().budget));
  }
  return terrain;
}

// Up to this many pixels all of a raster is kept in memory where the caller does not choose.
constexpr std::int64_t MeshPixels = 4000000;

// Where overviews are read; empty: nowhere.
std::string CacheFolder(v1::OpenTerrain& command) {
  if (!command.has_overview_cache()) {
    return ElevationCache::DefaultFolder(); // of the user who plays the recording
  }
  if (!command.overview_cache().empty()) {
    command.set_overview_cache(AbsolutePath(command.overview_cache()));
  }
  return command.overview_cache();
}

// Smaller rasters lose little.
void WarnOfOverviews(const Context& context, const std::string& label, const ElevationInfo& info,
                     const v1::OpenTerrain& command, bool builds) {
  const bool off = command.has_overview_cache() && command.overview_cache().empty();
  if (off || info.overviewsAreCached || !ElevationCache::Needs(info) ||
      std::int64_t(info.window.width) * info.window.height <= MeshPixels) {
    return;
  }
  std::string build = "dspace terrain cache ";
  if (command.has_overview_cache()) {
    build += "--folder '" + command.overview_cache() + "' ";
  }
  if (command.band() > 1) {
    build += "--band " + std::to_string(command.band()) + " ";
  }
  context.reply.add_warning(
      label + ": its raster of " + std::to_string(info.window.width) + " x " +
      std::to_string(info.window.height) +
      " pixels has no overviews: distant ground shows every n-th pixel" +
      (builds ? " until the background build completes; `" : std::string("; `")) + build + "'" +
      info.path + "'` builds overviews");
}

// Overviews that prove damaged are removed by the read that finds it: the next does without.
std::shared_ptr<StreamedTerrain> OpenStreamed(const Context& context, const std::string& path,
                                              const StreamedTerrainOptions& options) {
  std::vector<std::string> damaged; // at most one a raster
  for (;;) {
    try {
      auto surface = StreamedTerrain::Open(path, options);
      for (const std::string& warning : damaged) {
        context.reply.add_warning(warning);
      }
      return surface;
    } catch (const Error& error) {
      if (error.GetKind() != Error::Kind::Corrupt || options.elevation.overviewCache.empty() ||
          damaged.size() > options.patches.size()) {
        throw;
      }
      damaged.push_back(error.what());
    }
  }
}

std::unique_ptr<TerrainObject> OpenClipmap(const Context& context, const std::string& name,
                                           const std::string& path, v1::OpenTerrain& command) {
  const std::string label = "terrain '" + name + "'";
  StreamedTerrainOptions options;
  options.elevation = ToTerrainElevation(command, label);
  options.elevation.overviewCache = CacheFolder(command);
  options.onBody = command.on_body();
  if (command.has_map_origin()) {
    if (options.onBody) {
      Reject(label, "it is on a body, whose centre is the origin; accepted: no origin");
    }
    options.origin = Eigen::Vector2d(command.map_origin().x(), command.map_origin().y());
    options.originHeight = command.map_origin().z();
  }
  if (command.level_size() != 0) {
    options.cells = int(std::min<std::uint32_t>(command.level_size(), 1u << 30));
  }
  if (command.byte_budget() != 0) {
    options.pyramid.byteBudget = std::size_t(command.byte_budget());
  }
  if (command.has_fill_holes()) {
    Require(command.fill_holes() > 0.0, label,
            "the distance from data that holes are filled within", command.fill_holes(),
            "more than 0 pixels");
    options.fillHoles = command.fill_holes();
  }
  options.subdivisions = int(std::min<std::uint32_t>(command.subdivisions(), 1u << 30));
  if (command.track_byte_budget() != 0) {
    options.tracks.byteBudget = std::size_t(command.track_byte_budget());
  }
  if (command.has_deadline()) {
    Require(command.deadline() > 0.0 && std::isfinite(command.deadline()), label, "the deadline",
            command.deadline(), "more than 0 s, finite");
    options.deadline = command.deadline();
  }
  for (v1::OpenTerrain::Patch& patch : *command.mutable_patch()) {
    options.patches.push_back(ToPatch(patch));
    options.patches.back().elevation.overviewCache = options.elevation.overviewCache;
  }
  const auto surface = OpenStreamed(context, path, options);
  const bool builds = !options.elevation.overviewCache.empty() &&
                      (!command.has_build_overviews() || command.build_overviews()) &&
                      OverviewBuild::Wanted(surface->Info());
  WarnOfOverviews(context, label, surface->Info(), command, builds);
  ClipmapOptions look = ClipmapLook(*surface, command);
  look.cells = options.cells;
  look.heights = surface->DrawnHeights();
  look.deadline = options.deadline;
  auto terrain = std::make_unique<ClipmapTerrainObject>(name, surface, look, options.pyramid,
                                                        options.elevation.overviewCache);
  if (builds) {
    terrain->BuildOverviews(options.elevation.overviewCache, options.elevation);
  }
  if (command.has_drape()) {
    AddDrape(context, *terrain, *command.mutable_drape());
  }
  if (options.fillHoles) {
    AddFilled(context, *terrain, options);
  }
  if (command.relief().color_by_height()) {
    ClipmapStyle style;
    style.ramp = ClipmapStyle::Ramp(); // clang 14 emplaces none of a nested class
    style.ramp->shaded = true;         // it is the ground's own look here
    style.ramp->range = surface->HeightRange();
    style.ramp->colors = TerrainRamp();
    style.ramp->image = RampImage(style.ramp->colors);
    if (style.ramp->range[0] == style.ramp->range[1]) {
      style.ramp->range[1] += 1.0; // level ground
    }
    terrain->Clipmap().SetStyle(style);
  }
  return terrain;
}

v1::OpenTerrain::Mode ModeFor(const std::string& name, const std::string& path,
                              const v1::OpenTerrain& command) {
  using Command = v1::OpenTerrain;
  const std::string label = "terrain '" + name + "'";
  if (!Command::Mode_IsValid(command.mode())) {
    Reject(label, "mode " + std::to_string(command.mode()) +
                      " is not known; accepted: auto, triangles, clipmap");
  }
  if (command.on_body() && command.mode() == Command::TRIANGLES) {
    Reject(label, "triangles need a plane; accepted on a body: a clipmap");
  }
  if (command.patch_size() != 0 && command.mode() == Command::TRIANGLES) {
    Reject(label, "triangles use one raster; accepted with patches: a clipmap");
  }
  if (command.has_fill_holes() && command.mode() == Command::TRIANGLES) {
    Reject(label, "triangles keep their holes; accepted with filled holes: a clipmap");
  }
  if (command.mode() != Command::AUTO) {
    return command.mode();
  }
  if (command.on_body() || command.patch_size() != 0 || command.subdivisions() != 0 ||
      command.has_fill_holes()) {
    return Command::CLIPMAP;
  }
  const RasterWindow window =
      ElevationSource(path, ToTerrainElevation(command, label)).Info().window;
  return std::int64_t(window.width) * window.height > MeshPixels ? Command::CLIPMAP
                                                                 : Command::TRIANGLES;
}

// The terrain of a command that was opened before (TerrainBeforehand.h), and the command as it is
// then; null: none was.
std::unique_ptr<TerrainObject> TakeBeforehand(const Context& context, const std::string& name,
                                              v1::OpenTerrain& command) {
  ReadBeforehand* before = ReadBeforehand::Current();
  if (!before || !before->terrain || before->terrain->Name() != name ||
      before->askedTerrain != command.SerializeAsString()) {
    return nullptr;
  }
  NoteFilesRead(before->files);
  for (const std::string& warning : before->warnings) {
    context.reply.add_warning(warning);
  }
  command.ParseFromString(before->openedTerrain);
  return std::move(before->terrain);
}

ObjectId AddTerrainObject(const Context& context, const v1::OpenTerrain& command,
                          const TerrainObject& terrain) {
  GraphicsObject object;
  object.id = command.object_id();
  object.name = command.object_name().empty() ? context.GetScene().FreeObjectName(terrain.Name())
                                              : command.object_name();
  object.frame = ToFrame(command.frame());
  object.fragment = command.fragment();
  terrain.Draw(object);
  return context.GetScene().AddObject(std::move(object));
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
  auto terrain = TakeBeforehand(context, name, command);
  if (!terrain) {
    command.set_path(AbsoluteRaster(command.path()));
    command.set_mode(ModeFor(name, command.path(), command)); // a recording opens the same
    terrain = command.mode() == v1::OpenTerrain::CLIPMAP
                  ? OpenClipmap(context, name, command.path(), command)
                  : OpenMesh(context, name, command.path(), ReliefSun(context.GetScene(), command),
                             command);
  }
  for (const std::string& warning : terrain->Surface().GetWarnings()) {
    context.reply.add_warning(warning);
  }
  terrain->SetObject(AddTerrainObject(context, command, *terrain));
  command.set_name(name);
  command.set_object_id(terrain->Object());
  command.set_object_name(context.GetScene().Object(terrain->Object()).name);
  DescribeTo(context, *terrain, context.reply.mutable_terrain());
  context.scene->terrains[name] = std::move(terrain);
}

void RemoveTerrain(const Context& context, v1::RemoveTerrain& command) {
  context.GetScene().RemoveObject(FindTerrain(context, command.terrain()).Object());
  context.scene->EraseRemoved();
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
    GraphicsObject drawn;
    terrain.Draw(drawn);
    context.GetScene().SetObjectLevels(terrain.Object(), std::move(drawn.levels));
  }
}

} // namespace

std::string FreeTerrainName(const SceneState& state) {
  std::string name = "terrain";
  for (int n = 2; state.terrains.count(name); ++n) {
    name = "terrain " + std::to_string(n);
  }
  return name;
}

std::optional<Eigen::Vector3d> ReliefSun(const Scene& scene, const v1::OpenTerrain& command) {
  const Light* sun = FindSunLight(scene);
  if (command.has_color() || command.has_drape() || !sun || !IsSun(*sun) || !sun->enabled) {
    return std::nullopt;
  }
  return TowardsSun(scene, *sun, ToFrame(command.frame()));
}

void ReadTerrain(const v1::OpenTerrain& command, const std::optional<Eigen::Vector3d>& sun_S,
                 ReadBeforehand& into) {
  v1::OpenTerrain opened = command;
  opened.set_path(AbsoluteRaster(command.path()));
  opened.set_mode(ModeFor(command.name(), opened.path(), opened));
  State none;
  v1::Reply reply;
  const Context context{none, nullptr, command.name(), reply};
  const FilesReadScope files;
  into.terrain = opened.mode() == v1::OpenTerrain::CLIPMAP
                     ? OpenClipmap(context, command.name(), opened.path(), opened)
                     : OpenMesh(context, command.name(), opened.path(), sun_S, opened);
  into.files = files.Files();
  into.warnings.assign(reply.warning().begin(), reply.warning().end());
  into.askedTerrain = command.SerializeAsString();
  into.openedTerrain = opened.SerializeAsString();
}

void AddTerrainCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kOpenTerrain, &C::mutable_open_terrain, OpenTerrain);
  registry.Add(C::kRemoveTerrain, &C::mutable_remove_terrain, RemoveTerrain);
  registry.Add(C::kFocusTerrain, &C::mutable_focus_terrain, FocusTerrain);
  AddTerrainRequests(registry);
  AddTerrainStyleCommands(registry);
  AddTerrainTrackCommands(registry);
  AddTerrainCacheCommands(registry);
  AddTerrainLayerCommands(registry);
  AddTerrainFieldCommands(registry);
  AddGeodesyRequests(registry);
}

} // namespace dspace::session
