#include <dspace/scene/SceneViews.h>

#include <algorithm>

#include <dspace/Checks.h>

namespace dspace {
namespace {

// Whether a changed camera goes on where its lag has brought it.
bool FollowsTheSame(const CameraMount& a, const CameraMount& b) {
  return a.kind != CameraMount::Kind::Fixed && b.kind == a.kind && b.frame == a.frame &&
         b.aim == a.aim && b.vertical == a.vertical;
}

bool IsLagged(const CameraMount& mount) {
  return mount.kind != CameraMount::Kind::Fixed && mount.smoothing_s > 0.0;
}

} // namespace

SceneViews::SceneViews(std::string scene, const FrameTree& frames)
    : Scene_(std::move(scene)), Frames_(frames) {}

void SceneViews::RejectWhileCamerasOn(FrameId removed, const std::vector<FrameId>& subtree) const {
  for (const SceneVantage& vantage : this->Vantages_) {
    for (const std::string& name : vantage.CameraNames()) {
      const CameraMount& mount = vantage.GetCamera(name).mount;
      const auto isIn = [&subtree](FrameId frame) {
        return std::find(subtree.begin(), subtree.end(), frame) != subtree.end();
      };
      if (mount.aim != NoFrame && isIn(mount.aim)) {
        Reject("frame '" + this->Frames_.Path(removed) + "'",
               "camera '" + name + "' of vantage '" + vantage.Name() +
                   (mount.kind == CameraMount::Kind::Pointing ? "' points at"
                                                              : "' has its vertical from") +
                   " frame '" + this->Frames_.Path(mount.aim) +
                   "'; accepted: a subtree without cameras");
      }
      if (isIn(mount.frame)) {
        Reject("frame '" + this->Frames_.Path(removed) + "'",
               "camera '" + name + "' of vantage '" + vantage.Name() +
                   (mount.kind == CameraMount::Kind::Chase ? "' follows" : "' stands on") +
                   " frame '" + this->Frames_.Path(mount.frame) +
                   "'; accepted: a subtree without cameras");
      }
    }
  }
}

SceneVantage& SceneViews::Find(const std::string& name) {
  const auto found = std::find_if(this->Vantages_.begin(), this->Vantages_.end(),
                                  [&](const SceneVantage& v) { return v.Name() == name; });
  if (found == this->Vantages_.end()) {
    throw Error(Error::Kind::NotFound, "vantage '" + name + "'",
                "scene '" + this->Scene_ + "' has none of this name");
  }
  return *found;
}

const SceneVantage& SceneViews::Get(const std::string& name) const {
  return const_cast<SceneViews*>(this)->Find(name);
}

std::vector<std::string> SceneViews::Names() const {
  std::vector<std::string> names;
  for (const SceneVantage& vantage : this->Vantages_) {
    names.push_back(vantage.Name());
  }
  return names;
}

void SceneViews::Create(const std::string& name) {
  RequireName("vantage", name);
  for (const SceneVantage& vantage : this->Vantages_) {
    if (vantage.Name() == name) {
      throw Error(Error::Kind::AlreadyExists, "vantage '" + name + "'",
                  "scene '" + this->Scene_ + "' has one; accepted: a name that no vantage has");
    }
  }
  this->Vantages_.emplace_back(name);
}

void SceneViews::Remove(const std::string& name) {
  const SceneVantage& vantage = this->Find(name);
  for (const std::string& camera : vantage.CameraNames()) {
    this->Lags_.erase({name, camera});
  }
  this->Vantages_.erase(this->Vantages_.begin() + (&vantage - this->Vantages_.data()));
}

void SceneViews::SetCamera(const std::string& vantage, const Camera& camera) {
  SceneVantage& views = this->Find(vantage);
  const std::string label = "camera '" + camera.name + "'";
  if (camera.mount.kind == CameraMount::Kind::Chase && camera.mount.frame == RootFrame) {
    Reject(label, "it follows the root frame, which does not move; accepted: any other frame");
  }
  const std::vector<std::string> names = views.CameraNames();
  const bool isNew = std::find(names.begin(), names.end(), camera.name) == names.end();
  const CameraMount old = isNew ? CameraMount() : views.GetCamera(camera.name).mount;
  views.SetCamera(camera);
  const std::pair<std::string, std::string> key(vantage, camera.name);
  if (isNew || !FollowsTheSame(old, camera.mount) || camera.mount.smoothing_s == 0.0) {
    this->Lags_.erase(key);
  }
  // In place from now on: what moves before the next time step is lagged behind like all else.
  if (IsLagged(camera.mount) && this->Lags_.count(key) == 0) {
    dspace::PlaceCamera(camera, this->Frames_, this->Time_, this->Lags_[key]);
  }
}

void SceneViews::RemoveCamera(const std::string& vantage, const std::string& camera) {
  this->Find(vantage).RemoveCamera(camera);
  this->Lags_.erase({vantage, camera});
}

bool SceneViews::SetActiveCamera(const std::string& vantage, const std::string& camera) {
  SceneVantage& views = this->Find(vantage);
  const bool changes = views.GetCamera(camera).name != views.ActiveCamera().name;
  if (changes) {
    views.SetActiveCamera(camera);
  }
  return changes;
}

CameraPose SceneViews::Place(const std::string& vantage, const std::string& camera) const {
  const SceneVantage& views = this->Get(vantage);
  const Camera& found = camera.empty() ? views.ActiveCamera() : views.GetCamera(camera);
  const auto lag = this->Lags_.find({vantage, found.name});
  ChaseState state = lag == this->Lags_.end() ? ChaseState() : lag->second;
  return dspace::PlaceCamera(found, this->Frames_, this->Time_, state);
}

void SceneViews::SetLags(Lags lags) {
  for (const auto& [key, lag] : lags) {
    this->Get(key.first).GetCamera(key.second);
  }
  this->Lags_ = std::move(lags);
}

bool SceneViews::SetTime(double time_s) {
  RequireFinite("scene '" + this->Scene_ + "'", "time", time_s);
  if (time_s == this->Time_) {
    return false;
  }
  if (time_s < this->Time_) {
    this->Lags_.clear();
  }
  // The lags are brought to the time that ends, with its poses; from there PlaceCamera goes on.
  for (const SceneVantage& vantage : this->Vantages_) {
    for (const std::string& name : vantage.CameraNames()) {
      const Camera& camera = vantage.GetCamera(name);
      if (time_s > this->Time_ && IsLagged(camera.mount) &&
          this->Frames_.Contains(camera.mount.frame) &&
          (camera.mount.aim == NoFrame || this->Frames_.Contains(camera.mount.aim))) {
        dspace::PlaceCamera(camera, this->Frames_, this->Time_,
                            this->Lags_[{vantage.Name(), name}]);
      }
    }
  }
  this->Time_ = time_s;
  return true;
}

} // namespace dspace
