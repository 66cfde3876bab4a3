#include <dspace/ledger/LedgerViewports.h>

#include <algorithm>

#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/CommandTraits.h>
#include <dspace/state/State.h>

namespace dspace::session {
namespace {

template<class Message> void PutNamed(const Message& message, std::vector<Message>& all) {
  const auto found = std::find_if(
      all.begin(), all.end(), [&](const Message& each) { return each.name() == message.name(); });
  if (found == all.end()) {
    all.push_back(message);
  } else {
    *found = message;
  }
}

template<class Message> void RemoveNamed(const std::string& name, std::vector<Message>& all) {
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const Message& each) { return each.name() == name; }),
            all.end());
}

bool HasElementIn(const v1::StyleTerrain& style, const std::string& fragment) {
  const auto in = [&](const v1::StyleTerrain::Membership& member) {
    return member.fragment() == fragment;
  };
  return (style.has_ramp() && in(style.ramp().member())) ||
         (style.has_levels() && in(style.levels_member())) ||
         (style.has_contours() && in(style.contours().member())) ||
         (style.has_grid() && in(style.grid().member())) ||
         (style.has_tracks() && in(style.tracks().member()));
}

} // namespace

std::string LedgerViewports::SceneOf(const std::string& viewport) const {
  const auto found = this->Viewports_.find(viewport);
  return found == this->Viewports_.end() ? std::string() : found->second.create.scene();
}

std::vector<v1::StyleTerrainInViewport>
LedgerViewports::StylesIn(const std::string& scene, const std::string& fragment) const {
  std::vector<v1::StyleTerrainInViewport> styles;
  for (const auto& [name, viewport] : this->Viewports_) {
    for (const auto& [terrain, style] : viewport.styles) {
      if (SceneName(viewport.create) == scene && HasElementIn(style.first.style(), fragment)) {
        styles.push_back(style.first);
      }
    }
  }
  return styles;
}

bool LedgerViewports::Add(const v1::Command& command, const TerrainObject& terrain) {
  using C = v1::Command;
  const CommandTraits* traits = CommandTraits::Find(command.command_case());
  if (!traits || traits->GetOwner() != CommandTraits::Owner::Viewport) {
    return false;
  }
  if (traits->LatestIsKept()) {
    this->Find(traits->OwnerName(command)).latest.Set(command);
    return true;
  }
  switch (command.command_case()) {
  case C::kCreateViewport:
    this->Viewports_[command.create_viewport().name()].create = command;
    return true;
  case C::kRemoveViewport:
    this->Viewports_.erase(command.remove_viewport().viewport());
    return true;
  case C::kResizeViewport: {
    v1::CreateViewport* create =
        this->Find(command.resize_viewport().viewport()).create.mutable_create_viewport();
    create->set_width(command.resize_viewport().width());
    create->set_height(command.resize_viewport().height());
    return true;
  }
  case C::kSetViewport:
    Set(this->Find(command.set_viewport().viewport()), command.set_viewport());
    return true;
  case C::kSetViewportFragment: {
    const v1::SetViewportFragment& set = command.set_viewport_fragment();
    std::set<std::string>& hidden = this->Find(set.viewport()).hidden;
    if (set.visible()) {
      hidden.erase(set.fragment());
    } else {
      hidden.insert(set.fragment());
    }
    return true;
  }
  case C::kStyleTerrainInViewport: {
    const v1::StyleTerrainInViewport& set = command.style_terrain_in_viewport();
    auto& styles = this->Find(set.viewport()).styles;
    if (set.has_style()) {
      styles[set.terrain()] = {set, terrain ? terrain(set.terrain()) : 0};
    } else {
      styles.erase(set.terrain());
    }
    return true;
  }
  case C::kSetTextTable:
    PutNamed(command.set_text_table(), this->Find(command.set_text_table().viewport()).tables);
    return true;
  case C::kRemoveTextTable:
    RemoveNamed(command.remove_text_table().name(),
                this->Find(command.remove_text_table().viewport()).tables);
    return true;
  case C::kSetColorBar:
    PutNamed(command.set_color_bar(), this->Find(command.set_color_bar().viewport()).bars);
    return true;
  case C::kRemoveColorBar:
    RemoveNamed(command.remove_color_bar().name(),
                this->Find(command.remove_color_bar().viewport()).bars);
    return true;
  default:
    return false;
  }
}

// Has the effect of ViewportCommands::Set.
void LedgerViewports::Set(Viewport& viewport, const v1::SetViewport& command) {
  v1::CreateViewport& create = *viewport.create.mutable_create_viewport();
  const std::string present = create.vantage().empty() ? DefaultVantage : create.vantage();
  if (command.has_vantage()) {
    if (!command.has_camera() && command.vantage() != present) {
      create.clear_camera(); // another vantage has other cameras
    }
    create.set_vantage(command.vantage());
  }
  if (command.has_camera()) {
    create.set_camera(command.camera());
  }
  if (command.has_visible()) {
    create.set_hidden(!command.visible());
  }
  if (command.has_samples()) {
    create.set_samples(command.samples());
  }
  v1::SetViewport& set = viewport.set;
  if (command.has_background()) { // one without the other is no gradient
    *set.mutable_background() = command.background();
    set.clear_background_top();
  }
  if (command.has_background_top()) {
    *set.mutable_background_top() = command.background_top();
  }
  v1::SetViewport others = command;
  others.clear_viewport();
  others.clear_vantage();
  others.clear_camera();
  others.clear_visible();
  others.clear_samples();
  others.clear_background();
  others.clear_background_top();
  set.MergeFrom(others);
}

void LedgerViewports::PutOne(const std::string& name, const Viewport& viewport,
                             const SceneView& scene, Emit out) {
  const auto add = [&]() -> v1::Command& {
    out.emplace_back().set_scene(viewport.create.scene());
    return out.back();
  };
  out.push_back(viewport.create);
  if (viewport.set.ByteSizeLong() > 0) {
    v1::SetViewport* set = add().mutable_set_viewport();
    *set = viewport.set;
    set->set_viewport(name);
  }
  viewport.latest.Put(viewport.create.scene(), out);
  for (const std::string& fragment : viewport.hidden) {
    // A viewport continues to hide the name of a removed fragment.
    const bool gone = std::find(scene.fragments.begin(), scene.fragments.end(), fragment) ==
                      scene.fragments.end();
    if (gone) {
      add().mutable_create_fragment()->set_name(fragment);
    }
    v1::SetViewportFragment* hide = add().mutable_set_viewport_fragment();
    hide->set_viewport(name);
    hide->set_fragment(fragment);
    if (gone) {
      add().mutable_remove_fragment()->set_name(fragment);
    }
  }
  for (const auto& [terrain, style] : viewport.styles) {
    const std::uint32_t object = scene.terrain(terrain);
    if (object != 0 && (style.second == 0 || style.second == object)) {
      *add().mutable_style_terrain_in_viewport() = style.first;
    }
  }
  for (const v1::SetTextTable& table : viewport.tables) {
    *add().mutable_set_text_table() = table;
  }
  for (const v1::SetColorBar& bar : viewport.bars) {
    *add().mutable_set_color_bar() = bar;
  }
}

} // namespace dspace::session
