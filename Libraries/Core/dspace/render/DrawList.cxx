#include <dspace/render/DrawList.h>

#include <cmath>
#include <cstring>

namespace dspace {
namespace {

// OpenGL's view axes (Y up, looking along -Z) from a sensor camera's (Y down, along Z).
const Eigen::Vector3d ViewFromCamera(1.0, -1.0, -1.0);

std::array<float, 3> LinearColor(const std::array<double, 3>& srgb) {
  return {LinearFromSrgb(srgb[0]), LinearFromSrgb(srgb[1]), LinearFromSrgb(srgb[2])};
}

// What of a part's look is the same in every view.
DrawInstance LookOf(const GraphicsObject& object, const Material& material) {
  const MaterialOverride& over = object.material;
  DrawInstance look{};
  const auto color = LinearColor(over.color.value_or(material.color));
  look.color = {color[0], color[1], color[2],
                static_cast<float>(over.opacity.value_or(material.opacity))};
  look.metallic = static_cast<float>(over.metallic.value_or(material.metallic));
  look.roughness = static_cast<float>(over.roughness.value_or(material.roughness));
  look.label = object.id;
  look.emissive = LinearColor(material.emissive);
  return look;
}

// Planes of the view volume in view axes, normals inwards, from the rows of the clip matrix.
std::vector<Eigen::Vector4d> FrustumPlanes(const Eigen::Matrix4d& clipFromView) {
  std::vector<Eigen::Vector4d> planes;
  const auto row = [&](int i) { return Eigen::Vector4d(clipFromView.row(i)); };
  for (const Eigen::Vector4d& plane :
       {Eigen::Vector4d(row(3) + row(0)), Eigen::Vector4d(row(3) - row(0)),
        Eigen::Vector4d(row(3) + row(1)), Eigen::Vector4d(row(3) - row(1)),
        Eigen::Vector4d(row(3) - row(2)), Eigen::Vector4d(row(2))}) {
    const double length = plane.head<3>().norm();
    if (length > 1e-300) { // an infinite far distance has no far plane
      planes.push_back(plane / length);
    }
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

double LargestScale(const Eigen::Affine3d& affine) {
  // Upper bound of the largest singular value, tight for rotations with uniform scale.
  return affine.linear().colwise().norm().maxCoeff() > 0
             ? std::min(affine.linear().norm(),
                        std::sqrt(3.0) * affine.linear().colwise().norm().maxCoeff())
             : 0.0;
}

} // namespace

float LinearFromSrgb(double value) {
  return static_cast<float>(value <= 0.04045 ? value / 12.92
                                             : std::pow((value + 0.055) / 1.055, 2.4));
}

std::uint32_t DrawList::BatchOf(const GraphicsObject& object, const Part& part,
                                const DrawInstance& look, bool near) {
  const Material& material = *part.material;
  DrawBatch batch;
  batch.mesh = part.mesh;
  batch.texture = object.material.texture.value_or(material.texture);
  if (part.mesh->tcoords.empty()) {
    batch.texture = nullptr;
  }
  batch.repeatTexture = material.repeatTexture;
  batch.lit = object.material.lit.value_or(material.lit) &&
              part.mesh->primitive == Mesh::Primitive::Triangles && !object.billboard &&
              !part.mesh->normals.empty();
  batch.specular = look.metallic > 0.0f || look.roughness < 1.0f;
  batch.emissive = look.emissive != std::array<float, 3>{0.0f, 0.0f, 0.0f};
  batch.wireframe = object.material.wireframe.value_or(false);
  batch.billboard = object.billboard;
  batch.lineWidth = static_cast<float>(object.lineWidth);
  batch.pointSize = static_cast<float>(object.pointSize);
  const bool alphaTexture = batch.texture && batch.texture->channels % 2 == 0;
  bool alphaColors = false;
  for (std::size_t i = 3; i < part.mesh->colors.size() && !alphaColors; i += 4) {
    alphaColors = part.mesh->colors[i] != 255;
  }
  batch.translucent = look.color[3] < 1.0f || alphaTexture || alphaColors;

  batch.solid =
      part.mesh->solid && !batch.translucent && !batch.wireframe && !batch.billboard && !near;
  batch.mirrored = batch.solid && look.mirrored < 0.0f;

  std::string key;
  const auto append = [&key](const auto& value) {
    // Of a pointer the address itself is meant: what is shared is the same.
    const std::size_t size = sizeof value; // NOLINT(bugprone-sizeof-expression)
    key.append(reinterpret_cast<const char*>(&value), size);
  };
  append(batch.mesh.get());
  append(batch.texture.get());
  append(batch.repeatTexture);
  append(batch.lit);
  append(batch.emissive);
  append(batch.specular);
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
  this->Objects_.reserve(scene.Objects().size());
  for (const auto& entry : scene.Objects()) {
    const GraphicsObject& object = entry.second;
    FlatObject flat{&object, {}};
    for (const DetailLevel& level : object.levels) {
      FlatLevel flatLevel;
      flatLevel.minimumPixels = level.minimumPixels;
      flatLevel.bounds = level.sphere;
      flatLevel.bounds.center = object.X_FO * flatLevel.bounds.center;
      flatLevel.bounds.radius *= LargestScale(object.X_FO);
      for (const Part& part : level.parts) {
        FlatPart flatPart;
        flatPart.instance = LookOf(object, *part.material);
        flatPart.X_FP = object.X_FO * part.X_OP;
        flatPart.instance.mirrored = flatPart.X_FP.linear().determinant() < 0 ? -1.0f : 1.0f;
        flatPart.batch = this->BatchOf(object, part, flatPart.instance, false);
        flatPart.nearBatch = part.mesh->solid ? this->BatchOf(object, part, flatPart.instance, true)
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

void DrawList::PlaceLights(const Scene& scene, const Eigen::Quaterniond& q_VA, const Pose& X_CA) {
  this->Lights_.clear();
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
    placed.color = color;
    placed.cosCone = static_cast<float>(std::cos(light.cone_deg * M_PI / 180.0));
    placed.attenuation = {1.0f, 0.0f, 0.0f};
    placed.direction = {0.0f, 0.0f, -1.0f};
    if (light.kind != Light::Kind::Head) {
      const Pose& X_AL = this->X_AF_[scene.Frames().Slot(light.frame)];
      const Eigen::Vector3d d = (q_VA * (X_AL.rotation * light.direction)).normalized();
      const Eigen::Vector3d p = ViewFromCamera.cwiseProduct(X_CA.Apply(X_AL.Apply(light.position)));
      for (int i = 0; i < 3; ++i) {
        placed.direction[i] = static_cast<float>(d[i]);
        placed.position[i] = static_cast<float>(p[i]);
        placed.attenuation[i] = static_cast<float>(light.attenuation[i]);
      }
    }
    this->Lights_.push_back(placed);
  }
  this->Ambient_ = {ambient[0], ambient[1], ambient[2]};
}

void DrawList::Build(const Scene& scene, const DrawView& view, const DrawFilter& filter) {
  if (this->Scene_ != &scene || this->ContentRevision_ != scene.ContentRevision()) {
    this->Flatten(scene);
  }
  const FrameTree& frames = scene.Frames();
  // Every pose relative to the frame that carries the camera, each through its nearest common
  // ancestor with it; then one more step into the camera. No large number is ever subtracted that
  // the frames themselves do not force.
  frames.RelativePoses(view.camera.frame, this->X_AF_);
  const Pose X_CA = view.camera.X_FC.Inverse();
  const Eigen::Quaterniond q_VC(0.0, 1.0, 0.0, 0.0); // half a turn about X
  this->PlaceLights(scene, q_VC * X_CA.rotation, X_CA);

  std::unordered_map<std::string, bool> shown;
  for (const std::string& name : scene.Fragments().Names()) {
    const SceneFragment& fragment = scene.Fragments().Get(name);
    shown[name] = fragment.visible && filter.hiddenFragments.count(name) == 0 &&
                  !(filter.physicalOnly && fragment.nature == Nature::Ornamental);
  }
  const auto planes = FrustumPlanes(view.projection.ClipFromView(view.width, view.height));

  for (auto& pending : this->Pending_) {
    pending.clear();
  }
  this->Triangles_ = 0;
  this->Culled_ = 0;
  this->Customs_.clear();
  for (const FlatObject& flat : this->Objects_) {
    const GraphicsObject& object = *flat.object;
    if (!object.visible || (flat.levels.empty() && !object.custom) || !shown[object.fragment] ||
        (filter.pickableOnly && !object.pickable)) {
      continue;
    }
    const Pose X_CF = X_CA * this->X_AF_[frames.Slot(object.frame)];
    Eigen::Affine3d X_VF(X_CF.Matrix());
    X_VF.matrix().topRows<3>() = ViewFromCamera.asDiagonal() * X_VF.matrix().topRows<3>();

    if (object.custom) {
      const Eigen::Affine3d X_VO = X_VF * object.X_FO;
      const BoundingSphere sphere = object.custom->Bounds();
      if (Outside(planes, X_VO * sphere.center, sphere.radius * LargestScale(X_VO))) {
        ++this->Culled_;
      } else {
        this->Customs_.push_back({&object, X_VO});
      }
      continue;
    }

    const FlatLevel* level = &flat.levels.front();
    const Eigen::Vector3d center = X_VF * level->bounds.center;
    const double radius = level->bounds.radius * X_CF.scale;
    if (!object.billboard) {
      if (Outside(planes, center, radius)) {
        ++this->Culled_;
        continue;
      }
      if (flat.levels.size() > 1) {
        const double depth = std::max(-center[2], view.projection.nearDistance);
        const double pixels = 2.0 * radius / view.projection.MetresPerPixel(depth, view.height);
        level = nullptr;
        for (const FlatLevel& candidate : flat.levels) {
          if (pixels >= candidate.minimumPixels) {
            level = &candidate;
            break;
          }
        }
        if (!level) {
          continue; // smaller than the coarsest level wants
        }
      }
    }
    // The near plane may cut it open, or the camera be inside it: then its back faces are seen.
    const double nearest = -(X_VF * level->bounds.center)[2] - level->bounds.radius * X_CF.scale;
    const bool opened = nearest <= view.projection.nearDistance;
    for (const FlatPart& part : level->parts) {
      const Eigen::Matrix<double, 3, 4> m = (X_VF * part.X_FP).matrix().topRows<3>();
      DrawInstance instance = part.instance;
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) {
          instance.viewFromMesh[4 * r + c] = static_cast<float>(m(r, c));
        }
      }
      this->Pending_[opened ? part.nearBatch : part.batch].push_back(instance);
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

} // namespace dspace
