#include <dspace/render/TextTables.h>

#include "vtkRenderer.h"
#include "vtkTextActor.h"

#include <dspace/render/Fonts.h>
#include <dspace/render/TextTableActor.h>
#include <dspace/scene/TextCharacters.h>

namespace dspace {

bool TextTables::Set(const TextTable& table, vtkRenderer* overlay, int width, int height) {
  table.Check();
  const auto found = this->Placed_.find(table.name);
  if (found != this->Placed_.end() && found->second.table == table) {
    return false;
  }
  const std::string object = "text table '" + table.name + "'";
  RequireGlyphs(object, "its title", table.title, Font::Mono);
  for (const auto& row : table.rows) {
    RequireGlyphs(object, "a label", row.first, Font::Mono);
    RequireGlyphs(object, ("the value of " + QuotedText(row.first)).c_str(), row.second,
                  Font::Mono);
  }
  auto actor = MakeTextTableActor(table, width, height);
  if (found != this->Placed_.end()) {
    overlay->RemoveViewProp(found->second.actor);
  }
  overlay->AddViewProp(actor);
  this->Placed_[table.name] = {table, actor};
  return true;
}

bool TextTables::Remove(const std::string& name, vtkRenderer* overlay) {
  const auto found = this->Placed_.find(name);
  if (found == this->Placed_.end()) {
    return false;
  }
  overlay->RemoveViewProp(found->second.actor);
  this->Placed_.erase(found);
  return true;
}

void TextTables::Resize(vtkRenderer* overlay, int width, int height) {
  for (auto& entry : this->Placed_) {
    Placed& placed = entry.second;
    overlay->RemoveViewProp(placed.actor);
    placed.actor = MakeTextTableActor(placed.table, width, height);
    overlay->AddViewProp(placed.actor);
  }
}

} // namespace dspace
