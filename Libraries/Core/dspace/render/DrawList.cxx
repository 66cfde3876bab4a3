#include <dspace/render/DrawList.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>

#include <dspace/scene/PartLook.h>
#include <dspace/scene/Stretch.h>
#include <dspace/scene/bodies/CelestialBody.h>

namespace dspace {
namespace {

// OpenGL's view axes (Y up, looking along -Z) from a sensor camera's (Y down, along Z).
const Eigen::Vector3d ViewFromCamera(1.0, -1.0, -1.0);

// Whether code of the object may move its vertices out of its bounds, and turn its faces over.
bool MovesVertices(const GraphicsObject& object) {
  if (!object.shader) {
    return false;
  }
  const auto& code = object.shader->replacements;
  return std::any_of(code.begin(), code.end(), [](const ShaderReplacement& replacement) {
    return replacement.stage == ShaderReplacement::Stage::Vertex;
  });
}

// What of a part's look is the same in every view.
DrawInstance InstanceOf(const GraphicsObject& object, const Material& look) {
  DrawInstance made{};
  const auto color = LinearColor(look.color);
  made.color = {color[0], color[1], color[2], static_cast<float>(look.opacity)};
  made.metallic = static_cast<float>(look.metallic);
  made.roughness = static_cast<float>(look.roughness);
  made.label = object.id;
  made.emissive = LinearColor(look.emissive);
  return made;
}

// Planes at the sides of the view volume in view axes, normals inwards, from the rows of the clip
// matrix.
std::vector<Eigen::Vector4d> SidePlanes(const Eigen::Matrix4d& clipFromView) {
  std::vector<Eigen::Vector4d> planes;
  const auto row = [&](int i) { return Eigen::Vector4d(clipFromView.row(i)); };
  for (const Eigen::Vector4d& plane :
       {Eigen::Vector4d(row(3) + row(0)), Eigen::Vector4d(row(3) - row(0)),
        Eigen::Vector4d(row(3) + row(1)), Eigen::Vector4d(row(3) - row(1))}) {
    planes.push_back(plane / plane.head<3>().norm());
  }
  return planes;
}

bool Outside(const std::vector<Eigen::Vector4d>& planes, const Eigen::Vector3d& center,
             double radius) {
  for (const Eigen::Vector4d& plane : planes) {
    if (plane.head<3>().dot(center) + plane[3] < -radius) {
      return true;
    }
  }
  return false;
}

bool Casts(const DrawBatch& batch) {
  return !batch.translucent && !batch.billboard && !batch.wireframe &&
         batch.mesh->primitive == Mesh::Primitive::Triangles;
}

std::optional<DistanceRange> RangeInFrame(std::optional<DistanceRange> range,
                                          const Eigen::Affine3d& X_FO) {
  if (range) {
    const double scale = std::cbrt(std::abs(X_FO.linear().determinant()));
    range->center = X_FO * range->center;
    range->from *= scale;
    range->to *= scale;
  }
  return range;
}

bool IsInRange(const DistanceRange& range, const Eigen::Affine3d& X_VF) {
  const double scale = std::cbrt(std::abs(X_VF.linear().determinant()));
  const double distance = (X_VF * range.center).norm();
  return distance >= scale * range.from && distance < scale * range.to;
}

} // namespace

std::uint32_t DrawList::BatchOf(const GraphicsObject& object, const Part& part,
                                const Material& material, const DrawInstance& look, bool near) {
  DrawBatch batch;
  batch.mesh = part.mesh;
  batch.texture = material.texture;
  batch.shader = object.shader;
  batch.repeatTexture = material.repeatTexture;
  batch.lit = material.lit;
  if (batch.lit) {
    batch.normalTexture = material.normalTexture;
    batch.normalScale = material.normalScale;
  }
  batch.specular = look.metallic > 0.0f || look.roughness < 1.0f;
  if (batch.lit && material.reflectance.model != Reflectance::Model::MetallicRoughness) {
    batch.specular = false;
    batch.reflectance = material.reflectance;
  }
  batch.emissive = look.emissive != std::array<float, 3>{0.0f, 0.0f, 0.0f};
  batch.wireframe = OverrideOf(object, part).wireframe.value_or(false);
  batch.billboard = object.billboard;
  batch.lineWidth = static_cast<float>(object.lineWidth);
  batch.pointSize = static_cast<float>(object.pointSize);
  batch.translucent = IsTranslucent(material, *part.mesh);

  batch.solid = part.mesh->solid && !batch.translucent && !batch.wireframe && !batch.billboard &&
                !near && !MovesVertices(object);
  batch.mirrored = batch.solid && look.mirrored < 0.0f;

  std::string key;
  const auto append = [&key](const auto& value) {
    // Of a pointer the address itself is meant: what is shared is the same.
    const std::size_t size = sizeof value; // NOLINT(bugprone-sizeof-expression)
    key.append(reinterpret_cast<const char*>(&value), size);
  };
  append(batch.mesh.get());
  append(batch.texture.get());
  append(batch.normalTexture.get());
  append(batch.normalScale);
  append(batch.shader.get());
  append(batch.repeatTexture);
  append(batch.lit);
  append(batch.emissive);
  append(batch.specular);
  append(batch.reflectance.model);
  append(batch.reflectance.lunarWeight.value_or(-1.0));
  append(batch.reflectance.singleScatteringAlbedo);
  append(batch.reflectance.phaseAsymmetry);
  append(batch.reflectance.phasePartition);
  append(batch.reflectance.oppositionAmplitude);
  append(batch.reflectance.oppositionWidth);
  append(batch.reflectance.roughness_deg);
  append(batch.wireframe);
  append(batch.billboard);
  append(batch.translucent);
  append(batch.solid);
  append(batch.mirrored);
  append(batch.lineWidth);
  append(batch.pointSize);
  const auto found = this->BatchIndex_.emplace(std::move(key), this->Templates_.size());
  if (found.second) {
    this->Templates_.push_back(std::move(batch));
  }
  return found.first->second;
}

void DrawList::Flatten(const Scene& scene) {
  this->Objects_.clear();
  this->Templates_.clear();
  this->BatchIndex_.clear();
  this->Bodies_.clear();
  this->Objects_.reserve(scene.Objects().size());
  for (const auto& entry : scene.Objects()) {
    const GraphicsObject& object = entry.second;
    FlatObject flat{&object, {}};
    flat.body = dynamic_cast<const CelestialBody*>(object.custom.get());
    if (flat.body && flat.body->Shape().ground != 0) {
      this->Bodies_.emplace(flat.body->Shape().ground, &object);
    }
    std::uint32_t number = 0;
    for (const DetailLevel& level : object.levels) {
      FlatLevel flatLevel;
      flatLevel.bounds = level.sphere;
      flatLevel.bounds.center = object.X_FO * flatLevel.bounds.center;
      flatLevel.bounds.radius *= LargestStretch(object.X_FO);
      for (const Part& part : level.parts) {
        ++number;
        if (!IsPartVisible(object, part)) {
          continue;
        }
        FlatPart flatPart;
        flatPart.number = number;
        const Material look = LookOf(object, part);
        flatPart.instance = InstanceOf(object, look);
        flatPart.X_FP = object.X_FO * part.X_OP;
        flatPart.range = RangeInFrame(part.range, object.X_FO);
        flatPart.instance.mirrored = flatPart.X_FP.linear().determinant() < 0 ? -1.0f : 1.0f;
        flatPart.batch = this->BatchOf(object, part, look, flatPart.instance, false);
        flatPart.nearBatch = part.mesh->solid
                                 ? this->BatchOf(object, part, look, flatPart.instance, true)
                                 : flatPart.batch;
        flatLevel.parts.push_back(flatPart);
      }
      flat.levels.push_back(std::move(flatLevel));
    }
    this->Objects_.push_back(std::move(flat));
  }
  this->Pending_.assign(this->Templates_.size(), {});
  this->Scene_ = &scene;
  this->ContentRevision_ = scene.ContentRevision();
}

void DrawList::PlaceBodies(const Scene& scene, const Pose& X_CA) {
  this->SunBody_.reset();
  this->Eclipsing_.clear();
  for (const FlatObject& flat : this->Objects_) {
    if (!flat.body || !flat.object->visible) {
      continue;
    }
    const BodyShape& shape = flat.body->Shape();
    Eigen::Affine3d X_VO;
    X_VO.matrix() = (X_CA * this->X_AF_[scene.Frames().Slot(flat.object->frame)]).Matrix();
    X_VO.matrix().topRows<3>() = ViewFromCamera.asDiagonal() * X_VO.matrix().topRows<3>();
    X_VO = X_VO * flat.object->X_FO;
    DrawBody placed;
    placed.object = flat.object;
    placed.body = flat.body;
    placed.center = X_VO.translation();
    placed.unit = (X_VO.linear() * shape.radii.asDiagonal()).inverse();
    placed.radius = shape.radii.maxCoeff() * LargestStretch(X_VO);
    if (shape.sun) {
      this->SunBody_ = placed;
    } else if (shape.eclipses) {
      this->Eclipsing_.push_back(placed);
    }
  }
  if (!this->SunBody_) {
    this->Eclipsing_.clear();
  }
  std::stable_sort(this->Eclipsing_.begin(), this->Eclipsing_.end(),
                   [](const DrawBody& a, const DrawBody& b) {
                     return a.radius * b.center.norm() > b.radius * a.center.norm();
                   });
}

void DrawList::PlaceLights(const Scene& scene, const Eigen::Quaterniond& q_VA, const Pose& X_CA,
                           double fill) {
  this->Lights_.clear();
  this->Sun_.reset();
  Eigen::Vector3f ambient = Eigen::Vector3f::Zero();
  for (const Light& light : scene.Fragments().Lights()) {
    if (!light.enabled) {
      continue;
    }
    auto color = LinearColor(light.color);
    for (float& c : color) {
      c *= static_cast<float>(light.intensity);
    }
    if (light.kind == Light::Kind::Ambient) {
      ambient += Eigen::Vector3f(color[0], color[1], color[2]);
      continue;
    }
    DrawLight placed{};
    placed.kind = light.kind;
    placed.sun = IsSun(light);
    if (placed.sun) {
      ambient += float(fill) * Eigen::Vector3f(color[0], color[1], color[2]);
    }
    placed.radius = static_cast<float>(light.radius_deg * M_PI / 180.0);
    placed.color = color;
    placed.cosCone = static_cast<float>(std::cos(light.cone_deg * M_PI / 180.0));
    placed.attenuation = {1.0f, 0.0f, 0.0f};
    placed.direction = {0.0f, 0.0f, -1.0f};
    if (light.kind != Light::Kind::Head) {
      const Pose& X_AL = this->X_AF_[scene.Frames().Slot(light.frame)];
      Eigen::Vector3d along = light.direction; // in the light's axes
      if (placed.sun && this->SunBody_) {
        const Eigen::Vector3d& sun = this->SunBody_->center;
        along = (q_VA * X_AL.rotation).conjugate() * -sun.normalized();
        placed.radius =
            static_cast<float>(std::asin(std::min(1.0, this->SunBody_->radius / sun.norm())));
      }
      const Eigen::Vector3d d = (q_VA * (X_AL.rotation * along)).normalized();
      if (placed.sun) {
        // In the light's own axes, where the direction stands still while the camera moves.
        const Pose X_LC = X_AL.Inverse() * X_CA.Inverse();
        SunPlace sun;
        sun.axes = LightAxes(-along.normalized());
        sun.camera = (sun.axes * X_LC.position).head<2>() / X_LC.scale;
        sun.axes = sun.axes * (q_VA * X_AL.rotation).conjugate().toRotationMatrix();
        sun.radius = double(placed.radius);
        this->Sun_ = sun;
      }
      const Eigen::Vector3d p = ViewFromCamera.cwiseProduct(X_CA.Apply(X_AL.Apply(light.position)));
      for (int i = 0; i < 3; ++i) {
        placed.direction[i] = static_cast<float>(d[i]);
        placed.position[i] = static_cast<float>(p[i]);
        placed.attenuation[i] = static_cast<float>(light.attenuation[i]);
      }
    }
    this->Lights_.insert(placed.sun ? this->Lights_.begin() : this->Lights_.end(), placed);
  }
  this->Ambient_ = {ambient[0], ambient[1], ambient[2]};
}

void DrawList::ExposeLights(float exposure) {
  for (DrawLight& light : this->Lights_) {
    for (float& channel : light.color) {
      channel *= exposure;
    }
  }
  for (float& channel : this->Ambient_) {
    channel *= exposure;
  }
}

std::optional<Eigen::Vector3f> DrawList::TowardsSun() const {
  if (this->Lights_.empty() || !this->Lights_.front().sun) {
    return std::nullopt;
  }
  return -Eigen::Map<const Eigen::Vector3f>(this->Lights_.front().direction.data());
}

void DrawList::FindSeen(const Scene& scene, const DrawView& view, const DrawFilter& filter) {
  const FrameTree& frames = scene.Frames();
  const Pose X_CA = view.camera.X_FC.Inverse();
  std::unordered_map<std::string, bool> shown;
  for (const std::string& name : scene.Fragments().Names()) {
    const SceneFragment& fragment = scene.Fragments().Get(name);
    shown[name] = fragment.visible && filter.Shows({fragment.nature, name});
    if (!shown[name]) {
      this->Filter_.hiddenFragments.insert(name);
    }
  }
  const auto sides = SidePlanes(view.ClipFromView());
  this->Seen_.clear();
  for (const FlatObject& flat : this->Objects_) {
    const GraphicsObject& object = *flat.object;
    if (!object.visible || (flat.levels.empty() && !object.custom) || !shown[object.fragment] ||
        (filter.pickableOnly && !object.pickable) || (filter.castersOnly && flat.body)) {
      continue;
    }
    const Pose X_CF = X_CA * this->X_AF_[frames.Slot(object.frame)];
    SeenObject seen;
    seen.flat = &flat;
    seen.X_VF.matrix() = X_CF.Matrix();
    seen.X_VF.matrix().topRows<3>() = ViewFromCamera.asDiagonal() * seen.X_VF.matrix().topRows<3>();
    if (object.custom && object.custom->IsBackdrop()) {
      this->Backdrops_.push_back({&object, seen.X_VF * object.X_FO});
      continue;
    }
    if (object.custom) {
      const Eigen::Affine3d X_VO = seen.X_VF * object.X_FO;
      const BoundingSphere sphere = object.custom->Bounds();
      seen.center = X_VO * sphere.center;
      seen.radius = sphere.radius * LargestStretch(X_VO);
    } else if (object.billboard) { // its size is pixels
      seen.center = seen.X_VF * object.X_FO.translation();
      seen.radius = 0.0;
    } else {
      const FlatLevel& finest = flat.levels.front();
      seen.center = seen.X_VF * finest.bounds.center;
      seen.radius = finest.bounds.radius * X_CF.scale;
    }
    if (!object.billboard && !MovesVertices(object) && Outside(sides, seen.center, seen.radius)) {
      ++this->Culled_;
      continue;
    }
    this->Seen_.push_back(std::move(seen));
  }
}

void DrawList::FindGrounds(const DrawView& view) {
  this->Covered_.clear();
  this->TooSmall_.clear();
  if (this->Bodies_.empty()) {
    return;
  }
  std::map<ObjectId, const GraphicsObject*> grounds; // that are seen
  for (const SeenObject& seen : this->Seen_) {
    const GraphicsObject& object = *seen.flat->object;
    if (this->Bodies_.count(object.id) != 0) {
      grounds.emplace(object.id, &object);
    }
  }
  for (const SeenObject& seen : this->Seen_) {
    const GraphicsObject& object = *seen.flat->object;
    const ObjectId id = seen.flat->body ? seen.flat->body->Shape().ground : 0;
    const auto ground = grounds.find(id);
    if (ground == grounds.end() || ground->second->frame != object.frame ||
        !ground->second->X_FO.isApprox(object.X_FO)) {
      continue;
    }
    const Eigen::Affine3d X_VO = seen.X_VF * object.X_FO;
    const double radius = seen.flat->body->Shape().radii.maxCoeff() * LargestStretch(X_VO);
    const double depth = std::max(-X_VO.translation().z(), radius);
    const double pixel = view.projection.MetresPerPixel(depth, view.height);
    const bool small = radius < CelestialBody::SmallRadius * pixel * view.samples;
    if (small) {
      this->TooSmall_.insert(id);
    } else {
      this->Covered_.insert(object.id);
    }
  }
}

double DrawList::HighestToSun() const {
  double highest = -std::numeric_limits<double>::infinity();
  for (const SeenObject& seen : this->Seen_) {
    highest = std::max(highest, this->Sun_->axes.row(2).dot(seen.center) + seen.radius);
  }
  return highest;
}

void DrawList::FindDepths() {
  this->NearestDepth_ = std::numeric_limits<double>::infinity();
  this->FarthestDepth_ = -this->NearestDepth_;
  for (const SeenObject& seen : this->Seen_) {
    const double high = -seen.center.z() + seen.radius;
    if (high > 0.0 && !seen.flat->object->custom) {
      this->NearestDepth_ = std::min(this->NearestDepth_, std::max(0.0, high - 2.0 * seen.radius));
    }
    this->FarthestDepth_ = std::max(this->FarthestDepth_, high);
  }
}

void DrawList::SetDepths(DrawView& view) const {
  Projection& projection = view.projection;
  const bool orthographic = projection.kind == Projection::Kind::Orthographic;
  if (projection.nearDistance && (projection.farDistance || !orthographic)) {
    projection = projection.Seeing(1.0, 0.0);
    return;
  }
  const double infinity = std::numeric_limits<double>::infinity();
  double nearest = infinity;
  double farthest = -infinity;
  for (const SeenObject& seen : this->Seen_) {
    const double low = -seen.center.z() - seen.radius;
    const double high = -seen.center.z() + seen.radius;
    // What surrounds the camera of a perspective kind is cut at the usual distance.
    if (orthographic ? high >= projection.nearDistance.value_or(0.0) : low > 0.0) {
      nearest = std::min(nearest, low);
      farthest = std::max(farthest, high);
    }
  }
  projection = projection.Seeing(nearest, farthest);
}

void DrawList::FindNamed(const FrameTree& frames) {
  this->Named_.clear();
  for (const SeenObject& seen : this->Seen_) {
    const GraphicsObject& object = *seen.flat->object;
    if (object.billboard && object.frame != RootFrame) {
      this->Named_[object.frame];
    }
  }
  if (this->Named_.empty()) {
    return;
  }
  for (const SeenObject& seen : this->Seen_) {
    const GraphicsObject& object = *seen.flat->object;
    if (object.billboard || (object.custom && !seen.flat->body)) {
      continue;
    }
    for (FrameId at = object.frame; at != RootFrame; at = frames.Parent(at)) {
      const auto named = this->Named_.find(at);
      if (named != this->Named_.end()) {
        named->second.push_back(&seen);
      }
    }
  }
}

double DrawList::OwnReach(const SeenObject& label) const {
  double reach = 0.0;
  const auto named = this->Named_.find(label.flat->object->frame);
  if (named != this->Named_.end()) {
    for (const SeenObject* seen : named->second) {
      const double distance = (seen->center - label.center).norm();
      reach = distance > 3.0 * seen->radius ? reach : std::max(reach, distance + seen->radius);
    }
  }
  return reach;
}

void DrawList::Build(const Scene& scene, DrawView& view, const DrawFilter& filter) {
  if (this->Scene_ != &scene || this->ContentRevision_ != scene.ContentRevision()) {
    this->Flatten(scene);
  }
  this->Filter_ = filter;
  const FrameTree& frames = scene.Frames();
  // Every pose relative to the frame that carries the camera, each through its nearest common
  // ancestor with it; then one more step into the camera. No large number is ever subtracted that
  // the frames themselves do not force.
  frames.RelativePoses(view.camera.frame, this->X_AF_);
  const Pose X_CA = view.camera.X_FC.Inverse();
  const Eigen::Quaterniond q_VC(0.0, 1.0, 0.0, 0.0); // half a turn about X
  this->PlaceBodies(scene, X_CA);
  this->PlaceLights(scene, q_VC * X_CA.rotation, X_CA, view.look.fill);

  const float exposure = ExposedByLights(view.look) ? float(view.look.exposure) : 1.0f;
  if (exposure != 1.0f) {
    this->ExposeLights(exposure);
  }

  for (auto& pending : this->Pending_) {
    pending.clear();
  }
  this->Triangles_ = 0;
  this->Culled_ = 0;
  this->Customs_.clear();
  this->Backdrops_.clear();
  this->FindSeen(scene, view, filter);
  this->FindGrounds(view);
  this->FindNamed(frames);
  this->FindDepths();
  this->SetDepths(view);
  const double near = view.projection.Near();
  const double far = view.projection.Far();
  for (const SeenObject& seen : this->Seen_) {
    const FlatObject& flat = *seen.flat;
    const GraphicsObject& object = *flat.object;
    const double nearest = -seen.center.z() - seen.radius;
    if (!view.clip && !object.billboard && !MovesVertices(object) &&
        (nearest > far || -seen.center.z() + seen.radius < near)) {
      ++this->Culled_;
      continue;
    }
    if (object.custom) {
      if (this->TooSmall_.count(object.id) != 0) {
        ++this->Culled_;
        continue;
      }
      const auto body = this->Bodies_.find(object.id);
      this->Customs_.push_back({&object, seen.X_VF * object.X_FO,
                                body == this->Bodies_.end() ? nullptr : body->second,
                                this->Covered_.count(object.id) != 0});
      continue;
    }
    std::size_t level = 0;
    const bool bySize = flat.levels.size() > 1 || object.levels.front().minimumPixels > 0.0;
    if (bySize && !object.billboard) {
      const double depth = std::max(-seen.center.z(), 1e-9);
      const double pixels =
          2.0 * seen.radius / view.projection.MetresPerPixel(depth, view.height) / view.samples;
      const int found = LevelFor(object.levels, pixels);
      if (found < 0) {
        continue; // smaller than the coarsest level wants
      }
      level = std::size_t(found);
    }
    // The near plane may cut it open, or the camera be inside it: then its back faces are seen.
    const bool opened = nearest <= near;
    for (const FlatPart& part : flat.levels[level].parts) {
      if (filter.castersOnly && !Casts(this->Templates_[part.batch])) {
        continue;
      }
      if (part.range && !IsInRange(*part.range, seen.X_VF)) {
        continue;
      }
      Eigen::Matrix<double, 3, 4> m = (seen.X_VF * part.X_FP).matrix().topRows<3>();
      if (object.billboard && -m(2, 3) > near) { // before what it names, at the same pixels
        const double depth = -m(2, 3);
        const double ahead = std::max(depth - this->OwnReach(seen), 1.02 * near);
        if (ahead >= depth) {
          // It stays.
        } else if (view.projection.kind == Projection::Kind::Orthographic) {
          m(2, 3) = -ahead;
        } else {
          m.col(3) *= ahead / depth;
        }
      }
      DrawInstance instance = part.instance;
      if (filter.partsOf != 0) {
        instance.label = object.id == filter.partsOf ? part.number : 0;
      }
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
          instance.viewFromMesh[4 * r + c] = static_cast<float>(m(r, c));
        }
      }
      const std::uint32_t batch = opened ? part.nearBatch : part.batch;
      if (exposure != 1.0f && this->Templates_[batch].lit) {
        for (float& channel : instance.emissive) {
          channel *= exposure;
        }
      }
      this->Pending_[batch].push_back(instance);
    }
  }

  this->Instances_.clear();
  this->Batches_.clear();
  for (const bool translucent : {false, true}) {
    for (std::size_t i = 0; i < this->Templates_.size(); ++i) {
      const auto& pending = this->Pending_[i];
      if (pending.empty() || this->Templates_[i].translucent != translucent) {
        continue;
      }
      DrawBatch batch = this->Templates_[i];
      batch.first = static_cast<std::uint32_t>(this->Instances_.size());
      batch.count = static_cast<std::uint32_t>(pending.size());
      if (batch.mesh->primitive == Mesh::Primitive::Triangles) {
        this->Triangles_ += batch.mesh->PrimitiveCount() * batch.count;
      }
      this->Instances_.insert(this->Instances_.end(), pending.begin(), pending.end());
      this->Batches_.push_back(std::move(batch));
    }
  }
}

void DrawList::Keep(const std::function<bool(const DrawBatch&, const DrawInstance&)>& kept) {
  std::vector<DrawInstance> instances;
  std::vector<DrawBatch> batches;
  this->Triangles_ = 0;
  for (DrawBatch& batch : this->Batches_) {
    const auto first = static_cast<std::uint32_t>(instances.size());
    for (std::uint32_t i = batch.first; i < batch.first + batch.count; ++i) {
      if (kept(batch, this->Instances_[i])) {
        instances.push_back(this->Instances_[i]);
      }
    }
    batch.first = first;
    batch.count = static_cast<std::uint32_t>(instances.size()) - first;
    if (batch.count == 0) {
      continue;
    }
    if (batch.mesh->primitive == Mesh::Primitive::Triangles) {
      this->Triangles_ += batch.mesh->PrimitiveCount() * batch.count;
    }
    batches.push_back(std::move(batch));
  }
  this->Instances_ = std::move(instances);
  this->Batches_ = std::move(batches);
}

} // namespace dspace
