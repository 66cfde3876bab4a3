#include <dspace/render/text/TextTableActor.h>

#include <algorithm>
#include <set>

#include "vtkTextActor.h"
#include "vtkTextProperty.h"

#include <dspace/overlay/TextLimits.h>
#include <dspace/render/text/OverlayText.h>

namespace dspace {
namespace {

std::string Padded(const std::string& text, std::size_t width, bool right) {
  const std::string blanks(width - CharacterCount(text), ' ');
  return right ? blanks + text : text + blanks;
}

using ValueColor = std::array<double, 3>;

// The block with what is in one colour, null for the text's own, and blanks for the rest.
std::string TextOf(const TextTable& table, const ValueColor* color) {
  std::size_t label = 0;
  std::size_t value = 0;
  for (const auto& row : table.rows) {
    label = std::max(label, CharacterCount(row.first));
    value = std::max(value, CharacterCount(row.second));
  }
  const std::size_t line = std::max(label + 2 + value, CharacterCount(table.title));
  std::string text;
  if (!table.title.empty()) {
    text = " " + Padded(color ? "" : table.title, line, false) + " ";
  }
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& [name, shown] = table.rows[i];
    const auto own = table.valueColors.find(i);
    const bool here = own == table.valueColors.end() ? !color : color && own->second == *color;
    text += (text.empty() ? " " : "\n ") + Padded(color ? "" : name, line - value, false) +
            Padded(here ? shown : "", value, true) + " ";
  }
  return text;
}

vtkSmartPointer<vtkTextActor> MakeActor(const TextTable& table, const ValueColor* color, int width,
                                        int height) {
  std::array<double, 4> shown = table.textColor;
  if (color) {
    std::copy(color->begin(), color->end(), shown.begin());
  }
  auto actor = MakeOverlayText(TextOf(table, color), table.fontSize, shown);
  vtkTextProperty* look = actor->GetTextProperty();
  look->SetBackgroundColor(table.backgroundColor[0], table.backgroundColor[1],
                           table.backgroundColor[2]);
  look->SetBackgroundOpacity(color ? 0.0 : table.backgroundColor[3]);
  const bool left =
      table.anchor == TextTable::Anchor::TopLeft || table.anchor == TextTable::Anchor::BottomLeft;
  const bool top =
      table.anchor == TextTable::Anchor::TopLeft || table.anchor == TextTable::Anchor::TopRight;
  left ? look->SetJustificationToLeft() : look->SetJustificationToRight();
  top ? look->SetVerticalJustificationToTop() : look->SetVerticalJustificationToBottom();
  actor->SetPosition(left ? table.margin : width - table.margin,
                     top ? height - table.margin : table.margin);
  return actor;
}

} // namespace

std::vector<vtkSmartPointer<vtkTextActor>> MakeTextTableActors(const TextTable& table, int width,
                                                               int height) {
  std::vector<vtkSmartPointer<vtkTextActor>> actors{MakeActor(table, nullptr, width, height)};
  std::set<ValueColor> colors;
  for (const auto& entry : table.valueColors) {
    colors.insert(entry.second);
  }
  for (const ValueColor& color : colors) {
    actors.push_back(MakeActor(table, &color, width, height));
  }
  return actors;
}

} // namespace dspace
