// What is laid over a terrain's own colour.
#include <algorithm>

#include <dspace/scene/Checks.h>
#include <dspace/session/ClipmapTerrainObject.h>
#include <dspace/session/Convert.h>
#include <dspace/session/ObjectTools.h>
#include <dspace/session/TerrainLook.h>
#include <dspace/session/TerrainTools.h>
#include <dspace/terrain/DrapeImage.h>

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

ClipmapStyle::Ramp ToRamp(const v1::StyleTerrain::Ramp& ramp, const StreamedTerrain& surface,
                          const std::string& label) {
  using Ramp = v1::StyleTerrain::Ramp;
  ClipmapStyle::Ramp result;
  if (!Ramp::By_IsValid(ramp.by())) {
    Refuse(label,
           "a ramp by " + std::to_string(ramp.by()) + " is not known; accepted: height, slope");
  }
  const bool height = ramp.by() == Ramp::HEIGHT;
  result.by = height ? ClipmapStyle::Ramp::By::Height : ClipmapStyle::Ramp::By::Slope;
  result.range = height ? surface.HeightRange() : std::array<double, 2>{0.0, 45.0};
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
  result.image = RampImage(colors.empty() ? TerrainRamp() : colors);
  result.opacity = ramp.opacity();
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

void StyleTerrain(const Context& context, v1::StyleTerrain& command) {
  const std::string label = "terrain '" + command.terrain() + "'";
  auto* terrain = dynamic_cast<ClipmapTerrainObject*>(&FindTerrain(context, command.terrain()));
  if (!terrain) {
    throw Error(Error::Kind::Unsupported, label,
                "it is drawn as triangles, which have no style; accepted: mode clipmap");
  }
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
  style.Check(label);
  terrain->Clipmap().SetStyle(style);
}

} // namespace

void AddTerrainStyleCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kStyleTerrain, &C::mutable_style_terrain, Effect::Change, StyleTerrain);
}

} // namespace dspace::session
