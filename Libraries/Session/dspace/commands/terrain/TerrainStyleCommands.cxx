// The overlays of a terrain's own colour.
#include <algorithm>

#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/commands/terrain/ClipmapTerrainObject.h>
#include <dspace/commands/terrain/TerrainLook.h>
#include <dspace/commands/terrain/TerrainTools.h>
#include <dspace/mesh/DrapeImage.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/Checks.h>

namespace dspace::session {
namespace {

ClipmapStyle::Lines ToLines(const v1::StyleTerrain::Lines& lines, const std::string& label) {
  ClipmapStyle::Lines result;
  result.interval = lines.interval();
  result.width = lines.width();
  result.color = ToColor(lines.color(), label);
  result.opacity = lines.opacity();
  return result;
}

ClipmapStyle::GridLabels ToGridLabels(const v1::StyleTerrain::GridLabels& labels,
                                      const std::string& label) {
  ClipmapStyle::GridLabels result;
  if (labels.has_font_size()) { // values beyond the range of int become the largest int, which is
                                // rejected
    result.fontSize = int(std::min<std::uint32_t>(labels.font_size(), 0x7fffffffu));
  }
  if (labels.has_color()) {
    result.color = ToColor(labels.color(), label);
  }
  if (labels.has_background()) {
    result.background = ToColor(labels.background(), label);
  }
  if (labels.has_background_opacity()) {
    result.backgroundOpacity = labels.background_opacity();
  }
  return result;
}

// North blue, east green, south yellow, west red, and north again.
ColorRamp AspectRamp() {
  return {{0.23, 0.40, 0.85},
          {0.25, 0.65, 0.40},
          {0.95, 0.85, 0.30},
          {0.80, 0.28, 0.30},
          {0.23, 0.40, 0.85}};
}

ClipmapStyle::Ramp ToRamp(const v1::StyleTerrain::Ramp& ramp, const StreamedTerrain& surface,
                          const std::string& label) {
  using Ramp = v1::StyleTerrain::Ramp;
  ClipmapStyle::Ramp result;
  if (!Ramp::By_IsValid(ramp.by())) {
    Refuse(label, "a ramp by " + std::to_string(ramp.by()) +
                      " is not known; accepted: height, slope, aspect, normal");
  }
  result.by = static_cast<ClipmapStyle::Ramp::By>(ramp.by());
  result.opacity = ramp.opacity();
  if (ramp.by() == Ramp::NORMAL) {
    if (ramp.has_low() || ramp.has_high() || ramp.color_size() > 0) {
      Refuse(label, "normals have colours of their own; accepted: no range and no colours");
    }
    return result;
  }
  result.range = ramp.by() == Ramp::HEIGHT   ? surface.HeightRange()
                 : ramp.by() == Ramp::ASPECT ? std::array<double, 2>{0.0, 360.0}
                                             : std::array<double, 2>{0.0, 45.0};
  if (ramp.has_low()) {
    result.range[0] = ramp.low();
  }
  if (ramp.has_high()) {
    result.range[1] = ramp.high();
  }
  if (!ramp.has_low() && !ramp.has_high() && result.range[0] == result.range[1]) {
    result.range[1] += 1.0; // level ground
  }
  ColorRamp colors;
  for (const v1::Color& color : ramp.color()) {
    colors.push_back(ToColor(color, label));
  }
  if (colors.empty()) {
    colors = ramp.by() == Ramp::ASPECT ? AspectRamp() : TerrainRamp();
  }
  result.image = RampImage(colors);
  result.colors = colors;
  return result;
}

ClipmapStyle::Noise ToNoise(const v1::StyleTerrain::Noise& noise) {
  ClipmapStyle::Noise result;
  result.options.wavelength = noise.wavelength();
  result.options.octaves = static_cast<int>(std::min(noise.octaves(), 1000U)); // rejected later
  result.options.gain = noise.gain();
  result.options.seed = noise.seed();
  result.amplitude = noise.amplitude();
  return result;
}

ClipmapStyle::Detail ToDetail(const Context& context, v1::StyleTerrain::Detail& detail) {
  ClipmapStyle::Detail result;
  detail.set_path(AbsolutePath(detail.path()));
  result.image = context.state.models.LoadImage(detail.path());
  result.size = detail.size();
  result.slopes = {detail.slope_low(), detail.slope_high()};
  if (detail.has_height_low()) {
    result.heights[0] = detail.height_low();
  }
  if (detail.has_height_high()) {
    result.heights[1] = detail.height_high();
  }
  result.opacity = detail.opacity();
  return result;
}

ClipmapTerrain& FindClipmap(const Context& context, const std::string& name) {
  auto* terrain = dynamic_cast<ClipmapTerrainObject*>(&FindTerrain(context, name));
  if (!terrain) {
    throw Error(Error::Kind::Unsupported, "terrain '" + name + "'",
                "it is drawn as triangles, which have no style; accepted: mode clipmap");
  }
  return terrain->Clipmap();
}

void DescribeTerrainStyle(const Context& context, v1::DescribeTerrainStyle& command) {
  const ClipmapStyle& style = FindClipmap(context, command.terrain()).Style();
  v1::TerrainStyleReply* reply = context.reply.mutable_terrain_style();
  if (style.ramp) {
    v1::StyleTerrain::Ramp* ramp = reply->mutable_ramp();
    ramp->set_by(static_cast<v1::StyleTerrain::Ramp::By>(style.ramp->by));
    if (style.ramp->by != ClipmapStyle::Ramp::By::Normal) {
      ramp->set_low(style.ramp->range[0]);
      ramp->set_high(style.ramp->range[1]);
    }
    for (const std::array<double, 3>& color : style.ramp->colors) {
      v1::Color* to = ramp->add_color();
      to->set_r(color[0]);
      to->set_g(color[1]);
      to->set_b(color[2]);
    }
    ramp->set_opacity(style.ramp->opacity);
  }
}

void StyleTerrain(const Context& context, v1::StyleTerrain& command) {
  const std::string label = "terrain '" + command.terrain() + "'";
  FindClipmap(context, command.terrain());
  auto* terrain = dynamic_cast<ClipmapTerrainObject*>(&FindTerrain(context, command.terrain()));
  ClipmapStyle style;
  for (v1::StyleTerrain::Detail& detail : *command.mutable_detail()) {
    style.details.push_back(ToDetail(context, detail));
  }
  if (command.has_ramp()) {
    style.ramp = ToRamp(command.ramp(), terrain->Surface(), label);
  }
  if (command.has_tracks()) {
    style.tracks.color = ToColor(command.tracks().color(), label);
    style.tracks.opacity = command.tracks().opacity();
  }
  if (command.has_levels()) {
    style.levels = command.levels();
  }
  if (command.has_contours()) {
    style.contours = ToLines(command.contours(), label);
  }
  if (command.has_grid()) {
    style.grid = ToLines(command.grid(), label);
  }
  if (command.has_grid_labels()) {
    style.gridLabels = ToGridLabels(command.grid_labels(), label);
    style.gridLabels->degrees = terrain->Surface().Placement().OnBody() ||
                                terrain->Surface().GetCrs().GetKind() == Crs::Kind::Geographic;
  }
  if (command.has_noise()) {
    style.noise = ToNoise(command.noise());
  }
  style.Check(label);
  terrain->Clipmap().SetStyle(style);
}

} // namespace

void AddTerrainStyleCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kStyleTerrain, &C::mutable_style_terrain, StyleTerrain);
  registry.Add(C::kDescribeTerrainStyle, &C::mutable_describe_terrain_style, DescribeTerrainStyle);
}

} // namespace dspace::session
