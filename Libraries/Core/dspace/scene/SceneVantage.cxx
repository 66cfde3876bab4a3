#include <dspace/scene/SceneVantage.h>

#include <algorithm>

#include <dspace/Checks.h>

namespace dspace {

namespace {

template<class Cameras> auto FindCamera(Cameras& cameras, const std::string& name) {
  return std::find_if(cameras.begin(), cameras.end(),
                      [&](const Camera& camera) { return camera.name == name; });
}

[[noreturn]] void NoSuchCamera(const SceneVantage& vantage, const std::string& camera) {
  std::string names;
  for (const std::string& name : vantage.CameraNames()) {
    names += (names.empty() ? "'" : ", '") + name + "'";
  }
  throw Error(Error::Kind::NotFound, "camera '" + camera + "'",
              "vantage '" + vantage.Name() + "' has none of this name; accepted: " +
                  (names.empty() ? "a camera that was added" : names));
}

} // namespace

void SceneVantage::SetCamera(const Camera& camera) {
  RequireName("camera", camera.name);
  camera.projection.Check(camera.name);
  camera.mount.Check(camera.name);
  const auto found = FindCamera(this->Cameras_, camera.name);
  if (found != this->Cameras_.end()) {
    *found = camera;
    return;
  }
  this->Cameras_.push_back(camera);
  if (this->Cameras_.size() == 1) {
    this->Active_ = camera.name;
  }
}

void SceneVantage::RemoveCamera(const std::string& name) {
  const auto found = FindCamera(this->Cameras_, name);
  if (found == this->Cameras_.end()) {
    NoSuchCamera(*this, name);
  }
  if (name == this->Active_ && this->Cameras_.size() > 1) {
    Reject("camera '" + name + "'", "it is the active one of vantage '" + this->Name_ +
                                        "'; accepted: another, or the last one");
  }
  if (name == this->Active_) {
    this->Active_.clear();
  }
  this->Cameras_.erase(found);
}

void SceneVantage::SetActiveCamera(const std::string& name) {
  this->Active_ = this->GetCamera(name).name;
}

const Camera& SceneVantage::GetCamera(const std::string& name) const {
  const auto found = FindCamera(this->Cameras_, name);
  if (found == this->Cameras_.end()) {
    NoSuchCamera(*this, name);
  }
  return *found;
}

const Camera& SceneVantage::ActiveCamera() const {
  if (this->Cameras_.empty()) {
    throw Error(Error::Kind::NotFound, "vantage '" + this->Name_ + "'",
                "it has no camera; add one first (Scene.add_camera, set_camera)");
  }
  return this->GetCamera(this->Active_);
}

std::vector<std::string> SceneVantage::CameraNames() const {
  std::vector<std::string> names;
  for (const Camera& camera : this->Cameras_) {
    names.push_back(camera.name);
  }
  return names;
}

} // namespace dspace
