#include <dspace/ledger/LedgerObjects.h>

#include <algorithm>

#include <dspace/FrameTree.h>
#include <dspace/messages/CommandTraits.h>

namespace dspace::session {
namespace {

// Of a trail, in a command: each makes its whole line anew.
constexpr std::size_t MostPoints = 1 << 20;

LedgerId OrRoot(LedgerId frame) {
  return frame == NoFrame ? RootFrame : frame;
}

std::string DefaultFragment(const std::string& given, v1::Nature nature) {
  return !given.empty() ? given : nature == v1::ORNAMENTAL ? "ornamental" : "physical";
}

// The name, or none where there is no such fragment (any more).
std::string Existing(const std::string& name, const std::vector<std::string>& fragments) {
  const bool there = std::find(fragments.begin(), fragments.end(), name) != fragments.end();
  return there ? name : std::string();
}

// The later material over the earlier one, field by field as the interpreter does it.
void Overlay(const v1::Material& later, v1::Material* material) {
  if (later.has_color()) { // whole: zeros of its channels are values too
    material->clear_color();
  }
  material->MergeFrom(later);
}

v1::ObjectSettings* SettingsOf(v1::Command& command) {
  switch (command.command_case()) {
  case v1::Command::kImportObject:
    return command.mutable_import_object()->mutable_object();
  case v1::Command::kCreatePrimitive:
    return command.mutable_create_primitive()->mutable_object();
  case v1::Command::kCreateText:
    return command.mutable_create_text()->mutable_object();
  default:
    return command.mutable_create_trail()->mutable_object();
  }
}

} // namespace

LedgerObjects::Thing* LedgerObjects::Find(std::uint32_t id) {
  const auto found = this->Things_.find(id);
  return found == this->Things_.end() ? nullptr : &found->second;
}

void LedgerObjects::Create(const v1::Command& command, v1::ObjectSettings settings) {
  Thing& thing = this->Things_[settings.id()];
  thing.create = command;
  thing.frame = OrRoot(settings.frame());
  thing.nature = settings.nature();
  thing.fragment = DefaultFragment(settings.fragment(), settings.nature());
  if (command.has_create_trail()) {
    const v1::CreateTrail& trail = command.create_trail();
    thing.trail.emplace(trail.capacity(), trail.minimum_spacing(), trail.fade());
  }
}

void LedgerObjects::Load(const v1::LoadRobot& load, const v1::RobotReply& reply) {
  for (const v1::LinkInfo& link : reply.link()) {
    for (const std::uint32_t id : link.object()) {
      Thing& thing = this->Things_[id];
      thing.robot = load.name();
      thing.asked = load.fragment();
      thing.frame = thing.madeOn = link.frame();
      thing.nature = load.nature();
      thing.fragment = DefaultFragment(load.fragment(), load.nature());
    }
  }
}

void LedgerObjects::Open(const v1::Command& command) {
  const v1::OpenTerrain& open = command.open_terrain();
  Ground& ground = this->Grounds_[open.name()];
  ground.open = command;
  if (open.mode() == v1::OpenTerrain::CLIPMAP) {
    if (open.has_drape()) {
      ground.opened.emplace_back("drape");
    }
    if (open.has_fill_holes()) {
      ground.opened.emplace_back("filled");
    }
  }
  for (const std::string& name : ground.opened) {
    ground.layers.emplace_back().set_name(name);
  }
  Thing& thing = this->Things_[open.object_id()];
  thing.terrain = open.name();
  thing.frame = OrRoot(open.frame());
  thing.fragment = DefaultFragment(open.fragment(), v1::PHYSICAL);
}

void LedgerObjects::RemoveObject(std::uint32_t id) {
  if (const Thing* thing = this->Find(id)) {
    this->Grounds_.erase(thing->terrain);
    this->Things_.erase(id);
  }
  for (auto it = this->Orphans_.begin(); it != this->Orphans_.end();) {
    it->ids.erase(id);
    it = it->ids.empty() ? this->Orphans_.erase(it) : std::next(it);
  }
}

void LedgerObjects::RemoveTerrain(const std::string& name) {
  const auto found = this->Grounds_.find(name);
  if (found != this->Grounds_.end()) {
    this->RemoveObject(found->second.open.open_terrain().object_id());
  }
}

void LedgerObjects::RemoveOn(const LedgerFrames::Removed& removed) {
  for (auto it = this->Things_.begin(); it != this->Things_.end();) {
    const std::uint32_t id = it->first;
    const Thing& thing = it->second;
    ++it;
    if (removed.frames.count(thing.frame)) {
      if (!thing.robot.empty()) {
        this->Lost_.emplace(thing.robot, std::make_pair(id, thing.frame));
      }
      this->RemoveObject(id);
    }
  }
  for (const v1::Command& load : removed.robots) {
    this->Lost_.erase(load.load_robot().name());
    Orphans orphans{load, {}};
    for (auto& [id, thing] : this->Things_) {
      if (thing.robot == load.load_robot().name()) {
        thing.robot.clear();
        thing.madeOn = RootFrame;
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
    return this->ChangeTerrain(command, reply);
  }
  Thing* thing = this->Find(traits->OwnerId(command));
  if (thing && traits->LatestIsKept()) {
    thing->latest.Keep(command);
    return true;
  }
  return thing && this->ChangeLook(*thing, command);
}

bool LedgerObjects::ChangeLook(Thing& thing, const v1::Command& command) {
  using C = v1::Command;
  switch (command.command_case()) {
  case C::kSetMaterial: {
    const v1::SetMaterial& set = command.set_material();
    if (set.replace() || set.material().has_color()) {
      thing.tilt.reset(); // its colour is overwritten
    }
    if (set.replace() || !thing.material) {
      thing.material = set;
    } else {
      Overlay(set.material(), thing.material->mutable_material());
    }
    break;
  }
  case C::kSetTilt:
    thing.tilt = command.set_tilt();
    break;
  case C::kAttachObject:
    thing.frame = OrRoot(command.attach_object().frame());
    break;
  case C::kMoveToFragment:
    thing.fragment = command.move_to_fragment().fragment();
    break;
  case C::kAppendTrail:
    for (int i = 0; i + 2 < command.append_trail().point_size(); i += 3) {
      thing.trail->Add(Eigen::Vector3d(command.append_trail().point().data() + i));
    }
    break;
  case C::kClearTrail:
    thing.trail->Clear();
    break;
  default:
    return false;
  }
  return true;
}

void LedgerObjects::PutThing(const std::string& scene, std::uint32_t id, const Thing& thing,
                             Emit out) const {
  const auto add = [&]() -> v1::Command& {
    out.emplace_back().set_scene(scene);
    return out.back();
  };
  if (thing.create) {
    out.push_back(*thing.create);
    SettingsOf(out.back())->set_frame(thing.frame);
    SettingsOf(out.back())->set_fragment(thing.fragment);
  }
  if (thing.madeOn != NoFrame && thing.frame != thing.madeOn) {
    add().mutable_attach_object()->set_object(id);
    out.back().mutable_attach_object()->set_frame(thing.frame);
  }
  if (thing.trail && thing.trail->Size() > 0) {
    v1::AppendTrail* append = nullptr;
    for (std::size_t i = 0; i < thing.trail->Size(); ++i) {
      if (i % MostPoints == 0) {
        append = add().mutable_append_trail();
        append->set_object(id);
      }
      const Eigen::Vector3d& p = thing.trail->Position(i);
      append->mutable_point()->Add(p.data(), p.data() + 3);
    }
    const Eigen::Vector3d& end = thing.trail->End();
    if (end != thing.trail->Position(thing.trail->Size() - 1)) {
      append->mutable_point()->Add(end.data(), end.data() + 3);
    }
  }
  thing.latest.Put(scene, out);
  if (thing.material) {
    *add().mutable_set_material() = *thing.material;
  }
  if (thing.tilt) {
    *add().mutable_set_tilt() = *thing.tilt;
  }
}

// A robot's visual cannot be removed by itself, but goes with a frame that it was attached to.
void LedgerObjects::PutLost(const std::string& scene, const LedgerFrames& frames, Emit out) const {
  const auto add = [&]() -> v1::Command& {
    out.emplace_back().set_scene(scene);
    return out.back();
  };
  std::map<LedgerId, std::vector<std::uint32_t>> byFrame;
  for (const auto& [robot, lost] : this->Lost_) {
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

// Loaded, and removed again with all that does not stay. A robot of that name may come after it.
void LedgerObjects::PutOrphans(const std::string& scene, const std::vector<std::string>& fragments,
                               Emit out) const {
  for (const Orphans& orphans : this->Orphans_) {
    v1::LoadRobot* load = out.emplace_back(orphans.load).mutable_load_robot();
    load->set_frame(RootFrame);
    load->set_fragment(Existing(load->fragment(), fragments));
    const LedgerId base = load->base_id();
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
  this->PutLost(scene, frames, out);
  this->PutTerrains(scene, state, out);
  for (const auto& [id, thing] : this->Things_) {
    this->PutThing(scene, id, thing, out);
    if (thing.madeOn != NoFrame &&
        thing.fragment != DefaultFragment(Existing(thing.asked, fragments), thing.nature)) {
      v1::Command& command = out.emplace_back();
      command.set_scene(scene);
      command.mutable_move_to_fragment()->set_object(id);
      command.mutable_move_to_fragment()->set_fragment(thing.fragment);
    }
  }
}

} // namespace dspace::session
