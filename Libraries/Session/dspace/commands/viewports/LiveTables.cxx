#include <dspace/commands/viewports/LiveTables.h>

#include <algorithm>
#include <array>
#include <functional>

#include <dspace/Checks.h>
#include <dspace/messages/Convert.h>
#include <dspace/overlay/Overlay.h>
#include <dspace/overlay/TextCharacters.h>
#include <dspace/render/text/Fonts.h>
#include <dspace/state/TelemetryColors.h>

#include "vtkDspaceViewport.h"

namespace dspace::session {
namespace {

constexpr std::uint32_t MostDigits = 15;
constexpr std::size_t MostShown = 200; // bytes of a text of telemetry that does not fit

using Cell = std::function<std::string(const v1::SetTextTable::Row&)>;

TextTable ToTable(const v1::SetTextTable& command, const Cell& live) {
  const std::string label = "text table '" + command.name() + "'";
  TextTable table;
  table.name = command.name();
  table.title = command.title();
  for (const v1::SetTextTable::Row& row : command.row()) {
    table.rows.emplace_back(row.label(), row.telemetry().empty() ? row.value() : live(row));
    if (row.digits() > MostDigits) {
      Reject(label, "the digits of " + QuotedText(row.telemetry()) + " are " +
                        std::to_string(row.digits()) + "; accepted: 0 to " +
                        std::to_string(MostDigits));
    }
  }
  if (!v1::SetTextTable::Anchor_IsValid(command.anchor())) {
    Reject(label, "its anchor is " + std::to_string(int(command.anchor())) + "; accepted: 0 to 3");
  }
  table.anchor = static_cast<TextTable::Anchor>(command.anchor());
  if (command.has_margin()) {
    table.margin = ToInt(command.margin());
  }
  if (command.has_font_size()) {
    table.fontSize = ToInt(command.font_size());
  }
  if (command.has_color()) {
    const auto color = ToColor(command.color(), label);
    std::copy(color.begin(), color.end(), table.textColor.begin());
  }
  if (command.has_opacity()) {
    table.textColor[3] = command.opacity();
  }
  if (command.has_background()) {
    const auto color = ToColor(command.background(), label);
    std::copy(color.begin(), color.end(), table.backgroundColor.begin());
  }
  if (command.has_background_opacity()) {
    table.backgroundColor[3] = command.background_opacity();
  }
  return table;
}

bool IsLive(const v1::SetTextTable& command) {
  return std::any_of(command.row().begin(), command.row().end(),
                     [](const auto& row) { return !row.telemetry().empty(); });
}

// The characters that can be drawn, '?' for each other one.
std::string Drawable(const std::string& text) {
  std::string drawable;
  for (std::size_t at = 0; at < text.size() && drawable.size() < MostShown;) {
    std::size_t end = at + 1;
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) {
      ++end;
    }
    const std::string character = text.substr(at, end - at);
    try {
      RequirePlainText("", "", character, false);
      RequireGlyphs("", "", character, Font::Mono);
      drawable += character;
    } catch (const Error&) {
      drawable += '?';
    }
    at = end;
  }
  return drawable + (drawable.size() < MostShown ? "" : "...");
}

// Numbers beyond their limits, against the table's own colours.
void ColorValues(const v1::SetTextTable& command, const Telemetry& telemetry, TextTable& table) {
  for (int i = 0; i < command.row_size(); ++i) {
    const Telemetry::Channel* channel = telemetry.Find(command.row(i).telemetry());
    const auto state = channel ? StateOf(*channel) : v1::TelemetryInfo::NO_VALUE;
    if (state == v1::TelemetryInfo::WARNING || state == v1::TelemetryInfo::ALARM) {
      table.valueColors[std::size_t(i)] =
          state == v1::TelemetryInfo::ALARM ? AlarmColor : WarningColor;
    }
  }
}

// False if the viewport rejects it.
bool Put(const v1::SetTextTable& command, vtkDspaceViewport& viewport, const Telemetry& telemetry,
         const Cell& live) {
  try {
    TextTable table = ToTable(command, live);
    ColorValues(command, telemetry, table);
    viewport.SetTextTable(table);
    return true;
  } catch (const Error&) {
    return false;
  }
}

} // namespace

void LiveTables::Set(const v1::SetTextTable& command, vtkDspaceViewport& viewport) {
  // Values that are not there yet are the widest that is promised to fit.
  const TextTable table = ToTable(
      command, [](const auto& row) { return row.value().empty() ? "\u2013" : row.value(); });
  table.Check();
  viewport.SetTextTable(table);
  this->Remove(command.viewport(), command.name());
  if (IsLive(command)) {
    Viewport& own = this->Viewports_[command.viewport()];
    own.tables[command.name()] = command;
    own.fresh = true;
  }
}

void LiveTables::Remove(const std::string& viewport, const std::string& table) {
  const auto found = this->Viewports_.find(viewport);
  if (found != this->Viewports_.end()) {
    found->second.tables.erase(table);
    if (found->second.tables.empty()) {
      this->Viewports_.erase(found);
    }
  }
}

void LiveTables::Update(const std::string& name, const Telemetry& telemetry,
                        vtkDspaceViewport& viewport) {
  const auto found = this->Viewports_.find(name);
  if (found == this->Viewports_.end() ||
      (!found->second.fresh && found->second.revision == telemetry.Revision())) {
    return;
  }
  for (const auto& [table, command] : found->second.tables) {
    const auto shown = [&](const auto& row) { return ShownTelemetry(telemetry, row); };
    // What cannot be drawn is never left as the value that was there before.
    if (!Put(command, viewport, telemetry, shown) &&
        !Put(command, viewport, telemetry, [&](const auto& row) { return Drawable(shown(row)); })) {
      Put(command, viewport, telemetry, [](const auto&) { return "?"; });
    }
  }
  found->second.revision = telemetry.Revision();
  found->second.fresh = false;
}

} // namespace dspace::session
