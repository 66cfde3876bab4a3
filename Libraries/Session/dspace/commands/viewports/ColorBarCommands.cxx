// Colour bars over a viewport's picture.
#include <algorithm>

#include <dspace/Checks.h>
#include <dspace/commands/viewports/ViewportCommands.h>
#include <dspace/messages/Convert.h>

#include "vtkDspaceViewport.h"

namespace dspace::session {
namespace {

ColorBar ToColorBar(const v1::SetColorBar& command) {
  const std::string label = "colour bar '" + command.name() + "'";
  ColorBar bar;
  bar.name = command.name();
  bar.title = command.title();
  bar.unit = command.unit();
  bar.low = command.low();
  bar.high = command.high();
  for (const v1::Color& color : command.color()) {
    bar.colors.push_back(ToColor(color, label));
  }
  bar.values.assign(command.value().begin(), command.value().end());
  bar.horizontal = command.horizontal();
  if (!v1::SetTextTable::Anchor_IsValid(command.anchor())) {
    Reject(label, "its anchor is " + std::to_string(int(command.anchor())) + "; accepted: 0 to 3");
  }
  if (command.has_anchor()) {
    bar.anchor = static_cast<TextTable::Anchor>(command.anchor());
  }
  const auto take = [](bool given, std::uint32_t value, int& to) {
    if (given) {
      to = ToInt(value);
    }
  };
  take(command.has_ticks(), command.ticks(), bar.ticks);
  take(command.has_margin(), command.margin(), bar.margin);
  take(command.has_length(), command.length(), bar.length);
  take(command.has_thickness(), command.thickness(), bar.thickness);
  take(command.has_font_size(), command.font_size(), bar.fontSize);
  if (command.has_text_color()) {
    const auto color = ToColor(command.text_color(), label);
    std::copy(color.begin(), color.end(), bar.textColor.begin());
  }
  if (command.has_opacity()) {
    bar.textColor[3] = command.opacity();
  }
  if (command.has_background()) {
    const auto color = ToColor(command.background(), label);
    std::copy(color.begin(), color.end(), bar.backgroundColor.begin());
  }
  if (command.has_background_opacity()) {
    bar.backgroundColor[3] = command.background_opacity();
  }
  if (command.terrain().empty() && !command.layer().empty()) {
    Reject(label, "it explains layer '" + command.layer() +
                      "' of no terrain; accepted: a terrain with it, or neither");
  }
  bar.terrain = command.terrain();
  bar.layer = command.layer();
  return bar;
}

} // namespace

void ViewportCommands::SetBar(const Context&, v1::SetColorBar& command) {
  this->Get(command.viewport()).SetColorBar(ToColorBar(command));
}

void ViewportCommands::RemoveBar(const Context&, v1::RemoveColorBar& command) {
  this->Get(command.viewport()).RemoveColorBar(command.name());
}

void ViewportCommands::AddColorBarsTo(Registry& registry) {
  using C = v1::Command;
  registry.Add(
      C::kSetColorBar, &C::mutable_set_color_bar,
      [this](const Context& context, v1::SetColorBar& command) { this->SetBar(context, command); },
      Needs::Nothing);
  registry.Add(
      C::kRemoveColorBar, &C::mutable_remove_color_bar,
      [this](const Context& context, v1::RemoveColorBar& command) {
        this->RemoveBar(context, command);
      },
      Needs::Nothing);
}

} // namespace dspace::session
