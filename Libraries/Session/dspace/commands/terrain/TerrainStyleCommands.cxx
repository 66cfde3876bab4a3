// The overlays of a terrain's own colour.
#include <algorithm>
#include <cstdint>
#include <optional>

#include <dspace/Checks.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/commands/terrain/ClipmapTerrainObject.h>
#include <dspace/commands/terrain/TerrainLook.h>
#include <dspace/commands/terrain/TerrainTools.h>
#include <dspace/layers/ColorRamp.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

// `what`: "its contours".
Membership ToMember(const Scene& scene, const v1::StyleTerrain::Membership& member, Nature standard,
                    const std::string& label, const std::string& what) {
  const std::string object = label + ", " + what;
  return scene.Fragments().Member(
      object, member.has_nature() ? ToNature(member.nature(), object) : standard,
      member.fragment());
}

ClipmapStyle::Lines ToLines(const Scene& scene, const v1::StyleTerrain::Lines& lines,
                            const std::string& label, const std::string& what) {
  ClipmapStyle::Lines result;
  result.member = ToMember(scene, lines.member(), Nature::Ornamental, label, what);
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

ClipmapStyle::Ramp ToRamp(const Scene& scene, const v1::StyleTerrain::Ramp& ramp,
                          const StreamedTerrain& surface, const std::string& label) {
  using Ramp = v1::StyleTerrain::Ramp;
  ClipmapStyle::Ramp result;
  result.member = ToMember(scene, ramp.member(), Nature::Ornamental, label, "its ramp");
  if (!Ramp::By_IsValid(ramp.by())) {
    Reject(label, "a ramp by " + std::to_string(ramp.by()) +
                      " is not known; accepted: height, slope, aspect, normal");
  }
  result.by = static_cast<ClipmapStyle::Ramp::By>(ramp.by());
  result.opacity = ramp.opacity();
  result.shaded = ramp.shaded();
  if (ramp.by() == Ramp::NORMAL) {
    if (ramp.has_low() || ramp.has_high() || ramp.color_size() > 0) {
      Reject(label, "normals have colours of their own; accepted: no range and no colours");
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

ClipmapStyle::Detail ToDetail(const Context& context, const Scene& scene,
                              v1::StyleTerrain::Detail& detail, const std::string& label) {
  ClipmapStyle::Detail result;
  result.member = ToMember(scene, detail.member(), Nature::Physical, label, "a detail");
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

ClipmapTerrainObject& FindClipmap(TerrainObject& found) {
  auto* terrain = dynamic_cast<ClipmapTerrainObject*>(&found);
  if (!terrain) {
    throw Error(Error::Kind::Unsupported, "terrain '" + found.Name() + "'",
                "it is drawn as triangles, which have no style; accepted: mode clipmap");
  }
  return *terrain;
}

const ViewportState& FindViewport(const Context& context, const std::string& name) {
  const auto found = context.state.viewports.find(name);
  if (found == context.state.viewports.end()) {
    throw Error(Error::Kind::NotFound, "viewport '" + name + "'", "there is no such viewport");
  }
  return found->second;
}

void DescribeTerrainStyle(const Context& context, v1::DescribeTerrainStyle& command) {
  ClipmapTerrainObject& found = FindClipmap(FindTerrain(context, command.terrain()));
  const ClipmapTerrain& terrain = found.Clipmap();
  v1::TerrainStyleReply* reply = context.reply.mutable_terrain_style();
  if (found.StyleCommand()) {
    *reply->mutable_given() = *found.StyleCommand();
  }
  if (!command.viewport().empty()) {
    FindViewport(context, command.viewport());
    reply->set_own(terrain.HasStyleIn(command.viewport()));
  }
  const ClipmapStyle style = terrain.StyleIn(command.viewport());
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
    ramp->set_shaded(style.ramp->shaded);
    ramp->mutable_member()->set_nature(FromNature(style.ramp->member.nature));
    ramp->mutable_member()->set_fragment(style.ramp->member.fragment);
  }
}

ClipmapStyle ToStyle(const Context& context, const Scene& scene, const StreamedTerrain& surface,
                     v1::StyleTerrain& command, const std::string& label) {
  ClipmapStyle style;
  for (v1::StyleTerrain::Detail& detail : *command.mutable_detail()) {
    style.details.push_back(ToDetail(context, scene, detail, label));
  }
  if (command.has_ramp()) {
    style.ramp = ToRamp(scene, command.ramp(), surface, label);
  }
  if (command.has_tracks()) {
    style.tracks.color = ToColor(command.tracks().color(), label);
    style.tracks.opacity = command.tracks().opacity();
    style.tracks.member =
        ToMember(scene, command.tracks().member(), Nature::Physical, label, "its tracks");
  }
  if (command.has_levels()) {
    style.levels = command.levels();
    style.levelsMember =
        ToMember(scene, command.levels_member(), Nature::Ornamental, label, "its levels");
  }
  if (command.has_contours()) {
    style.contours = ToLines(scene, command.contours(), label, "its contours");
  }
  if (command.has_grid()) {
    style.grid = ToLines(scene, command.grid(), label, "its grid");
  }
  if (command.has_grid_labels()) {
    style.gridLabels = ToGridLabels(command.grid_labels(), label);
    style.gridLabels->degrees =
        surface.Placement().OnBody() || surface.GetCrs().GetKind() == Crs::Kind::Geographic;
  }
  if (command.has_noise()) {
    style.noise = ToNoise(command.noise());
  }
  style.Check(label);
  return style;
}

void StyleTerrain(const Context& context, v1::StyleTerrain& command) {
  ClipmapTerrainObject& terrain = FindClipmap(FindTerrain(context, command.terrain()));
  const ClipmapStyle style = ToStyle(context, context.GetScene(), terrain.Surface(), command,
                                     "terrain '" + command.terrain() + "'");
  terrain.Clipmap().SetStyle(style);
  v1::StyleTerrain given = command;
  if (style.gridLabels) { // with its defaults
    given.mutable_grid_labels()->set_font_size(std::uint32_t(style.gridLabels->fontSize));
    given.mutable_grid_labels()->set_background_opacity(style.gridLabels->backgroundOpacity);
  }
  terrain.SetStyleCommand(given);
}

void StyleTerrainInViewport(const Context& context, v1::StyleTerrainInViewport& command) {
  const std::string sceneName = FindViewport(context, command.viewport()).scene;
  SceneState& scene = context.state.FindScene(sceneName);
  const Context within{context.state, &scene, sceneName, context.reply};
  ClipmapTerrainObject& terrain = FindClipmap(FindTerrain(within, command.terrain()));
  std::optional<ClipmapStyle> style;
  if (command.has_style()) {
    const std::string label =
        "terrain '" + command.terrain() + "' in viewport '" + command.viewport() + "'";
    if (command.style().has_noise() || command.style().detail_size() > 0) {
      Reject(label, std::string("it is given ") +
                        (command.style().has_noise() ? "noise" : "details") +
                        ", which are the same in all viewports; accepted: a ramp, levels, "
                        "contours, a grid with its labels, tracks");
    }
    style = ToStyle(within, *scene.scene, terrain.Surface(), *command.mutable_style(), label);
  }
  terrain.Clipmap().SetStyleIn(command.viewport(), style);
}

} // namespace

void AddTerrainStyleCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kStyleTerrain, &C::mutable_style_terrain, StyleTerrain);
  registry.Add(C::kStyleTerrainInViewport, &C::mutable_style_terrain_in_viewport,
               StyleTerrainInViewport, Needs::Nothing); // viewports are the session's
  registry.Add(C::kDescribeTerrainStyle, &C::mutable_describe_terrain_style, DescribeTerrainStyle);
}

} // namespace dspace::session
