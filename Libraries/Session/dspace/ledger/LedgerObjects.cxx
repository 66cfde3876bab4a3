#include <dspace/ledger/LedgerObjects.h>

#include <algorithm>

#include <dspace/FrameTree.h>
#include <dspace/messages/CommandTraits.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

// Points of a trail per command: each command rebuilds the whole line.
constexpr std::size_t MostPoints = 1 << 20;

LedgerId OrRoot(LedgerId frame) {
  return frame == NoFrame ? RootFrame : frame;
}

std::string DefaultFragment(const std::string& given, v1::Nature nature) {
  return !given.empty() ? given : nature == v1::ORNAMENTAL ? "ornamental" : "physical";
}

// The name, or an empty one if the fragment does not exist.
std::string Existing(const std::string& name, const std::vector<std::string>& fragments) {
  const bool there = std::find(fragments.begin(), fragments.end(), name) != fragments.end();
  return there ? name : std::string();
}

v1::ObjectSettings* SettingsOf(v1::Command& command) {
  switch (command.command_case()) {
  case v1::Command::kImportObject:
    return command.mutable_import_object()->mutable_object();
  case v1::Command::kCreatePrimitive:
    return command.mutable_create_primitive()->mutable_object();
  case v1::Command::kCreateDrawn:
    return command.mutable_create_drawn()->mutable_object();
  case v1::Command::kCreateText:
    return command.mutable_create_text()->mutable_object();
  case v1::Command::kCreateMesh:
    return command.mutable_create_mesh()->mutable_object();
  case v1::Command::kCreateBody:
    return command.mutable_create_body()->mutable_object();
  case v1::Command::kCreateStars:
    return command.mutable_create_stars()->mutable_object();
  case v1::Command::kCreateTrajectory:
    return command.mutable_create_trajectory()->mutable_object();
  default:
    return command.mutable_create_trail()->mutable_object();
  }
}

} // namespace

LedgerObjects::ObjectEntry* LedgerObjects::Find(std::uint32_t id) {
  const auto found = this->Objects_.find(id);
  return found == this->Objects_.end() ? nullptr : &found->second;
}

void LedgerObjects::Create(const v1::Command& command, v1::ObjectSettings settings) {
  ObjectEntry& entry = this->Objects_[settings.id()];
  entry.create = command;
  entry.frame = OrRoot(settings.frame());
  entry.nature = settings.nature();
  entry.fragment = DefaultFragment(settings.fragment(), settings.nature());
  if (command.has_create_trail()) {
    const v1::CreateTrail& trail = command.create_trail();
    entry.trail.emplace(trail.capacity(), trail.minimum_spacing(), trail.fade());
  }
}

void LedgerObjects::Load(const std::string& key, const v1::Command& load,
                         const v1::RobotReply& about) {
  const auto add = [&](const auto& settings) {
    for (const v1::LinkInfo& link : about.link()) {
      for (const std::uint32_t id : link.object()) {
        ObjectEntry& entry = this->Objects_[id];
        entry.robot = key;
        entry.askedFragment = settings.fragment();
        entry.frame = entry.createdOn = link.frame();
        entry.nature = settings.nature();
        entry.fragment = DefaultFragment(settings.fragment(), settings.nature());
      }
    }
  };
  if (load.has_load_robot()) {
    add(load.load_robot());
  } else {
    add(load.import_nodes().import().object());
  }
}

void LedgerObjects::Open(const v1::Command& command) {
  const v1::OpenTerrain& open = command.open_terrain();
  this->Terrains_.Open(command);
  ObjectEntry& entry = this->Objects_[open.object_id()];
  entry.terrain = open.name();
  entry.frame = OrRoot(open.frame());
  entry.fragment = DefaultFragment(open.fragment(), v1::PHYSICAL);
}

void LedgerObjects::RemoveObject(std::uint32_t id) {
  if (const ObjectEntry* entry = this->Find(id)) {
    this->Terrains_.Remove(entry->terrain);
    this->Objects_.erase(id);
  }
  for (auto it = this->Orphans_.begin(); it != this->Orphans_.end();) {
    it->ids.erase(id);
    it = it->ids.empty() ? this->Orphans_.erase(it) : std::next(it);
  }
}

void LedgerObjects::RemoveTerrain(const std::string& name) {
  if (const auto object = this->Terrains_.ObjectOf(name)) {
    this->RemoveObject(*object);
  }
}

void LedgerObjects::RemoveOn(const LedgerFrames::Removed& removed) {
  for (auto it = this->Objects_.begin(); it != this->Objects_.end();) {
    const std::uint32_t id = it->first;
    const ObjectEntry& entry = it->second;
    ++it;
    if (removed.frames.count(entry.frame)) {
      if (!entry.robot.empty()) {
        this->LostVisuals_.emplace(entry.robot, std::make_pair(id, entry.frame));
      }
      this->RemoveObject(id);
    }
  }
  for (const auto& [key, load] : removed.robots) {
    this->LostVisuals_.erase(key);
    OrphanedVisuals orphans{load, {}};
    for (auto& [id, entry] : this->Objects_) {
      if (entry.robot == key) {
        entry.robot.clear();
        entry.createdOn = RootFrame;
        orphans.ids.insert(id);
      }
    }
    if (!orphans.ids.empty()) {
      this->Orphans_.push_back(std::move(orphans));
    }
  }
}

bool LedgerObjects::Change(const v1::Command& command, const v1::Reply& reply) {
  const CommandTraits* traits = CommandTraits::Find(command.command_case());
  if (!traits || traits->GetOwner() != CommandTraits::Owner::Object) {
    return this->Terrains_.Change(command, reply);
  }
  ObjectEntry* entry = this->Find(traits->OwnerId(command));
  if (entry && traits->LatestIsKept()) {
    entry->latest.Set(command);
    return true;
  }
  return entry && this->ChangeLook(*entry, command);
}

bool LedgerObjects::ChangeLook(ObjectEntry& entry, const v1::Command& command) {
  using C = v1::Command;
  switch (command.command_case()) {
  case C::kSetMaterial: {
    const v1::SetMaterial& set = command.set_material();
    if (set.replace() || set.material().has_color()) {
      entry.tilt.reset(); // its colour is overwritten
    }
    if (set.replace() || !entry.material) {
      entry.material = set;
    } else {
      MergeMaterial(set.material(), entry.material->mutable_material());
    }
    break;
  }
  case C::kSetMesh: {
    // In place of the former arrays, which may be large.
    v1::CreateMesh& create = *entry.create->mutable_create_mesh();
    *create.mutable_level() = command.set_mesh().level();
    std::set<std::string> names;
    for (const v1::MeshLevel& level : create.level()) {
      for (const v1::MeshData& mesh : level.mesh()) {
        names.insert(mesh.part());
      }
    }
    for (auto it = entry.parts.begin(); it != entry.parts.end();) {
      it = names.count(it->first) ? std::next(it) : entry.parts.erase(it);
    }
    break;
  }
  case C::kSetPart: {
    const v1::SetPart& set = command.set_part();
    const auto [it, isNew] = entry.parts.emplace(set.part(), set);
    if (!isNew) {
      v1::SetPart& kept = it->second;
      if (set.replace()) {
        kept.clear_material();
      }
      MergeMaterial(set.material(), kept.mutable_material());
      if (set.has_visible()) {
        kept.set_visible(set.visible());
      }
    }
    break;
  }
  case C::kSetTilt:
    entry.tilt = command.set_tilt();
    break;
  case C::kAttachObject:
    entry.frame = OrRoot(command.attach_object().frame());
    break;
  case C::kMoveToFragment:
    entry.fragment = command.move_to_fragment().fragment();
    break;
  case C::kAppendTrail:
    for (int i = 0; i + 2 < command.append_trail().point_size(); i += 3) {
      entry.trail->Add(Eigen::Vector3d(command.append_trail().point().data() + i));
    }
    break;
  case C::kClearTrail:
    entry.trail->Clear();
    break;
  default:
    return false;
  }
  return true;
}

void LedgerObjects::PutObject(const std::string& scene, std::uint32_t id, const ObjectEntry& entry,
                              Emit out) const {
  const auto add = [&]() -> v1::Command& {
    out.emplace_back().set_scene(scene);
    return out.back();
  };
  if (entry.create) {
    out.push_back(*entry.create);
    SettingsOf(out.back())->set_frame(entry.frame);
    SettingsOf(out.back())->set_fragment(entry.fragment);
    if (out.back().has_create_body() &&
        this->Objects_.count(out.back().create_body().ground()) == 0) {
      out.back().mutable_create_body()->clear_ground(); // the terrain has been removed
    }
  }
  if (entry.createdOn != NoFrame && entry.frame != entry.createdOn) {
    add().mutable_attach_object()->set_object(id);
    out.back().mutable_attach_object()->set_frame(entry.frame);
  }
  if (entry.trail && entry.trail->Size() > 0) {
    v1::AppendTrail* append = nullptr;
    for (std::size_t i = 0; i < entry.trail->Size(); ++i) {
      if (i % MostPoints == 0) {
        append = add().mutable_append_trail();
        append->set_object(id);
      }
      const Eigen::Vector3d& p = entry.trail->Position(i);
      append->mutable_point()->Add(p.data(), p.data() + 3);
    }
    const Eigen::Vector3d& end = entry.trail->End();
    if (end != entry.trail->Position(entry.trail->Size() - 1)) {
      append->mutable_point()->Add(end.data(), end.data() + 3);
    }
  }
  entry.latest.Put(scene, out);
  if (entry.material) {
    *add().mutable_set_material() = *entry.material;
  }
  if (entry.tilt) {
    *add().mutable_set_tilt() = *entry.tilt;
  }
  for (const auto& [name, part] : entry.parts) {
    *add().mutable_set_part() = part;
  }
}

// A visual of a robot cannot be removed alone: it was removed with a frame that it was attached to.
void LedgerObjects::PutLostVisuals(const std::string& scene, const LedgerFrames& frames,
                                   Emit out) const {
  const auto add = [&]() -> v1::Command& {
    out.emplace_back().set_scene(scene);
    return out.back();
  };
  std::map<LedgerId, std::vector<std::uint32_t>> byFrame;
  for (const auto& [robot, lost] : this->LostVisuals_) {
    byFrame[lost.second].push_back(lost.first);
  }
  for (const auto& [frame, ids] : byFrame) {
    v1::CreateFrame* create = add().mutable_create_frame();
    create->set_id(frame); // as it was: it has been removed here too
    create->set_name(frames.FreeName());
    for (const std::uint32_t id : ids) {
      add().mutable_attach_object()->set_object(id);
      out.back().mutable_attach_object()->set_frame(frame);
    }
    add().mutable_remove_frame()->set_frame(frame);
  }
}

// Loads the robot and removes it except for the visuals that stay. Another robot may use its name
// afterwards.
void LedgerObjects::PutOrphanedVisuals(const std::string& scene,
                                       const std::vector<std::string>& fragments, Emit out) const {
  for (const OrphanedVisuals& orphans : this->Orphans_) {
    v1::Command& load = out.emplace_back(orphans.load);
    PlaceLoad(load, RootFrame, fragments);
    const LedgerId base =
        load.has_load_robot() ? load.load_robot().base_id() : load.import_nodes().frame(0);
    for (const std::uint32_t id : orphans.ids) {
      v1::Command& attach = out.emplace_back();
      attach.set_scene(scene);
      attach.mutable_attach_object()->set_object(id);
      attach.mutable_attach_object()->set_frame(RootFrame);
    }
    v1::Command& remove = out.emplace_back();
    remove.set_scene(scene);
    remove.mutable_remove_frame()->set_frame(base);
  }
}

void LedgerObjects::Put(const std::string& scene, const LedgerFrames& frames,
                        const std::vector<std::string>& fragments, const State* state,
                        Emit out) const {
  this->PutLostVisuals(scene, frames, out);
  this->Terrains_.Put(
      scene, state,
      [this](std::uint32_t id) {
        const ObjectEntry& entry = this->Objects_.at(id);
        return LedgerTerrains::Placement{entry.frame, entry.fragment};
      },
      out);
  for (const auto& [id, entry] : this->Objects_) {
    this->PutObject(scene, id, entry, out);
    if (entry.createdOn != NoFrame &&
        entry.fragment != DefaultFragment(Existing(entry.askedFragment, fragments), entry.nature)) {
      v1::Command& command = out.emplace_back();
      command.set_scene(scene);
      command.mutable_move_to_fragment()->set_object(id);
      command.mutable_move_to_fragment()->set_fragment(entry.fragment);
    }
  }
}

} // namespace dspace::session
