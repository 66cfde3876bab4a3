// The layers of a terrain, colours and normals: added, changed, removed, listed.
#include <algorithm>
#include <functional>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/commands/terrain/ClipmapTerrainObject.h>
#include <dspace/commands/terrain/MeshTerrain.h>
#include <dspace/commands/terrain/OpenedLayer.h>
#include <dspace/commands/terrain/TerrainBeforehand.h>
#include <dspace/commands/terrain/TerrainLook.h>
#include <dspace/commands/terrain/TerrainTools.h>
#include <dspace/layers/NoiseLayer.h>
#include <dspace/layers/raster/FalseColorLayer.h>
#include <dspace/layers/raster/FilledLayer.h>
#include <dspace/layers/raster/ImageLayer.h>
#include <dspace/layers/raster/NormalsLayer.h>
#include <dspace/layers/raster/RasterField.h>
#include <dspace/layers/vector/VectorLayer.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

using Add = v1::AddTerrainLayer;

// What opening a layer takes from its terrain: any thread may then open it.
struct LayerGround {
  RasterPlace place;
  std::string cacheFolder;
  // Of a layer that shows a field: the raster of the field, and its unit.
  std::optional<Add::FalseColor> field;
  std::string fieldUnit;
};

ClipmapTerrainObject* AsClipmap(TerrainObject& terrain) {
  return dynamic_cast<ClipmapTerrainObject*>(&terrain);
}

// Both modes have them.
TerrainLayers& LayersOf(TerrainObject& terrain) {
  if (ClipmapTerrainObject* clipmap = AsClipmap(terrain)) {
    return clipmap->Layers();
  }
  return dynamic_cast<MeshTerrain&>(terrain).Layers();
}

// Draws what a change of the layers made; a clipmap follows its stack. Where they cannot be read,
// `undo` is called and the error goes on.
void ShowChange(const Context& context, TerrainObject& terrain, const std::function<void()>& undo) {
  auto* mesh = dynamic_cast<MeshTerrain*>(&terrain);
  if (!mesh) {
    return;
  }
  try {
    mesh->ShowLayers();
  } catch (...) {
    undo();
    throw;
  }
  GraphicsObject drawn;
  mesh->Draw(drawn);
  context.GetScene().SetObjectLevels(mesh->Object(), std::move(drawn.levels));
}

// Of an image, false colour or a drape. Makes the path absolute.
template<class Message> RasterLayerOptions ToRaster(const Message& from, std::string cacheFolder) {
  RasterLayerOptions options;
  options.cacheFolder = std::move(cacheFolder);
  if (!from.crs().empty()) {
    options.crs = from.crs();
  }
  if (from.extent_size() != 0) {
    if (from.extent_size() != 4) {
      Reject("file '" + from.path() + "'",
             "its extent holds " + std::to_string(from.extent_size()) +
                 " numbers; accepted: 4 (left, top, right, bottom) or none");
    }
    options.extent = {from.extent(0), from.extent(1), from.extent(2), from.extent(3)};
  }
  return options;
}

template<class Message> OpenedLayer OpenImage(const LayerGround& ground, Message& from) {
  from.set_path(AbsoluteRaster(from.path()));
  OpenedLayer opened;
  opened.layer = OpenImageLayer(from.path(), ground.place, ToRaster(from, ground.cacheFolder));
  opened.about.set_kind(v1::TerrainLayerReply::IMAGE);
  opened.about.set_path(from.path());
  return opened;
}

// Fills in the raster of a field.
Add::FalseColor ColorOfField(const ClipmapTerrainObject& terrain, const Add& command,
                             const std::string& label) {
  if (!command.has_false_color()) {
    Reject(label, "a layer of another kind is to show field '" + command.field() +
                      "'; accepted: false colour");
  }
  Add::FalseColor color = command.false_color();
  if (!color.path().empty() || !color.crs().empty() || color.extent_size() != 0 ||
      color.band() != 0) {
    Reject(label, "field '" + command.field() +
                      "' and a path, crs, extent or band are given; accepted: one of both");
  }
  const v1::AddTerrainField& field = terrain.Fields().Get(command.field()).source;
  color.set_path(field.path());
  color.set_crs(field.crs());
  *color.mutable_extent() = field.extent();
  color.set_band(field.band());
  return color;
}

OpenedLayer OpenFalseColor(const LayerGround& ground, Add::FalseColor& from) {
  from.set_path(AbsoluteRaster(from.path()));
  FalseColorOptions colors;
  if (from.band() != 0) {
    colors.band = int(std::min<std::uint32_t>(from.band(), 1u << 30));
  }
  if (from.color_size() != 0) {
    colors.ramp.clear();
    for (const v1::Color& color : from.color()) {
      colors.ramp.push_back(ToColor(color, "false colour of '" + from.path() + "'"));
    }
  }
  if (from.has_low()) {
    colors.low = from.low();
  }
  if (from.has_high()) {
    colors.high = from.high();
  }
  const auto layer =
      OpenFalseColorLayer(from.path(), ground.place, colors, ToRaster(from, ground.cacheFolder));
  OpenedLayer opened;
  opened.layer = layer;
  opened.about.set_kind(v1::TerrainLayerReply::FALSE_COLOR);
  opened.about.set_path(from.path());
  opened.about.set_low(layer->Range()[0]);
  opened.about.set_high(layer->Range()[1]);
  for (const std::array<double, 3>& color : layer->Ramp()) {
    Put(color, opened.about.add_color());
  }
  opened.about.set_unit(layer->Unit());
  return opened;
}

LayerGround GroundOf(const ClipmapTerrainObject& terrain, const Add& command,
                     const std::string& label) {
  LayerGround ground{PlaceOf(terrain.Surface()), terrain.CacheFolder(), {}, {}};
  if (!command.field().empty()) {
    ground.field = ColorOfField(terrain, command, label);
    ground.fieldUnit = terrain.Fields().Get(command.field()).field->Units();
  }
  return ground;
}

OpenedLayer OpenField(const LayerGround& ground, const Add& command) {
  Add::FalseColor color = *ground.field;
  OpenedLayer opened = OpenFalseColor(ground, color);
  opened.about.set_field(command.field());
  opened.about.set_unit(ground.fieldUnit);
  return opened;
}

// `opacity` goes after the colour's three numbers; what is absent stays.
void PutShade(bool given, const v1::Color& color, const std::string& label, bool opacityGiven,
              double opacity, std::array<double, 4>& shade) {
  if (given) {
    const std::array<double, 3> rgb = ToColor(color, label);
    std::copy(rgb.begin(), rgb.end(), shade.begin());
  }
  if (opacityGiven) {
    shade[3] = opacity;
  }
}

OpenedLayer OpenShapes(const LayerGround& ground, Add::Shapes& from) {
  from.set_path(AbsoluteRaster(from.path()));
  const std::string label = "shapes '" + from.path() + "'";
  VectorLayerOptions options;
  if (!from.crs().empty()) {
    options.crs = from.crs();
  }
  if (!from.layer().empty()) {
    options.layer = from.layer();
  }
  PutShade(from.has_line(), from.line(), label, from.has_line_opacity(), from.line_opacity(),
           options.line);
  PutShade(from.has_fill(), from.fill(), label, from.has_fill_opacity(), from.fill_opacity(),
           options.fill);
  if (from.has_width()) {
    options.width = from.width();
  }
  options.pixels = from.has_pixels() ? from.pixels() : options.pixels;
  options.point = from.has_point() ? from.point() : options.point;
  OpenedLayer opened;
  opened.layer = OpenVectorLayer(from.path(), ground.place, options);
  opened.about.set_kind(v1::TerrainLayerReply::SHAPES);
  opened.about.set_path(from.path());
  return opened;
}

OpenedLayer MakeNoise(const Add::Noise& from) {
  constexpr double Contrast = 0.25;
  NoiseOptions options;
  options.wavelength = from.has_wavelength() ? from.wavelength() : options.wavelength;
  if (from.has_octaves()) {
    options.octaves = int(std::min<std::uint32_t>(from.octaves(), 1u << 30));
  }
  options.gain = from.has_gain() ? from.gain() : options.gain;
  options.seed = from.seed();
  OpenedLayer opened;
  opened.layer = MakeNoiseLayer(options, from.has_contrast() ? from.contrast() : Contrast);
  opened.about.set_kind(v1::TerrainLayerReply::NOISE);
  return opened;
}

OpenedLayer OpenNormals(const RasterPlace& place, Add::Normals& from,
                        const std::string& cacheFolder, const std::string& label) {
  if (!Add::Normals::Axes_IsValid(from.axes())) {
    Reject(label, "axes " + std::to_string(from.axes()) +
                      " of normals are not known; accepted: 0 (of the map), 1 (local)");
  }
  from.set_path(AbsoluteRaster(from.path()));
  const bool local = from.axes() == Add::Normals::LOCAL;
  OpenedLayer opened;
  opened.layer = OpenNormalsLayer(from.path(), place, local ? NormalAxes::Local : NormalAxes::Map,
                                  ToRaster(from, cacheFolder));
  opened.about.set_kind(v1::TerrainLayerReply::NORMALS);
  opened.about.set_path(from.path());
  return opened;
}

Membership MemberOf(const Scene& scene, const Add& command, const std::string& label) {
  const bool image = command.kind_case() == Add::kImage || command.kind_case() == Add::kNormals;
  const Nature standard = image ? Nature::Physical : Nature::Ornamental;
  return scene.Fragments().Member(
      label, command.has_nature() ? ToNature(command.nature(), label) : standard,
      command.fragment());
}

const char* WordFor(Add::KindCase kind) {
  switch (kind) {
  case Add::kImage:
    return "image";
  case Add::kFalseColor:
    return "false color";
  case Add::kShapes:
    return "shapes";
  case Add::kNormals:
    return "normals";
  default:
    return "noise";
  }
}

OpenedLayer Open(const LayerGround& ground, Add& command, const std::string& label) {
  if (ground.field) {
    return OpenField(ground, command);
  }
  switch (command.kind_case()) {
  case Add::kImage:
    return OpenImage(ground, *command.mutable_image());
  case Add::kFalseColor:
    return OpenFalseColor(ground, *command.mutable_false_color());
  case Add::kShapes:
    return OpenShapes(ground, *command.mutable_shapes());
  case Add::kNoise:
    return MakeNoise(command.noise());
  case Add::kNormals:
    return OpenNormals(ground.place, *command.mutable_normals(), ground.cacheFolder, label);
  default:
    Reject(label,
           "the layer has no kind; accepted: an image, false colour, shapes, noise, normals");
  }
}

void Warn(const Context& context, const ColorLayer& layer) {
  for (const std::string& warning : layer.Warnings()) {
    context.reply.add_warning(warning);
  }
}

// The layer that marks interpolated ground is listed last, as it is painted, unless a command moves
// another there.
std::optional<std::size_t> UnderFilled(const TerrainLayers& layers) {
  v1::TerrainLayerList list;
  layers.Describe(list);
  const int top = list.layer_size() - 1;
  if (top >= 0 && list.layer(top).kind() == v1::TerrainLayerReply::FILLED) {
    return std::size_t(top);
  }
  return std::nullopt;
}

// Triangles have one image of normals for all viewports.
void RequireForTriangles(const Add& command, const std::string& label) {
  if (command.kind_case() != Add::kNormals || !command.field().empty()) {
    throw Error(Error::Kind::Unsupported, label,
                "it is drawn as triangles, which take no colour layers; accepted: layers of "
                "normals, or mode clipmap");
  }
  const bool own =
      !command.fragment().empty() && command.fragment() != Membership::Physical().fragment;
  if (own || (command.has_nature() && command.nature() != v1::PHYSICAL)) {
    throw Error(Error::Kind::Unsupported, label,
                "it is drawn as triangles, whose layers are shown in all viewports; accepted: "
                "physical layers without a fragment of their own, or mode clipmap");
  }
}

// The layer that was opened before the command (TerrainBeforehand.h), if it lies on this ground.
OpenedLayer TakeOrOpen(const ClipmapTerrainObject& terrain, Add& command,
                       const std::string& label) {
  const LayerGround ground = GroundOf(terrain, command, label);
  ReadBeforehand* before = ReadBeforehand::Current();
  if (!before || !before->layer || before->askedLayer != command.SerializeAsString() ||
      before->layer->ground.lock() != terrain.SharedSurface()) {
    return Open(ground, command, label);
  }
  NoteFilesRead(before->files);
  command = before->layer->command;
  OpenedLayer opened = std::move(*before->layer);
  before->layer.reset();
  return opened;
}

void AddTerrainLayer(const Context& context, Add& command) {
  TerrainObject& terrain = FindTerrain(context, command.terrain());
  TerrainLayers& layers = LayersOf(terrain);
  const std::string label = "terrain '" + command.terrain() + "'";
  if (!AsClipmap(terrain)) {
    RequireForTriangles(command, label);
  }
  StackedLayer stacked;
  stacked.name =
      command.name().empty() ? layers.FreeName(WordFor(command.kind_case())) : command.name();
  RequireName("layer", stacked.name);
  if (layers.Has(stacked.name)) {
    throw Error(Error::Kind::AlreadyExists, label,
                "it has a layer '" + stacked.name + "' already; accepted: another name");
  }
  RequireFraction(label, "the opacity of a layer", command.has_opacity() ? command.opacity() : 1.0);
  stacked.opacity = command.has_opacity() ? command.opacity() : stacked.opacity;
  stacked.visible = !command.hidden();
  stacked.member = MemberOf(context.GetScene(), command, label + ", layer '" + stacked.name + "'");
  std::optional<std::size_t> position;
  if (command.has_position()) {
    position = command.position();
  } else {
    position = UnderFilled(layers);
  }
  ClipmapTerrainObject* clipmap = AsClipmap(terrain);
  OpenedLayer opened = clipmap
                           ? TakeOrOpen(*clipmap, command, label)
                           : OpenNormals(terrain.Place(), *command.mutable_normals(), "", label);
  stacked.layer = opened.layer;
  command.set_name(stacked.name);
  layers.Add(std::move(stacked), position, std::move(opened.about));
  ShowChange(context, terrain, [&] { layers.Remove(command.name()); });
  Warn(context, *opened.layer);
  *context.reply.mutable_terrain_layer() = layers.Describe(command.name());
}

void ChangeTerrainLayer(const Context& context, v1::ChangeTerrainLayer& command) {
  TerrainObject& terrain = FindTerrain(context, command.terrain());
  TerrainLayers& layers = LayersOf(terrain);
  std::optional<double> opacity;
  std::optional<bool> visible;
  std::optional<std::size_t> position;
  if (command.has_opacity()) {
    opacity = command.opacity();
  }
  if (command.has_visible()) {
    visible = command.visible();
  }
  if (command.has_position()) {
    position = command.position();
  }
  const v1::TerrainLayerReply present = layers.Describe(command.name()); // throws: there is none
  std::optional<std::string> fragment;
  if (!command.fragment().empty()) {
    const std::string label = "terrain '" + command.terrain() + "', layer '" + command.name() + "'";
    if (!AsClipmap(terrain) && command.fragment() != present.fragment()) {
      throw Error(Error::Kind::Unsupported, label,
                  "its terrain is drawn as triangles, whose layers are shown in all viewports; "
                  "accepted: no fragment, or mode clipmap");
    }
    fragment = context.GetScene()
                   .Fragments()
                   .Member(label, ToNature(present.nature(), label), command.fragment())
                   .fragment;
  }
  layers.Stack().Change(command.name(), opacity, visible, position, fragment);
  ShowChange(context, terrain, [&] {
    layers.Stack().Change(command.name(), present.opacity(), present.visible(), present.position());
  });
  *context.reply.mutable_terrain_layer() = layers.Describe(command.name());
}

void RemoveTerrainLayer(const Context& context, v1::RemoveTerrainLayer& command) {
  TerrainObject& terrain = FindTerrain(context, command.terrain());
  TerrainLayers& layers = LayersOf(terrain);
  const v1::TerrainLayerReply present = layers.Describe(command.name()); // throws: there is none
  const StackedLayer removed = layers.Stack().Layers()[present.position()];
  layers.Remove(command.name());
  ShowChange(context, terrain, [&] { layers.Add(removed, present.position(), present); });
}

void ListTerrainLayers(const Context& context, v1::ListTerrainLayers& command) {
  TerrainObject& terrain = FindTerrain(context, command.terrain());
  v1::TerrainLayerList& list = *context.reply.mutable_terrain_layers();
  if (const ClipmapTerrainObject* clipmap = AsClipmap(terrain)) {
    clipmap->DescribeLayers(list);
  } else {
    dynamic_cast<MeshTerrain&>(terrain).DescribeLayers(list);
  }
}

} // namespace

void AddDrape(const Context& context, ClipmapTerrainObject& terrain,
              v1::OpenTerrain::Drape& drape) {
  OpenedLayer opened =
      OpenImage(LayerGround{PlaceOf(terrain.Surface()), terrain.CacheFolder(), {}, {}}, drape);
  Warn(context, *opened.layer);
  StackedLayer stacked;
  stacked.name = "drape";
  stacked.member = Membership::Physical();
  stacked.layer = opened.layer;
  terrain.Layers().Add(std::move(stacked), 0, std::move(opened.about));
}

void AddFilled(const Context& context, ClipmapTerrainObject& terrain,
               const StreamedTerrainOptions& options) {
  FilledLayerOptions holes;
  holes.network = options.elevation.network;
  holes.cacheFolder = terrain.CacheFolder();
  std::vector<FilledLayerPatch> patches;
  for (const TerrainPatch& patch : options.patches) {
    patches.push_back({patch.path, patch.elevation.band, patch.elevation.crs});
  }
  const ElevationInfo& info = terrain.Surface().Info();
  StackedLayer stacked;
  stacked.name = "filled";
  stacked.mark = true;
  stacked.opacity = 0.4;
  stacked.layer = OpenFilledLayer(info.path, options.elevation.band, PlaceOf(terrain.Surface()),
                                  info.window, holes, patches);
  Warn(context, *stacked.layer);
  v1::TerrainLayerReply about;
  about.set_kind(v1::TerrainLayerReply::FILLED);
  about.set_path(info.path);
  terrain.Layers().Add(std::move(stacked), std::nullopt, std::move(about));
}

std::function<void(ReadBeforehand&)> LayerReader(SceneState& state, const Add& command) {
  const auto found = state.terrains.find(command.terrain());
  auto* terrain = found == state.terrains.end()
                      ? nullptr
                      : dynamic_cast<ClipmapTerrainObject*>(&*found->second);
  if (!terrain || command.kind_case() == Add::kNoise) {
    return {}; // nothing is read, or the command reads it, or says what is wrong
  }
  const std::string label = "terrain '" + command.terrain() + "'";
  try {
    const LayerGround ground = GroundOf(*terrain, command, label);
    const std::weak_ptr<const StreamedTerrain> surface = terrain->SharedSurface();
    return [ground, surface, label, command](ReadBeforehand& into) {
      Add opened = command;
      const FilesReadScope files;
      auto layer = std::make_shared<OpenedLayer>(Open(ground, opened, label));
      layer->command = opened;
      layer->ground = surface;
      into.layer = std::move(layer);
      into.files = files.Files();
      into.askedLayer = command.SerializeAsString();
    };
  } catch (const Error&) {
    return {}; // the command gives the error
  }
}

void AddTerrainLayerCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kAddTerrainLayer, &C::mutable_add_terrain_layer, AddTerrainLayer);
  registry.Add(C::kChangeTerrainLayer, &C::mutable_change_terrain_layer, ChangeTerrainLayer);
  registry.Add(C::kRemoveTerrainLayer, &C::mutable_remove_terrain_layer, RemoveTerrainLayer);
  registry.Add(C::kListTerrainLayers, &C::mutable_list_terrain_layers, ListTerrainLayers);
}

} // namespace dspace::session
