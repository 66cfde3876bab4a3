#include <dspace/ledger/LedgerNames.h>

#include <algorithm>

#include <dspace/messages/SunMessages.h>
#include <dspace/scene/Light.h>
#include <dspace/state/State.h>

namespace dspace::session {
namespace {

template<class Item> const std::string& NameOf(const Item& item) {
  return item.name;
}
const std::string& NameOf(const v1::SetCamera& camera) {
  return camera.name();
}

template<class Items> auto FindName(Items& items, const std::string& name) {
  return std::find_if(items.begin(), items.end(),
                      [&](const auto& item) { return NameOf(item) == name; });
}

std::string VantageName(const std::string& name) {
  return name.empty() ? DefaultVantage : name;
}

v1::Command& NewCommand(const std::string& scene, std::vector<v1::Command>& out) {
  out.emplace_back().set_scene(scene);
  return out.back();
}

} // namespace

LedgerNames::LedgerNames(v1::CreateScene create) : Create_(std::move(create)) {
  this->Fragments_ = {{"physical", v1::PHYSICAL, false, {}},
                      {"ornamental", v1::ORNAMENTAL, false, {}}};
  this->Vantages_.push_back({DefaultVantage, true, {}, {}});
  if (!this->Create_.no_lights()) {
    this->Lights_ = {{SunName, true, {}}};
  }
}

bool LedgerNames::Add(const v1::Command& command, const v1::Reply& reply) {
  using C = v1::Command;
  switch (command.command_case()) {
  case C::kSetTime:
    this->Time_ = command.set_time().time_s();
    if (!command.set_time().put_lags()) { // a snapshot's has a time of a scene without one too
      this->Begin_ = std::min(this->Begin_.value_or(*this->Time_), *this->Time_);
    }
    this->Lags_.clear();
    for (const v1::CameraLag& lag : reply.time().lag()) {
      this->Lags_[{lag.vantage(), lag.camera()}] = lag;
    }
    return true;
  case C::kCreateFragment:
    this->Fragments_.push_back(
        {command.create_fragment().name(), command.create_fragment().nature(), true, {}});
    return true;
  case C::kRemoveFragment:
    this->Fragments_.erase(FindName(this->Fragments_, command.remove_fragment().name()));
    return true;
  case C::kSetFragmentVisible:
    FindName(this->Fragments_, command.set_fragment_visible().name())->visible =
        command.set_fragment_visible().visible();
    return true;
  default:
    return this->AddLight(command) || this->AddVantage(command, reply);
  }
}

bool LedgerNames::AddLight(const v1::Command& command) {
  if (command.has_set_light()) {
    const auto found = FindName(this->Lights_, command.set_light().name());
    if (found == this->Lights_.end()) {
      this->Lights_.push_back({command.set_light().name(), false, command.set_light()});
    } else {
      found->set = command.set_light();
    }
    return true;
  }
  if (command.has_set_sun()) {
    auto found = FindName(this->Lights_, SunName);
    if (found == this->Lights_.end()) {
      found = this->Lights_.insert(found, {SunName, false, {}});
    }
    if (!found->set) {
      found->set = DefaultSun();
    }
    ChangeSun(command.set_sun().sun(), *found->set);
    return true;
  }
  if (command.has_remove_light()) {
    const auto found = FindName(this->Lights_, command.remove_light().name());
    if (found != this->Lights_.end()) { // "sky" may be removed where there is none
      this->Lights_.erase(found);
    }
    return true;
  }
  return false;
}

void LedgerNames::RemoveLightsOn(const std::unordered_set<std::uint64_t>& frames) {
  const auto on = [&](const Light& light) { return light.set && frames.count(light.set->frame()); };
  this->Lights_.erase(std::remove_if(this->Lights_.begin(), this->Lights_.end(), on),
                      this->Lights_.end());
}

LedgerNames::Vantage& LedgerNames::Find(const std::string& name) {
  return *FindName(this->Vantages_, VantageName(name));
}

bool LedgerNames::AddVantage(const v1::Command& command, const v1::Reply& reply) {
  using C = v1::Command;
  switch (command.command_case()) {
  case C::kCreateVantage:
    this->Vantages_.push_back({command.create_vantage().name(), false, {}, {}});
    return true;
  case C::kRemoveVantage: {
    const auto found = FindName(this->Vantages_, command.remove_vantage().name());
    for (const v1::SetCamera& camera : found->cameras) {
      this->Lags_.erase({found->name, camera.name()});
    }
    this->Vantages_.erase(found);
    return true;
  }
  case C::kSetCamera:
    this->SetCamera(this->Find(command.set_camera().vantage()), command.set_camera(), reply);
    return true;
  case C::kRemoveCamera: {
    Vantage& vantage = this->Find(command.remove_camera().vantage());
    vantage.cameras.erase(FindName(vantage.cameras, command.remove_camera().name()));
    if (vantage.active == command.remove_camera().name()) {
      vantage.active.clear();
    }
    this->Lags_.erase({vantage.name, command.remove_camera().name()});
    return true;
  }
  case C::kSetActiveCamera:
    this->Find(command.set_active_camera().vantage()).active = command.set_active_camera().name();
    return true;
  default:
    return false;
  }
}

void LedgerNames::SetCamera(Vantage& vantage, const v1::SetCamera& command,
                            const v1::Reply& reply) {
  const auto found = FindName(vantage.cameras, command.name());
  if (found == vantage.cameras.end()) {
    vantage.cameras.push_back(command);
    if (vantage.cameras.size() == 1) {
      vantage.active = command.name();
    }
  } else {
    if (command.has_projection()) {
      *found->mutable_projection() = command.projection();
    }
    if (command.has_mount()) {
      *found->mutable_mount() = command.mount();
    }
  }
  this->Lags_.erase({vantage.name, command.name()});
  if (reply.camera().has_lag()) {
    this->Lags_[{vantage.name, command.name()}] = reply.camera().lag();
  }
}

std::vector<std::string> LedgerNames::Fragments() const {
  std::vector<std::string> names;
  for (const Fragment& fragment : this->Fragments_) {
    names.push_back(fragment.name);
  }
  return names;
}

void LedgerNames::PutFirst(const std::string& scene, Emit out) const {
  *NewCommand(scene, out).mutable_create_scene() = this->Create_;
  if (this->Begin_ && *this->Begin_ != *this->Time_) { // clocks count from it
    NewCommand(scene, out).mutable_set_time()->set_time_s(*this->Begin_);
  }
  if (this->Time_) {
    NewCommand(scene, out).mutable_set_time()->set_time_s(*this->Time_);
  }
  for (const Fragment& fragment : this->Fragments_) {
    if (fragment.made) {
      v1::CreateFragment* create = NewCommand(scene, out).mutable_create_fragment();
      create->set_name(fragment.name);
      create->set_nature(fragment.nature);
    }
    if (fragment.visible) {
      v1::SetFragmentVisible* set = NewCommand(scene, out).mutable_set_fragment_visible();
      set->set_name(fragment.name);
      set->set_visible(*fragment.visible);
    }
  }
}

void LedgerNames::PutLast(const std::string& scene, Emit out) const {
  if (!this->Create_.no_lights()) {
    const auto found = FindName(this->Lights_, SunName);
    if (found == this->Lights_.end() || !found->first) {
      NewCommand(scene, out).mutable_remove_light()->set_name(SunName);
    }
  }
  for (const Light& light : this->Lights_) {
    if (light.set) {
      *NewCommand(scene, out).mutable_set_light() = *light.set;
    }
  }
  const auto main = FindName(this->Vantages_, DefaultVantage);
  if (main == this->Vantages_.end() || !main->first) {
    NewCommand(scene, out).mutable_remove_vantage()->set_name(DefaultVantage);
  }
  for (const Vantage& vantage : this->Vantages_) {
    if (!vantage.first) {
      NewCommand(scene, out).mutable_create_vantage()->set_name(vantage.name);
    }
    for (const v1::SetCamera& camera : vantage.cameras) {
      *NewCommand(scene, out).mutable_set_camera() = camera;
    }
    if (!vantage.cameras.empty() && vantage.active != vantage.cameras.front().name()) {
      v1::SetActiveCamera* set = NewCommand(scene, out).mutable_set_active_camera();
      set->set_vantage(vantage.name);
      set->set_name(vantage.active);
    }
  }
  // Also where there is none: a step back has taken them all, and cameras that are set begin one.
  const bool lags =
      std::any_of(this->Vantages_.begin(), this->Vantages_.end(), [](const Vantage& vantage) {
        return std::any_of(vantage.cameras.begin(), vantage.cameras.end(),
                           [](const v1::SetCamera& camera) {
                             return camera.mount().chase().smoothing_s() > 0.0 ||
                                    camera.mount().pointing().smoothing_s() > 0.0;
                           });
      });
  if (lags) {
    v1::SetTime* time = NewCommand(scene, out).mutable_set_time();
    time->set_put_lags(true);
    time->set_time_s(this->Time_.value_or(0.0));
    time->mutable_sky()->set_time_s(time->time_s()); // what follows the time is in place
    for (const auto& [camera, lag] : this->Lags_) {
      *time->add_lag() = lag;
    }
  }
}

} // namespace dspace::session
