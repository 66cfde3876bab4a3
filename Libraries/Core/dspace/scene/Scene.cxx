#include <dspace/scene/Scene.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_set>

#include <dspace/Checks.h>

namespace dspace {

namespace {

constexpr ObjectId LargestAllowedObject = 0x7fffffff;

std::string Label(const std::string& name) {
  return "object '" + name + "'";
}

void CheckOffset(const std::string& object, const Eigen::Affine3d& X_FO) {
  RequirePosition(object, "its offset", X_FO.translation());
  for (int i = 0; i < 3; ++i) {
    const double stretch = X_FO.linear().col(i).stableNorm();
    Require(stretch >= MinimumScale && stretch <= MaximumScale, object, "the scale of its offset",
            stretch, "1e-12 to 1e12");
  }
  const double det = X_FO.linear().determinant();
  if (!std::isnormal(det)) {
    Reject(object, "its offset is not finite or flattens it; accepted: an affine map with an "
                   "inverse");
  }
}

// `top` and everything below it.
std::vector<FrameId> SubtreeOf(const FrameTree& frames, FrameId top) {
  std::vector<FrameId> ids = {top};
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::vector<FrameId>& children = frames.Children(ids[i]);
    ids.insert(ids.end(), children.begin(), children.end());
  }
  return ids;
}

template<typename Value> void EraseValue(std::vector<Value>& values, const Value& value) {
  values.erase(std::find(values.begin(), values.end(), value));
}

std::set<std::string> PartNames(const GraphicsObject& object) {
  std::set<std::string> names;
  for (const DetailLevel& level : object.levels) {
    for (const Part& part : level.parts) {
      names.insert(part.name);
    }
  }
  names.erase("");
  return names;
}

} // namespace

void Scene::MeshRegister::Check(const std::shared_ptr<const Mesh>& mesh,
                                const std::string& object) {
  const auto found = this->Good_.find(mesh.get());
  if (found != this->Good_.end() && !found->second.expired()) {
    return; // it lived on all the while, so it is the same mesh
  }
  CheckMesh(*mesh, object);
  if (this->Good_.size() >= this->PruneAt_) {
    for (auto it = this->Good_.begin(); it != this->Good_.end();) {
      it = it->second.expired() ? this->Good_.erase(it) : std::next(it);
    }
    this->PruneAt_ = 2 * this->Good_.size() + 256;
  }
  this->Good_[mesh.get()] = mesh;
}

Scene::Scene(std::string name) : Name_(std::move(name)), Views_(Name_, Frames_) {
  RequireName("scene", this->Name_);
}

void Scene::ContentChanged() {
  ++this->Revision_;
  ++this->ContentRevision_;
}

GraphicsObject& Scene::Find(ObjectId id) {
  const auto found = this->Objects_.find(id);
  if (found == this->Objects_.end()) {
    throw Error(Error::Kind::NotFound, "object " + std::to_string(id),
                "scene '" + this->Name_ + "' has none of this id");
  }
  return found->second;
}

const GraphicsObject& Scene::Object(ObjectId id) const {
  return const_cast<Scene*>(this)->Find(id);
}

ObjectId Scene::FindObject(const std::string& name) const {
  const auto found = this->ObjectNames_.find(name);
  return found == this->ObjectNames_.end() ? 0 : found->second;
}

std::string Scene::FreeObjectName(const std::string& wanted) const {
  return this->NumberedNames_.First(
      wanted, [this](const std::string& name) { return this->ObjectNames_.count(name) != 0; });
}

void Scene::RequireFrame(const std::string& object, FrameId frame) const {
  if (!this->Frames_.Contains(frame)) {
    throw Error(Error::Kind::NotFound, object,
                "frame " + std::to_string(frame) + " is not in scene '" + this->Name_ + "'");
  }
}

// Checks levels and puts the default material where there is none.
void Scene::CheckLevels(const std::string& object, std::vector<DetailLevel>& levels) {
  double finer = std::numeric_limits<double>::infinity();
  for (DetailLevel& level : levels) {
    Require(level.minimumPixels >= 0.0 && level.minimumPixels < finer, object,
            "minimumPixels of a level", level.minimumPixels,
            ("0 and more, less than the finer level's " + NumberText(finer)).c_str());
    finer = level.minimumPixels;
    for (Part& part : level.parts) {
      if (!part.mesh) {
        Reject(object, "a part has no mesh");
      }
      if (!part.X_OP.matrix().allFinite()) {
        Reject(object, "the place of mesh '" + part.mesh->name + "' in it is not finite");
      }
      this->Meshes_.Check(part.mesh, object);
      if (part.material) {
        CheckMaterial(*part.material, object);
      } else {
        part.material = std::make_shared<const Material>();
      }
    }
  }
  for (DetailLevel& level : levels) {
    level.box = BoxOf(level);
    if (!level.box.isEmpty()) {
      RequirePosition(object, "a corner of its bounds", level.box.min());
      RequirePosition(object, "a corner of its bounds", level.box.max());
    }
    level.sphere = BoundsOf(level);
  }
}

std::uint64_t Scene::Revision() const {
  std::uint64_t revision = this->Revision_ + this->Frames_.Revision();
  for (const auto& custom : this->Customs_) {
    revision += custom->Revision();
  }
  return revision;
}

ObjectId Scene::AddObject(GraphicsObject object) {
  RequireName("object", object.name);
  const std::string label = Label(object.name);
  if (this->ObjectNames_.count(object.name) != 0) {
    throw Error(Error::Kind::AlreadyExists, label,
                "scene '" + this->Name_ + "' has one of this name; accepted: another name");
  }
  if (object.id == 0) {
    object.id = this->LargestObject_ + 1;
  }
  if (object.id > LargestAllowedObject) {
    Reject(label, "its id is " + std::to_string(object.id) + "; accepted: up to " +
                      std::to_string(LargestAllowedObject));
  }
  if (this->Objects_.count(object.id) != 0 || this->RetiredObjects_.count(object.id) != 0) {
    throw Error(Error::Kind::AlreadyExists, label,
                "id " + std::to_string(object.id) + " is or was in use; accepted: 0 or a new one");
  }
  this->RequireFrame(label, object.frame);
  object.fragment = this->Fragments_.Member(label, object.nature, object.fragment).fragment;
  CheckOffset(label, object.X_FO);
  Require(object.lineWidth > 0.0 && std::isfinite(object.lineWidth), label, "line width",
          object.lineWidth, "a positive number of pixels");
  Require(object.pointSize > 0.0 && std::isfinite(object.pointSize), label, "point size",
          object.pointSize, "a positive number of pixels");
  object.material.Check(label);
  this->CheckLevels(label, object.levels);
  if (object.custom && (!object.levels.empty() || object.billboard)) {
    Reject(label, "custom geometry has no levels of detail and cannot be a billboard");
  }

  const ObjectId id = object.id;
  if (object.custom) {
    this->Customs_.push_back(object.custom);
  }
  this->Fragments_.Find(object.fragment).objects.push_back(id);
  this->ObjectNames_.emplace(object.name, id);
  this->Objects_.emplace(id, std::move(object));
  this->LargestObject_ = std::max(this->LargestObject_, id);
  this->ContentChanged();
  return id;
}

void Scene::RemoveObject(ObjectId id) {
  const GraphicsObject& object = this->Find(id);
  if (object.custom) {
    // Its revisions are counted no more: what they raised must not be taken back.
    this->Revision_ += object.custom->Revision();
    EraseValue(this->Customs_, object.custom);
  }
  EraseValue(this->Fragments_.Find(object.fragment).objects, id);
  this->ObjectNames_.erase(object.name);
  this->NumberedNames_.Freed(object.name);
  this->Objects_.erase(id);
  this->RetiredObjects_.insert(id);
  this->ContentChanged();
}

void Scene::SetObjectVisible(ObjectId id, bool visible) {
  GraphicsObject& object = this->Find(id);
  if (object.visible != visible) {
    object.visible = visible;
    this->ContentChanged();
  }
}

void Scene::SetObjectMaterial(ObjectId id, const MaterialOverride& material) {
  GraphicsObject& object = this->Find(id);
  material.Check(Label(object.name));
  if (object.material != material) {
    object.material = material;
    this->ContentChanged();
  }
}

void Scene::SetPart(ObjectId id, const std::string& part, const PartOverride& over) {
  GraphicsObject& object = this->Find(id);
  const std::string label = Label(object.name) + ", part '" + part + "'";
  const std::set<std::string> names = PartNames(object);
  if (names.count(part) == 0) {
    std::string known;
    for (const std::string& name : names) {
      known += (known.empty() ? "'" : ", '") + name + "'";
    }
    throw Error(Error::Kind::NotFound, label,
                "no part has this name; accepted: " +
                    (known.empty() ? "the object has no named part" : known));
  }
  over.material.Check(label);
  object.parts[part] = over;
  this->ContentChanged();
}

void Scene::SetObjectShader(ObjectId id, std::shared_ptr<const ShaderCode> shader) {
  this->Find(id).shader = std::move(shader);
  this->ContentChanged();
}

void Scene::SetObjectOffset(ObjectId id, const Eigen::Affine3d& X_FO) {
  GraphicsObject& object = this->Find(id);
  CheckOffset(Label(object.name), X_FO);
  if (object.X_FO.matrix() != X_FO.matrix()) {
    object.X_FO = X_FO;
    this->ContentChanged();
  }
}

void Scene::AttachObject(ObjectId id, FrameId frame) {
  GraphicsObject& object = this->Find(id);
  this->RequireFrame(Label(object.name), frame);
  if (object.frame != frame) {
    object.frame = frame;
    this->ContentChanged();
  }
}

void Scene::MoveToFragment(ObjectId id, const std::string& name) {
  GraphicsObject& object = this->Find(id);
  this->Fragments_.Get(name); // an empty name is that of none
  this->Fragments_.Member(Label(object.name), object.nature, name);
  if (object.fragment != name) {
    this->Fragments_.Find(name).objects.push_back(id);
    EraseValue(this->Fragments_.Find(object.fragment).objects, id);
    object.fragment = name;
    this->ContentChanged();
  }
}

void Scene::SetObjectLevels(ObjectId id, std::vector<DetailLevel> levels) {
  GraphicsObject& object = this->Find(id);
  if (object.custom) {
    Reject(Label(object.name), "geometry that draws itself has no levels");
  }
  this->CheckLevels(Label(object.name), levels);
  object.levels = std::move(levels);
  const std::set<std::string> names = PartNames(object);
  for (auto it = object.parts.begin(); it != object.parts.end();) {
    it = names.count(it->first) ? std::next(it) : object.parts.erase(it);
  }
  this->ContentChanged();
}

void Scene::CreateFragment(const std::string& name, Nature nature) {
  this->Fragments_.Create(name, nature);
  this->ContentChanged();
}

std::vector<std::string> Scene::MembersOf(const std::string& fragment) const {
  std::vector<std::string> members;
  for (const auto& [id, object] : this->Objects_) {
    if (object.custom) {
      for (const CustomGeometry::Member& member : object.custom->Members()) {
        if (member.membership.fragment == fragment) {
          members.push_back(member.name + " of " + Label(object.name));
        }
      }
    }
  }
  return members;
}

void Scene::RemoveFragment(const std::string& name) {
  const std::vector<std::string> members = this->MembersOf(name);
  if (!members.empty() && name != StandardFragment(this->Fragments_.Get(name).nature)) {
    std::string all;
    for (const std::string& member : members) {
      all += (all.empty() ? "" : ", ") + member;
    }
    Reject("fragment '" + name + "'", "it holds " + all + "; accepted: an empty fragment");
  }
  this->Fragments_.Remove(name);
  this->ContentChanged();
}

void Scene::SetFragmentVisible(const std::string& name, bool visible) {
  if (this->Fragments_.Get(name).visible != visible) {
    this->Fragments_.SetVisible(name, visible);
    this->ContentChanged();
  }
}

void Scene::SetLight(const Light& light) {
  this->RequireFrame("light '" + light.name + "'", light.frame);
  this->Fragments_.SetLight(light);
  this->ContentChanged();
}

void Scene::RemoveLight(const std::string& name) {
  this->Fragments_.RemoveLight(name);
  this->ContentChanged();
}

void Scene::RemoveFrame(FrameId frame) {
  this->RequireFrame("scene '" + this->Name_ + "'", frame);
  if (frame == RootFrame) {
    this->Frames_.Remove(frame); // says why not
    return;
  }
  const std::vector<FrameId> subtree = SubtreeOf(this->Frames_, frame);
  this->Views_.RejectWhileCamerasOn(frame, subtree);

  // Nothing below can be rejected. The tree comes last: its listeners see a scene without
  // leftovers.
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
    this->NumberedNames_.Freed(it->second.name);
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

void Scene::CreateVantage(const std::string& name) {
  this->Views_.Create(name);
  ++this->Revision_;
}

void Scene::RemoveVantage(const std::string& name) {
  this->Views_.Remove(name);
  ++this->Revision_;
}

const SceneVantage& Scene::Vantage(const std::string& name) const {
  return this->Views_.Get(name);
}

void Scene::SetCamera(const std::string& vantage, const Camera& camera) {
  this->Views_.Get(vantage);
  this->RequireFrame("camera '" + camera.name + "'", camera.mount.frame);
  if (camera.mount.kind == CameraMount::Kind::Pointing ||
      camera.mount.vertical != CameraMount::Vertical::Parent) {
    this->RequireFrame("camera '" + camera.name + "'", camera.mount.aim);
  }
  this->Views_.SetCamera(vantage, camera);
  ++this->Revision_;
}

void Scene::RemoveCamera(const std::string& vantage, const std::string& camera) {
  this->Views_.RemoveCamera(vantage, camera);
  ++this->Revision_;
}

void Scene::SetActiveCamera(const std::string& vantage, const std::string& camera) {
  if (this->Views_.SetActiveCamera(vantage, camera)) {
    ++this->Revision_;
  }
}

void Scene::SetLags(Lags lags) {
  this->Views_.SetLags(std::move(lags));
  ++this->Revision_;
}

void Scene::SetTime(double time_s) {
  if (this->Views_.SetTime(time_s)) {
    ++this->Revision_;
  }
}

} // namespace dspace
