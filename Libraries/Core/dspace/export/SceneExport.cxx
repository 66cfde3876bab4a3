#include <dspace/export/SceneExport.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <unordered_map>
#include <unordered_set>

#include <dspace/AtomicFile.h>
#include <dspace/Checks.h>
#include <dspace/export/ExportLights.h>
#include <dspace/export/GltfBuilder.h>
#include <dspace/scene/PartLook.h>

namespace dspace {
namespace {

// A reader with floats (24 bits) displaces what is farther than this many times its radius.
constexpr double FarRatio = 1e7;

std::vector<double> Numbers(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

std::vector<double> Numbers(const Eigen::Quaterniond& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}

void Place(const Pose& pose, tinygltf::Node& node) {
  if (pose.position != Eigen::Vector3d::Zero()) {
    node.translation = Numbers(pose.position);
  }
  if (pose.rotation.coeffs() != Eigen::Quaterniond::Identity().coeffs()) {
    node.rotation = Numbers(pose.rotation);
  }
  if (pose.scale != 1.0) {
    node.scale = {pose.scale, pose.scale, pose.scale};
  }
}

// Sets the node's translation, rotation and scale; false where the map has shear.
bool Place(const Eigen::Affine3d& X, tinygltf::Node& node) {
  Eigen::Vector3d scale = X.linear().colwise().norm();
  Eigen::Matrix3d axes = X.linear() * scale.cwiseInverse().asDiagonal();
  if (axes.determinant() < 0.0) {
    scale.x() = -scale.x();
    axes.col(0) = -axes.col(0);
  }
  if (!(axes.transpose() * axes).isIdentity(1e-9)) {
    return false;
  }
  node.translation = Numbers(Eigen::Vector3d(X.translation()));
  node.rotation = Numbers(Eigen::Quaterniond(axes).normalized());
  node.scale = Numbers(scale);
  return true;
}

// The mesh in the coordinates that the map leads to.
std::shared_ptr<const Mesh> Moved(const Mesh& mesh, const Eigen::Affine3d& X) {
  auto moved = std::make_shared<Mesh>(mesh);
  const Eigen::Matrix3d linear = X.linear();
  Eigen::Matrix3d cofactors;
  cofactors << linear.col(1).cross(linear.col(2)), linear.col(2).cross(linear.col(0)),
      linear.col(0).cross(linear.col(1));
  const bool mirrors = linear.determinant() < 0.0;
  for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
    const Eigen::Vector3f p(&mesh.positions[i]);
    Eigen::Map<Eigen::Vector3f>(&moved->positions[i]) = (X * p.cast<double>()).cast<float>();
  }
  for (std::size_t i = 0; i < mesh.normals.size(); i += 3) {
    const Eigen::Vector3f n(&mesh.normals[i]);
    Eigen::Map<Eigen::Vector3f>(&moved->normals[i]) =
        ((mirrors ? -1.0 : 1.0) * (cofactors * n.cast<double>())).normalized().cast<float>();
  }
  for (std::size_t i = 0;
       mirrors && mesh.primitive == Mesh::Primitive::Triangles && i + 2 < moved->indices.size();
       i += 3) {
    std::swap(moved->indices[i + 1], moved->indices[i + 2]);
  }
  return moved;
}

class Exporter {
public:
  Exporter(const Scene& scene, const std::string& path, const SceneExportOptions& options)
      : Scene_(scene), Path_(path), Label_("file '" + path + "'"), Options_(options) {}

  std::vector<std::string> Run() {
    this->Check();
    this->AddFrames();
    for (const auto& [id, object] : this->Scene_.Objects()) {
      this->AddObject(object);
    }
    if (this->Options_.lights) {
      this->AddLights();
    }
    this->AddAnimation();
    this->AddFarWarning();
    tinygltf::Scene all;
    all.name = this->Scene_.Name();
    all.nodes = {0};
    this->File().scenes.push_back(all);
    this->File().defaultScene = 0;
    if (!this->Extras_.empty()) {
      this->File().asset.extras = tinygltf::Value(this->Extras_);
    }
    const std::string bytes = this->Builder_.Bytes(this->Label_);
    AtomicFile::Save(this->Path_, bytes.data(), bytes.size());
    return std::move(this->Warnings_);
  }

private:
  tinygltf::Model& File() { return this->Builder_.File(); }

  // Returns the index of a new node below `parent` (-1: none).
  int AddNode(tinygltf::Node node, int parent) {
    const int index = int(this->File().nodes.size());
    this->File().nodes.push_back(std::move(node));
    if (parent >= 0) {
      this->File().nodes[std::size_t(parent)].children.push_back(index);
    }
    return index;
  }

  void Check() const {
    std::string extension = std::filesystem::path(this->Path_).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    if (extension != ".glb") {
      Reject(this->Label_, "its extension is '" + extension + "'; accepted: .glb, binary glTF");
    }
    AtomicFile::Check(this->Path_);
    for (const std::string& fragment : this->Options_.fragments) {
      this->Scene_.Fragments().Get(fragment); // throws where there is none
    }
    this->CheckAnimation();
  }

  void CheckAnimation() const {
    const SceneExportOptions& options = this->Options_;
    if (options.poses.size() != options.times.size() * options.frames.size()) {
      Reject(this->Label_, "the animation has " + std::to_string(options.poses.size()) +
                               " poses for " + std::to_string(options.times.size()) +
                               " times and " + std::to_string(options.frames.size()) +
                               " frames; accepted: one for each frame at each time");
    }
    for (std::size_t i = 0; i < options.times.size(); ++i) {
      RequireFinite(this->Label_, "a time of the animation", options.times[i]);
      Require(i == 0 || options.times[i] > options.times[i - 1], this->Label_,
              "a time of the animation", options.times[i],
              "later than the time before it, in seconds");
    }
    std::unordered_set<FrameId> seen;
    for (const FrameId frame : options.frames) {
      const std::string& name = this->Scene_.Frames().Name(frame); // throws where there is none
      if (frame == RootFrame || !seen.insert(frame).second) {
        Reject("frame '" + name + "'",
               "it is the root, or the animation names it twice; accepted: any other frame, once");
      }
    }
    for (std::size_t i = 0; i < options.poses.size(); ++i) {
      if (!IsValidPose(options.poses[i])) {
        const FrameId frame = options.frames[i % options.frames.size()];
        RejectPose("frame '" + this->Scene_.Frames().Path(frame) + "'", options.poses[i]);
      }
    }
  }

  void AddFrames() {
    tinygltf::Node up;
    up.name = "Y up";
    up.rotation = Numbers(Eigen::Quaterniond(std::sqrt(0.5), -std::sqrt(0.5), 0.0, 0.0));
    this->AddNode(std::move(up), -1);
    const FrameTree& frames = this->Scene_.Frames();
    for (std::size_t slot = 0; slot < frames.Size(); ++slot) { // parents first
      const FrameId id = frames.IdAt(slot);
      tinygltf::Node node;
      node.name = id == RootFrame ? this->Scene_.Name() : frames.Name(id);
      Place(frames.LocalPose(id), node);
      const int parent = id == RootFrame ? 0 : this->NodeOf_.at(frames.Parent(id));
      this->NodeOf_[id] = this->AddNode(std::move(node), parent);
    }
  }

  bool IsWanted(const GraphicsObject& object) const {
    const SceneExportOptions& options = this->Options_;
    return object.visible && this->Scene_.Fragments().Get(object.fragment).visible &&
           (options.ornaments || object.nature == Nature::Physical) &&
           (options.fragments.empty() || options.fragments.count(object.fragment) != 0);
  }

  void LeaveOut(const GraphicsObject& object, const std::string& why) {
    this->Warnings_.push_back(this->Label_ + ": object '" + object.name + "' is left out: " + why);
  }

  void AddObject(const GraphicsObject& object) {
    if (!this->IsWanted(object)) {
      return;
    }
    if (object.billboard) {
      this->LeaveOut(object, "it is a label, which faces the camera");
      return;
    }
    std::vector<Part> parts;
    if (object.custom) {
      parts = this->Options_.partsOf ? this->Options_.partsOf(object) : parts;
    } else if (!object.levels.empty()) {
      parts = object.levels.front().parts;
    }
    parts.erase(std::remove_if(parts.begin(), parts.end(),
                               [&](const Part& part) {
                                 return !part.mesh || part.mesh->indices.empty() ||
                                        !IsPartVisible(object, part);
                               }),
                parts.end());
    if (parts.empty()) {
      this->LeaveOut(object,
                     object.custom ? "code of this process draws it" : "it has nothing to draw");
      return;
    }
    if (object.shader) {
      this->Warnings_.push_back(this->Label_ + ": object '" + object.name +
                                "' is written without its shader code");
    }
    const int frame = this->NodeOf_.at(object.frame);
    if (parts.size() == 1) {
      this->AddPart(object, parts[0], object.X_FO * parts[0].X_OP, frame, object.name);
    } else {
      tinygltf::Node node;
      node.name = object.name;
      const bool placed = Place(object.X_FO, node);
      const int parent = this->AddNode(std::move(node), frame);
      for (const Part& part : parts) {
        const Eigen::Affine3d X = placed ? part.X_OP : object.X_FO * part.X_OP;
        this->AddPart(object, part, X, parent, part.name);
      }
    }
    this->NoteDistance(object, parts);
  }

  void AddPart(const GraphicsObject& object, const Part& part, const Eigen::Affine3d& X, int parent,
               const std::string& name) {
    tinygltf::Node node;
    node.name = name;
    std::shared_ptr<const Mesh> mesh = part.mesh;
    if (!Place(X, node)) {
      mesh = Moved(*mesh, X);
    }
    node.mesh = this->Builder_.MeshOf(mesh, LookOf(object, part));
    this->AddNode(std::move(node), parent);
  }

  void NoteDistance(const GraphicsObject& object, const std::vector<Part>& parts) {
    DetailLevel level;
    level.parts = parts;
    const BoundingSphere sphere = BoundsOf(level);
    const Pose& X_RF = this->Scene_.Frames().WorldPose(object.frame);
    const double scale = X_RF.scale * object.X_FO.linear().colwise().norm().maxCoeff();
    const Eigen::Vector3d center = X_RF.Apply(object.X_FO * sphere.center);
    const Eigen::Vector3d around = Eigen::Vector3d::Constant(sphere.radius * scale);
    this->Box_.extend(Eigen::AlignedBox3d(center - around, center + around));
    const double distance = center.norm();
    if (distance > FarRatio * sphere.radius * scale) {
      if (this->Far_++ == 0) {
        this->FarText_ = "object '" + object.name + "' is " + NumberText(distance) +
                         " m from the root and " + NumberText(2.0 * sphere.radius * scale) +
                         " m large";
      }
    }
  }

  void AddLights() {
    const Eigen::Vector3d middle =
        this->Box_.isEmpty() ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : this->Box_.center();
    for (ExportedLight& each : ExportLights(this->Scene_, middle, this->Label_, this->Warnings_)) {
      const auto index = int(this->File().lights.size());
      each.node.extensions["KHR_lights_punctual"] =
          tinygltf::Value(tinygltf::Value::Object{{"light", tinygltf::Value(index)}});
      this->File().lights.push_back(std::move(each.light));
      this->AddNode(std::move(each.node), this->NodeOf_.at(each.frame));
    }
    const Eigen::Vector3d ambient = AmbientOf(this->Scene_);
    if (!ambient.isZero(0.0)) {
      this->Extras_["ambient"] = tinygltf::Value(
          tinygltf::Value::Array{tinygltf::Value(ambient.x()), tinygltf::Value(ambient.y()),
                                 tinygltf::Value(ambient.z())});
    }
  }

  void AddFarWarning() {
    if (this->Far_ > 0) {
      this->Warnings_.push_back(
          this->Label_ + ": " + this->FarText_ +
          (this->Far_ > 1 ? " (and " + std::to_string(this->Far_ - 1) + " more objects)" : "") +
          "; programs that compute with floats show it displaced or torn");
    }
  }

  void AddAnimation() {
    const SceneExportOptions& options = this->Options_;
    if (options.times.empty() || options.frames.empty()) {
      return;
    }
    std::vector<float> seconds(options.times.size());
    for (std::size_t i = 0; i < seconds.size(); ++i) {
      seconds[i] = float(options.times[i] - options.times[0]);
      Require(i == 0 || seconds[i] > seconds[i - 1], this->Label_, "a time of the animation",
              options.times[i], "times that differ as floats, counted from the first time");
    }
    tinygltf::Animation animation;
    animation.name = "poses";
    int input = -1; // made when the first channel needs it
    for (std::size_t f = 0; f < options.frames.size(); ++f) {
      const Pose& rest = this->Scene_.Frames().LocalPose(options.frames[f]);
      std::vector<float> position;
      std::vector<float> rotation;
      std::vector<float> scale;
      bool moves = false;
      bool turns = false;
      bool grows = false;
      Eigen::Quaterniond last = rest.rotation;
      for (std::size_t t = 0; t < options.times.size(); ++t) {
        const Pose pose = NormalisedPose(options.poses[t * options.frames.size() + f]);
        Eigen::Quaterniond q = pose.rotation;
        if (q.dot(last) < 0.0) {
          q.coeffs() = -q.coeffs(); // the same rotation, the short way from the key before
        }
        last = q;
        moves |= pose.position != rest.position;
        turns |= q.coeffs() != rest.rotation.coeffs();
        grows |= pose.scale != rest.scale;
        for (int k = 0; k < 3; ++k) {
          position.push_back(float(pose.position[k]));
          scale.push_back(float(pose.scale));
        }
        for (int k = 0; k < 4; ++k) {
          rotation.push_back(float(q.coeffs()[k])); // x y z w
        }
      }
      const auto add = [&](bool wanted, const char* path, const std::vector<float>& values, int n) {
        if (!wanted) {
          return; // the node's own pose holds
        }
        if (input < 0) {
          input = this->Builder_.Floats(seconds, 1, true);
        }
        tinygltf::AnimationSampler sampler;
        sampler.input = input;
        sampler.output = this->Builder_.Floats(values, n);
        sampler.interpolation = "LINEAR";
        tinygltf::AnimationChannel channel;
        channel.sampler = int(animation.samplers.size());
        channel.target_node = this->NodeOf_.at(options.frames[f]);
        channel.target_path = path;
        animation.samplers.push_back(std::move(sampler));
        animation.channels.push_back(std::move(channel));
      };
      add(moves, "translation", position, 3);
      add(turns, "rotation", rotation, 4);
      add(grows, "scale", scale, 3);
    }
    if (animation.channels.empty()) {
      this->Warnings_.push_back(this->Label_ + ": no frame moves in the given times: the file has "
                                               "no animation");
      return;
    }
    this->File().animations.push_back(std::move(animation));
    this->Extras_["start_s"] = tinygltf::Value(options.times[0]);
  }

  const Scene& Scene_;
  const std::string& Path_;
  std::string Label_;
  const SceneExportOptions& Options_;
  GltfBuilder Builder_;
  std::unordered_map<FrameId, int> NodeOf_;
  std::vector<std::string> Warnings_;
  tinygltf::Value::Object Extras_; // of the asset
  Eigen::AlignedBox3d Box_;        // of the spheres around the objects, in the root
  std::size_t Far_ = 0;
  std::string FarText_;
};

} // namespace

std::vector<std::string> ExportScene(const Scene& scene, const std::string& path,
                                     const SceneExportOptions& options) {
  return Exporter(scene, path, options).Run();
}

} // namespace dspace
