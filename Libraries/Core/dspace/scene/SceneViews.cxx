// The parts of Scene that bind frames, vantages, cameras and time together.
#include <dspace/scene/Scene.h>

#include <algorithm>
#include <unordered_set>

#include <dspace/scene/Checks.h>

namespace dspace {

namespace {

// `top` and everything below it.
std::vector<FrameId> SubtreeOf(const FrameTree& frames, FrameId top) {
  std::vector<FrameId> ids = {top};
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::vector<FrameId>& children = frames.Children(ids[i]);
    ids.insert(ids.end(), children.begin(), children.end());
  }
  return ids;
}

// Whether a changed camera goes on where its lag has brought it.
bool FollowsTheSame(const CameraMount& a, const CameraMount& b) {
  return a.kind == CameraMount::Kind::Chase && b.kind == a.kind && b.frame == a.frame;
}

} // namespace

void Scene::RefuseWhileCamerasOn(FrameId removed, const std::vector<FrameId>& subtree) const {
  for (const SceneVantage& vantage : this->Vantages_) {
    for (const std::string& name : vantage.CameraNames()) {
      const CameraMount& mount = vantage.GetCamera(name).mount;
      if (std::find(subtree.begin(), subtree.end(), mount.frame) != subtree.end()) {
        Refuse("frame '" + this->Frames_.Path(removed) + "'",
               "camera '" + name + "' of vantage '" + vantage.Name() +
                   (mount.kind == CameraMount::Kind::Chase ? "' follows" : "' stands on") +
                   " frame '" + this->Frames_.Path(mount.frame) +
                   "'; accepted: a subtree without cameras");
      }
    }
  }
}

void Scene::RemoveFrame(FrameId frame) {
  this->RequireFrame("scene '" + this->Name_ + "'", frame);
  if (frame == RootFrame) {
    this->Frames_.Remove(frame); // says why not
    return;
  }
  const std::vector<FrameId> subtree = SubtreeOf(this->Frames_, frame);
  this->RefuseWhileCamerasOn(frame, subtree);

  // Nothing below can be refused. The tree comes last: its listeners see a scene without leftovers.
  const std::unordered_set<FrameId> gone(subtree.begin(), subtree.end());
  std::unordered_set<ObjectId> removed;
  for (auto it = this->Objects_.begin(); it != this->Objects_.end();) {
    if (gone.count(it->second.frame) == 0) {
      ++it;
      continue;
    }
    removed.insert(it->first);
    this->RetiredObjects_.insert(it->first);
    this->ObjectNames_.erase(it->second.name);
    it = this->Objects_.erase(it);
  }
  for (SceneFragment& fragment : this->Fragments_.Fragments_) {
    std::vector<ObjectId>& ids = fragment.objects;
    ids.erase(
        std::remove_if(ids.begin(), ids.end(), [&](ObjectId id) { return removed.count(id) != 0; }),
        ids.end());
  }
  std::vector<Light>& lights = this->Fragments_.Lights_;
  const std::size_t before = lights.size();
  lights.erase(std::remove_if(lights.begin(), lights.end(),
                              [&](const Light& light) { return gone.count(light.frame) != 0; }),
               lights.end());
  if (!removed.empty() || lights.size() != before) {
    this->ContentChanged();
  }
  this->Frames_.Remove(frame);
}

SceneVantage& Scene::FindVantage(const std::string& name) {
  const auto found = std::find_if(this->Vantages_.begin(), this->Vantages_.end(),
                                  [&](const SceneVantage& v) { return v.Name() == name; });
  if (found == this->Vantages_.end()) {
    throw Error(Error::Kind::NotFound, "vantage '" + name + "'",
                "scene '" + this->Name_ + "' has none of this name");
  }
  return *found;
}

const SceneVantage& Scene::Vantage(const std::string& name) const {
  return const_cast<Scene*>(this)->FindVantage(name);
}

std::vector<std::string> Scene::VantageNames() const {
  std::vector<std::string> names;
  for (const SceneVantage& vantage : this->Vantages_) {
    names.push_back(vantage.Name());
  }
  return names;
}

void Scene::CreateVantage(const std::string& name) {
  RequireName("vantage", name);
  for (const SceneVantage& vantage : this->Vantages_) {
    if (vantage.Name() == name) {
      throw Error(Error::Kind::AlreadyExists, "vantage '" + name + "'",
                  "scene '" + this->Name_ + "' has one; accepted: a name that no vantage has");
    }
  }
  this->Vantages_.emplace_back(name);
  ++this->Revision_;
}

void Scene::RemoveVantage(const std::string& name) {
  const SceneVantage& vantage = this->FindVantage(name);
  for (const std::string& camera : vantage.CameraNames()) {
    this->Lags_.erase({name, camera});
  }
  this->Vantages_.erase(this->Vantages_.begin() + (&vantage - this->Vantages_.data()));
  ++this->Revision_;
}

void Scene::SetCamera(const std::string& vantage, const Camera& camera) {
  SceneVantage& views = this->FindVantage(vantage);
  const std::string label = "camera '" + camera.name + "'";
  this->RequireFrame(label, camera.mount.frame);
  if (camera.mount.kind == CameraMount::Kind::Chase && camera.mount.frame == RootFrame) {
    Refuse(label, "it follows the root frame, which does not move; accepted: any other frame");
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
  if (camera.mount.kind == CameraMount::Kind::Chase && camera.mount.smoothing_s > 0.0 &&
      this->Lags_.count(key) == 0) {
    dspace::PlaceCamera(camera, this->Frames_, this->Time_, this->Lags_[key]);
  }
  ++this->Revision_;
}

void Scene::RemoveCamera(const std::string& vantage, const std::string& camera) {
  this->FindVantage(vantage).RemoveCamera(camera);
  this->Lags_.erase({vantage, camera});
  ++this->Revision_;
}

void Scene::SetActiveCamera(const std::string& vantage, const std::string& camera) {
  SceneVantage& views = this->FindVantage(vantage);
  if (views.GetCamera(camera).name != views.ActiveCamera().name) {
    views.SetActiveCamera(camera);
    ++this->Revision_;
  }
}

CameraPose Scene::PlaceCamera(const std::string& vantage, const std::string& camera) const {
  const SceneVantage& views = this->Vantage(vantage);
  const Camera& found = camera.empty() ? views.ActiveCamera() : views.GetCamera(camera);
  const auto lag = this->Lags_.find({vantage, found.name});
  ChaseState state = lag == this->Lags_.end() ? ChaseState() : lag->second;
  return dspace::PlaceCamera(found, this->Frames_, this->Time_, state);
}

void Scene::SetLags(Lags lags) {
  for (const auto& [key, lag] : lags) {
    this->Vantage(key.first).GetCamera(key.second);
  }
  this->Lags_ = std::move(lags);
  ++this->Revision_;
}

void Scene::SetTime(double time_s) {
  RequireFinite("scene '" + this->Name_ + "'", "time", time_s);
  if (time_s == this->Time_) {
    return;
  }
  if (time_s < this->Time_) {
    this->Lags_.clear();
  }
  // The lags are brought to the time that ends, with its poses; from there PlaceCamera goes on.
  for (const SceneVantage& vantage : this->Vantages_) {
    for (const std::string& name : vantage.CameraNames()) {
      const Camera& camera = vantage.GetCamera(name);
      if (time_s > this->Time_ && camera.mount.kind == CameraMount::Kind::Chase &&
          camera.mount.smoothing_s > 0.0 && this->Frames_.Contains(camera.mount.frame)) {
        dspace::PlaceCamera(camera, this->Frames_, this->Time_,
                            this->Lags_[{vantage.Name(), name}]);
      }
    }
  }
  this->Time_ = time_s;
  ++this->Revision_;
}

} // namespace dspace
