#include <dspace/render/TextTableActor.h>

#include <algorithm>

#include "vtkCoordinate.h"
#include "vtkTextActor.h"
#include "vtkTextProperty.h"

#include <dspace/render/Fonts.h>
#include <dspace/scene/TextLimits.h>

namespace dspace {
namespace {

std::string Padded(const std::string& text, std::size_t width, bool right) {
  const std::string blanks(width - CharacterCount(text), ' ');
  return right ? blanks + text : text + blanks;
}

std::string TextOf(const TextTable& table) {
  std::size_t label = 0;
  std::size_t value = 0;
  for (const auto& row : table.rows) {
    label = std::max(label, CharacterCount(row.first));
    value = std::max(value, CharacterCount(row.second));
  }
  const std::size_t line = std::max(label + 2 + value, CharacterCount(table.title));
  std::string text;
  if (!table.title.empty()) {
    text = " " + Padded(table.title, line, false) + " ";
  }
  for (const auto& row : table.rows) {
    text += (text.empty() ? " " : "\n ") + Padded(row.first, line - value, false) +
            Padded(row.second, value, true) + " ";
  }
  return text;
}

} // namespace

vtkSmartPointer<vtkTextActor> MakeTextTableActor(const TextTable& table, int width, int height) {
  auto actor = vtkSmartPointer<vtkTextActor>::New();
  actor->SetInput(TextOf(table).c_str());
  actor->SetTextScaleModeToNone();
  vtkTextProperty* look = actor->GetTextProperty();
  UseFont(look, Font::Mono);
  look->SetFontSize(table.fontSize);
  look->SetColor(table.textColor[0], table.textColor[1], table.textColor[2]);
  look->SetOpacity(table.textColor[3]);
  look->SetBackgroundColor(table.backgroundColor[0], table.backgroundColor[1],
                           table.backgroundColor[2]);
  look->SetBackgroundOpacity(table.backgroundColor[3]);
  const bool left =
      table.anchor == TextTable::Anchor::TopLeft || table.anchor == TextTable::Anchor::BottomLeft;
  const bool top =
      table.anchor == TextTable::Anchor::TopLeft || table.anchor == TextTable::Anchor::TopRight;
  left ? look->SetJustificationToLeft() : look->SetJustificationToRight();
  top ? look->SetVerticalJustificationToTop() : look->SetVerticalJustificationToBottom();
  actor->GetPositionCoordinate()->SetCoordinateSystemToDisplay();
  actor->SetPosition(left ? table.margin : width - table.margin,
                     top ? height - table.margin : table.margin);
  return actor;
}

} // namespace dspace
