#include <dspace/scene/SceneFragmentManager.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>

namespace dspace {

namespace {

bool AlwaysExists(const std::string& fragment) {
  return fragment == StandardFragment(Nature::Physical) ||
         fragment == StandardFragment(Nature::Ornamental);
}

template<class Named> auto FindNamed(std::vector<Named>& all, const std::string& name) {
  return std::find_if(all.begin(), all.end(), [&](const Named& n) { return n.name == name; });
}

void CheckLight(const Light& light) {
  RequireName("light", light.name);
  const std::string object = "light '" + light.name + "'";
  RequirePosition(object, "direction", light.direction);
  RequirePosition(object, "position", light.position);
  const bool directed = light.kind == Light::Kind::Directional || light.kind == Light::Kind::Spot;
  if (directed && light.direction.norm() < 1e-12) {
    Reject(object, "its direction is " + VectorText(light.direction) +
                       "; accepted: any of length 1e-12 and more");
  }
  Require(light.cone_deg > 0.0 && light.cone_deg < 90.0, object, "cone", light.cone_deg,
          "between 0 and 90 degrees");
  Require(light.radius_deg >= 0.0 && light.radius_deg <= 90.0, object, "the radius of its disc",
          light.radius_deg, "0 to 90 degrees");
  for (const double c : light.color) {
    RequireFraction(object, "colour", c);
  }
  Require(light.intensity >= 0.0 && light.intensity <= 1e12, object, "intensity", light.intensity,
          "0 to 1e12");
  double sum = 0.0;
  for (const double a : light.attenuation) {
    Require(a >= 0.0 && a <= 1e12, object, "attenuation", a, "0 to 1e12");
    sum += a;
  }
  Require(sum >= 1e-12, object, "sum of its attenuation", sum, "1e-12 and more");
}

} // namespace

SceneFragmentManager::SceneFragmentManager() {
  for (const Nature nature : {Nature::Physical, Nature::Ornamental}) {
    this->Create(StandardFragment(nature), nature);
  }
}

void SceneFragmentManager::Create(const std::string& name, Nature nature) {
  RequireName("fragment", name);
  if (this->Contains(name)) {
    throw Error(Error::Kind::AlreadyExists, "fragment '" + name + "'",
                "it exists; accepted: a name that no fragment has");
  }
  SceneFragment fragment;
  fragment.name = name;
  fragment.nature = nature;
  this->Fragments_.push_back(std::move(fragment));
}

void SceneFragmentManager::Remove(const std::string& name) {
  const SceneFragment& fragment = this->Find(name);
  if (AlwaysExists(name)) {
    Reject("fragment '" + name + "'", "it always exists and cannot be removed");
  }
  if (!fragment.objects.empty()) {
    Reject("fragment '" + name + "'", "it holds " + std::to_string(fragment.objects.size()) +
                                          " objects; accepted: an empty fragment");
  }
  this->Fragments_.erase(FindNamed(this->Fragments_, name));
}

void SceneFragmentManager::SetVisible(const std::string& name, bool visible) {
  this->Find(name).visible = visible;
}

SceneFragment& SceneFragmentManager::Find(const std::string& name) {
  const auto found = FindNamed(this->Fragments_, name);
  if (found == this->Fragments_.end()) {
    throw Error(Error::Kind::NotFound, "fragment '" + name + "'", "there is none of this name");
  }
  return *found;
}

const SceneFragment& SceneFragmentManager::Get(const std::string& name) const {
  return const_cast<SceneFragmentManager*>(this)->Find(name);
}

Membership SceneFragmentManager::Member(const std::string& object, Nature nature,
                                        const std::string& fragment) const {
  const SceneFragment& found = this->Get(fragment.empty() ? StandardFragment(nature) : fragment);
  if (found.nature != nature) {
    // The fragments that always exist are named as the natures.
    Reject(object, std::string("it is ") + StandardFragment(nature) + " and fragment '" +
                       found.name + "' " + StandardFragment(found.nature) +
                       "; accepted: a fragment of its nature");
  }
  return {nature, found.name};
}

bool SceneFragmentManager::Contains(const std::string& name) const {
  return std::any_of(this->Fragments_.begin(), this->Fragments_.end(),
                     [&](const SceneFragment& f) { return f.name == name; });
}

std::vector<std::string> SceneFragmentManager::Names() const {
  std::vector<std::string> names;
  for (const SceneFragment& fragment : this->Fragments_) {
    names.push_back(fragment.name);
  }
  return names;
}

void SceneFragmentManager::SetLight(const Light& light) {
  CheckLight(light);
  const auto found = FindNamed(this->Lights_, light.name);
  if (found == this->Lights_.end()) {
    this->Lights_.push_back(light);
  } else {
    *found = light;
  }
}

void SceneFragmentManager::RemoveLight(const std::string& name) {
  const auto found = FindNamed(this->Lights_, name);
  if (found == this->Lights_.end()) {
    throw Error(Error::Kind::NotFound, "light '" + name + "'", "there is none of this name");
  }
  this->Lights_.erase(found);
}

} // namespace dspace
