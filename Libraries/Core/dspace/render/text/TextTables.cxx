#include <dspace/render/text/TextTables.h>

#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkTextActor.h"

#include <dspace/overlay/TextCharacters.h>
#include <dspace/render/text/Fonts.h>
#include <dspace/render/text/TextTableActor.h>

namespace dspace {

void TextTables::Place(Placed& placed, vtkRenderer* overlay, int width, int height) {
  placed.actors = MakeTextTableActors(placed.table, width, height);
  for (const auto& actor : placed.actors) {
    overlay->AddViewProp(actor);
  }
}

void TextTables::RemoveActors(const Placed& placed, vtkRenderer* overlay) {
  for (const auto& actor : placed.actors) {
    overlay->RemoveViewProp(actor);
  }
}

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
  Placed& placed = this->Placed_[table.name];
  RemoveActors(placed, overlay);
  placed.table = table;
  Place(placed, overlay, width, height);
  return true;
}

bool TextTables::Remove(const std::string& name, vtkRenderer* overlay) {
  const auto found = this->Placed_.find(name);
  if (found == this->Placed_.end()) {
    return false;
  }
  RemoveActors(found->second, overlay);
  this->Placed_.erase(found);
  return true;
}

void TextTables::Resize(vtkRenderer* overlay, int width, int height) {
  for (auto& entry : this->Placed_) {
    RemoveActors(entry.second, overlay);
    Place(entry.second, overlay, width, height);
  }
}

void TextTables::Raise(vtkRenderer* overlay) const {
  vtkPropCollection* all = overlay->GetViewProps(); // RemoveViewProp would release their textures
  for (const auto& entry : this->Placed_) {
    for (const auto& prop : entry.second.actors) {
      const vtkSmartPointer<vtkProp> held = prop.Get();
      all->RemoveItem(held);
      all->AddItem(held);
    }
  }
}

} // namespace dspace
