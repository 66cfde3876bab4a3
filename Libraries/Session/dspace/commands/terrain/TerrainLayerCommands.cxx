// The colour layers of a clipmap: added, changed, removed, listed.
#include <algorithm>
#include <utility>

#include <dspace/commands/terrain/ClipmapTerrainObject.h>
#include <dspace/commands/terrain/TerrainLook.h>
#include <dspace/commands/terrain/TerrainTools.h>
#include <dspace/layers/NoiseLayer.h>
#include <dspace/layers/raster/FalseColorLayer.h>
#include <dspace/layers/raster/FilledLayer.h>
#include <dspace/layers/raster/ImageLayer.h>
#include <dspace/layers/vector/VectorLayer.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/Checks.h>

namespace dspace::session {
namespace {

using Add = v1::AddTerrainLayer;

// A layer and its description.
struct Opened {
  std::shared_ptr<const ColorLayer> layer;
  v1::TerrainLayerReply about;
};

ClipmapTerrainObject& FindLayered(const Context& context, const std::string& name) {
  auto* terrain = dynamic_cast<ClipmapTerrainObject*>(&FindTerrain(context, name));
  if (!terrain) {
    throw Error(Error::Kind::Unsupported, "terrain '" + name + "'",
                "it is drawn as triangles, which take no colour layers; accepted: mode clipmap");
  }
  return *terrain;
}

RasterPlace PlaceOf(const StreamedTerrain& surface) {
  const ElevationInfo& info = surface.Info();
  return {surface.GetName(), info.crs, info.pixelToMap, info.window.width, info.window.height};
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

template<class Message> Opened OpenImage(const ClipmapTerrainObject& terrain, Message& from) {
  from.set_path(AbsoluteRaster(from.path()));
  Opened opened;
  opened.layer = OpenImageLayer(from.path(), PlaceOf(terrain.Surface()),
                                ToRaster(from, terrain.CacheFolder()));
  opened.about.set_kind(v1::TerrainLayerReply::IMAGE);
  opened.about.set_path(from.path());
  return opened;
}

Opened OpenFalseColor(const ClipmapTerrainObject& terrain, Add::FalseColor& from) {
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
  const auto layer = OpenFalseColorLayer(from.path(), PlaceOf(terrain.Surface()), colors,
                                         ToRaster(from, terrain.CacheFolder()));
  Opened opened;
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

Opened OpenShapes(const ClipmapTerrainObject& terrain, Add::Shapes& from) {
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
  Opened opened;
  opened.layer = OpenVectorLayer(from.path(), PlaceOf(terrain.Surface()), options);
  opened.about.set_kind(v1::TerrainLayerReply::SHAPES);
  opened.about.set_path(from.path());
  return opened;
}

Opened MakeNoise(const Add::Noise& from) {
  constexpr double Contrast = 0.25;
  NoiseOptions options;
  options.wavelength = from.has_wavelength() ? from.wavelength() : options.wavelength;
  if (from.has_octaves()) {
    options.octaves = int(std::min<std::uint32_t>(from.octaves(), 1u << 30));
  }
  options.gain = from.has_gain() ? from.gain() : options.gain;
  options.seed = from.seed();
  Opened opened;
  opened.layer = MakeNoiseLayer(options, from.has_contrast() ? from.contrast() : Contrast);
  opened.about.set_kind(v1::TerrainLayerReply::NOISE);
  return opened;
}

const char* WordFor(Add::KindCase kind) {
  switch (kind) {
  case Add::kImage:
    return "image";
  case Add::kFalseColor:
    return "false color";
  case Add::kShapes:
    return "shapes";
  default:
    return "noise";
  }
}

Opened Open(const ClipmapTerrainObject& terrain, Add& command, const std::string& label) {
  switch (command.kind_case()) {
  case Add::kImage:
    return OpenImage(terrain, *command.mutable_image());
  case Add::kFalseColor:
    return OpenFalseColor(terrain, *command.mutable_false_color());
  case Add::kShapes:
    return OpenShapes(terrain, *command.mutable_shapes());
  case Add::kNoise:
    return MakeNoise(command.noise());
  default:
    Reject(label, "the layer has no kind; accepted: an image, false colour, shapes, noise");
  }
}

void Warn(const Context& context, const ColorLayer& layer) {
  for (const std::string& warning : layer.Warnings()) {
    context.reply.add_warning(warning);
  }
}

// The layer that marks interpolated ground stays on top, unless a command moves it.
std::optional<std::size_t> UnderFilled(const TerrainLayers& layers) {
  v1::TerrainLayerList list;
  layers.Describe(list);
  const int top = list.layer_size() - 1;
  if (top >= 0 && list.layer(top).kind() == v1::TerrainLayerReply::FILLED) {
    return std::size_t(top);
  }
  return std::nullopt;
}

void AddTerrainLayer(const Context& context, Add& command) {
  ClipmapTerrainObject& terrain = FindLayered(context, command.terrain());
  TerrainLayers& layers = terrain.Layers();
  const std::string label = "terrain '" + command.terrain() + "'";
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
  std::optional<std::size_t> position;
  if (command.has_position()) {
    position = command.position();
  } else {
    position = UnderFilled(layers);
  }
  Opened opened = Open(terrain, command, label);
  stacked.layer = opened.layer;
  command.set_name(stacked.name);
  layers.Add(std::move(stacked), position, std::move(opened.about));
  Warn(context, *opened.layer);
  *context.reply.mutable_terrain_layer() = layers.Describe(command.name());
}

void ChangeTerrainLayer(const Context& context, v1::ChangeTerrainLayer& command) {
  TerrainLayers& layers = FindLayered(context, command.terrain()).Layers();
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
  layers.Describe(command.name()); // throws where there is none
  layers.Stack().Change(command.name(), opacity, visible, position);
  *context.reply.mutable_terrain_layer() = layers.Describe(command.name());
}

void RemoveTerrainLayer(const Context& context, v1::RemoveTerrainLayer& command) {
  TerrainLayers& layers = FindLayered(context, command.terrain()).Layers();
  layers.Describe(command.name()); // throws where there is none
  layers.Remove(command.name());
}

void ListTerrainLayers(const Context& context, v1::ListTerrainLayers& command) {
  FindLayered(context, command.terrain()).DescribeLayers(*context.reply.mutable_terrain_layers());
}

} // namespace

void AddDrape(const Context& context, ClipmapTerrainObject& terrain,
              v1::OpenTerrain::Drape& drape) {
  Opened opened = OpenImage(terrain, drape);
  Warn(context, *opened.layer);
  StackedLayer stacked;
  stacked.name = "drape";
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
  stacked.opacity = 0.4;
  stacked.layer = OpenFilledLayer(info.path, options.elevation.band, PlaceOf(terrain.Surface()),
                                  info.window, holes, patches);
  Warn(context, *stacked.layer);
  v1::TerrainLayerReply about;
  about.set_kind(v1::TerrainLayerReply::FILLED);
  about.set_path(info.path);
  terrain.Layers().Add(std::move(stacked), std::nullopt, std::move(about));
}

void AddTerrainLayerCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kAddTerrainLayer, &C::mutable_add_terrain_layer, AddTerrainLayer);
  registry.Add(C::kChangeTerrainLayer, &C::mutable_change_terrain_layer, ChangeTerrainLayer);
  registry.Add(C::kRemoveTerrainLayer, &C::mutable_remove_terrain_layer, RemoveTerrainLayer);
  registry.Add(C::kListTerrainLayers, &C::mutable_list_terrain_layers, ListTerrainLayers);
}

} // namespace dspace::session
