#include <dspace/render/TextTableActor.h>

#include <algorithm>

#include "vtkCoordinate.h"
#include "vtkTextActor.h"
#include "vtkTextProperty.h"

namespace dspace {
namespace {

// Characters, not bytes, of UTF-8.
std::size_t Length(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

std::string Padded(const std::string& text, std::size_t width, bool right) {
  const std::string blanks(width - Length(text), ' ');
  return right ? blanks + text : text + blanks;
}

std::string TextOf(const TextTable& table) {
  std::size_t label = 0;
  std::size_t value = 0;
  for (const auto& row : table.rows) {
    label = std::max(label, Length(row.first));
    value = std::max(value, Length(row.second));
  }
  const std::size_t line = std::max(label + 2 + value, Length(table.title));
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
  look->SetFontFamilyToCourier();
  look->SetBold(1);
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
