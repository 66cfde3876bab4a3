// Models whose nodes are frames: imported, posed by their animations.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include <dspace/Checks.h>
#include <dspace/FrameRules.h>
#include <dspace/commands/objects/ImportTools.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/NumberedNames.h>

namespace dspace::session {
namespace {

class TakenNames {
public:
  void Insert(const std::string& name) { this->Names_.insert(name); }
  // `wanted`, or numbered the first name that is not taken, which then is.
  std::string Take(const std::string& wanted) {
    std::string name = this->Numbered_.First(
        wanted, [this](const std::string& each) { return this->Names_.count(each) != 0; });
    this->Names_.insert(name);
    return name;
  }

private:
  std::set<std::string> Names_;
  NumberedNames Numbered_;
};

TakenNames NamesBelow(const FrameTree& frames, FrameId parent) {
  TakenNames names;
  for (const FrameId child : frames.Children(parent)) {
    names.Insert(frames.Name(child));
  }
  return names;
}

// An offset whose axes are scaled alike, as a pose.
Pose OffsetPose(const v1::Offset& offset, const std::string& label) {
  const Eigen::Vector3d scale =
      offset.has_scale() ? ToVector(offset.scale()) : Eigen::Vector3d::Ones();
  if (scale.x() != scale.y() || scale.x() != scale.z()) {
    Reject(label, "the scale is " + VectorText(scale) +
                      "; accepted for a model with frames: the same on each axis");
  }
  Pose X;
  X.position = ToVector(offset.position());
  X.rotation =
      offset.has_rotation() ? ToRotation(offset.rotation(), label) : Eigen::Quaterniond::Identity();
  X.scale = scale.x();
  if (!IsValidPose(X)) {
    RejectPose(label, X);
  }
  return NormalisedPose(X);
}

// glTF's lux and candela become the factors of Dspace's lights: E lux show a white matt surface as
// E / pi in glTF (appendix B.3.3, Lambert), and an intensity of 1 shows it as 1 in Dspace.
v1::SetLight LightOf(const ModelLight& from, FrameId frame, std::string name) {
  v1::SetLight light;
  light.set_name(std::move(name));
  light.set_frame(frame);
  Put(Eigen::Vector3d(0, 0, -1), light.mutable_direction());
  const auto encoded = [](double v) {
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
  };
  Put(std::array<double, 3>{encoded(from.color[0]), encoded(from.color[1]), encoded(from.color[2])},
      light.mutable_color());
  light.set_intensity(std::min(from.intensity / M_PI, 1e12));
  light.set_kind(from.kind == ModelLight::Kind::Point  ? v1::SetLight::POINT
                 : from.kind == ModelLight::Kind::Spot ? v1::SetLight::SPOT
                                                       : v1::SetLight::DIRECTIONAL);
  if (from.kind != ModelLight::Kind::Directional) {
    Put(Eigen::Vector3d(0, 0, 1), light.mutable_attenuation()); // 1 / d²
  }
  if (from.kind == ModelLight::Kind::Spot) {
    light.set_cone_deg(std::clamp(from.cone_deg, 0.01, 89.99));
  }
  return light;
}

class NodesBuilder {
public:
  NodesBuilder(const Context& context, v1::ImportNodes& command, ModelNodes& nodes)
      : Context_(context), Command_(command), Nodes_(nodes), Parts_(nodes.NodeParts()) {}

  // Ids and names either are all chosen here or all stand in the command.
  void CheckIds(const std::string& label) const {
    const auto objects = std::count_if(this->Parts_.begin(), this->Parts_.end(),
                                       [](const auto& parts) { return !parts.empty(); });
    const auto fits = [](int given, std::size_t wanted) {
      return given == 0 || std::size_t(given) == wanted;
    };
    if (!fits(this->Command_.frame_size(), this->Parts_.size() + 1) ||
        !fits(this->Command_.object_size(), std::size_t(objects)) ||
        !fits(this->Command_.object_name_size(), std::size_t(objects))) {
      Reject(label,
             "frame, object and object_name do not fit the file; accepted: none of them, or " +
                 std::to_string(this->Parts_.size() + 1) + ", " + std::to_string(objects) +
                 " and " + std::to_string(objects) + " of them");
    }
  }

  void Build(const Pose& X_FB) {
    FrameTree& frames = this->Context_.Frames();
    v1::ObjectSettings& settings = *this->Command_.mutable_import()->mutable_object();
    this->Nodes_.base =
        frames.Create(ToFrame(settings.frame()), settings.name(), X_FB, this->FrameIdAt(0));
    try {
      for (std::size_t i = 0; i < this->Parts_.size(); ++i) {
        this->AddNode(i);
      }
      if (this->Command_.lights()) {
        this->AddLights();
      }
    } catch (...) {
      this->Context_.GetScene().RemoveFrame(this->Nodes_.base); // objects and lights go with it
      throw;
    }
    this->Command_.clear_frame();
    this->Command_.add_frame(this->Nodes_.base);
    for (const FrameId id : this->Nodes_.frames) {
      this->Command_.add_frame(id);
    }
    this->Command_.clear_object();
    this->Command_.clear_object_name();
    for (const ObjectId id : this->Nodes_.objects) {
      if (id != 0) {
        this->Command_.add_object(id);
        this->Command_.add_object_name(this->Context_.GetScene().Object(id).name);
      }
    }
    this->Reply_.set_base(this->Nodes_.base);
    for (const ModelAnimation& animation : this->Nodes_.GetModel().animations) {
      v1::NodesReply::Animation* about = this->Reply_.add_animation();
      about->set_name(animation.name);
      about->set_duration_s(DurationOf(animation));
    }
    *this->Context_.reply.mutable_nodes() = std::move(this->Reply_); // instead of AddObject's
  }

private:
  FrameId FrameIdAt(int index) const {
    return index < this->Command_.frame_size() ? this->Command_.frame(index) : NoFrame;
  }

  void AddNode(std::size_t index) {
    FrameTree& frames = this->Context_.Frames();
    const ModelNode& node = this->Nodes_.GetModel().nodes[index];
    const FrameId parent =
        node.parent < 0 ? this->Nodes_.base : this->Nodes_.frames[std::size_t(node.parent)];
    const std::string wanted = node.name.empty() ? "node" : MappedFrameName(node.name);
    const std::string name = this->Taken_[parent].Take(wanted);
    this->Nodes_.frames.push_back(frames.Create(parent, name, this->Nodes_.RestPoses()[index],
                                                this->FrameIdAt(int(index) + 1)));
    this->Nodes_.objects.push_back(0);
    if (!this->Parts_[index].empty()) {
      this->Nodes_.objects.back() = this->AddNodeObject(index, name);
    }
    v1::NodesReply::Node* reply = this->Reply_.add_node();
    reply->set_name(node.name);
    reply->set_frame_name(name);
    reply->set_frame(this->Nodes_.frames.back());
    reply->set_object(this->Nodes_.objects.back());
    reply->set_parent(node.parent);
  }

  ObjectId AddNodeObject(std::size_t index, const std::string& name) {
    v1::ObjectSettings settings = this->Command_.import().object();
    const std::string wanted = settings.name() + "/" + name;
    settings.clear_offset();
    settings.set_frame(this->Nodes_.frames.back());
    const int at = this->NextObject_++;
    settings.set_id(at < this->Command_.object_size() ? this->Command_.object(at) : 0);
    settings.set_name(at < this->Command_.object_name_size()
                          ? this->Command_.object_name(at)
                          : this->Context_.GetScene().FreeObjectName(wanted));
    std::vector<DetailLevel> levels(1);
    levels[0].parts = std::move(this->Parts_[index]);
    const ObjectId id = AddObject(this->Context_, settings, wanted, std::move(levels));
    *this->Command_.mutable_import()->mutable_object()->mutable_material() = settings.material();
    return id;
  }

  void AddLights() {
    Scene& scene = this->Context_.GetScene();
    TakenNames taken;
    for (const Light& light : scene.Fragments().Lights()) {
      taken.Insert(light.name);
    }
    for (const ModelLight& from : this->Nodes_.GetModel().lights) {
      const std::string wanted =
          this->Command_.import().object().name() + "/" + (from.name.empty() ? "light" : from.name);
      const v1::SetLight light =
          LightOf(from, this->Nodes_.frames[std::size_t(from.node)], taken.Take(wanted));
      scene.SetLight(ToLight(light));
      *this->Reply_.add_light() = light;
    }
  }

  const Context& Context_;
  v1::ImportNodes& Command_;
  ModelNodes& Nodes_;
  std::vector<std::vector<Part>> Parts_;
  std::map<FrameId, TakenNames> Taken_; // names below each frame
  int NextObject_ = 0;
  v1::NodesReply Reply_;
};

void ImportNodes(const Context& context, v1::ImportNodes& command) {
  v1::ImportObject& import = *command.mutable_import();
  const std::string label = ImportLabel(import);
  if (import.level_size() != 1) {
    Reject(label, std::to_string(import.level_size()) +
                      " levels are given; accepted for a model with frames: one");
  }
  const double scale = ImportScale(import);
  const Eigen::Quaterniond rotation = ImportRotation(import);
  v1::ObjectSettings& settings = *import.mutable_object();
  const Pose X_FB = OffsetPose(settings.offset(), label);
  const FrameId parent = ToFrame(settings.frame());
  TakenNames taken = NamesBelow(context.Frames(), parent);
  const auto model = ImportLevel(context, import, *import.mutable_level(0), command.lights(), true);
  ModelNodes nodes(model, scale, rotation);
  NodesBuilder builder(context, command, nodes);
  builder.CheckIds(label);
  if (settings.name().empty()) {
    const std::string stem = std::filesystem::path(import.level(0).path()).stem().string();
    settings.set_name(taken.Take(MappedFrameName(stem)));
  }
  builder.Build(X_FB);
  const FrameId base = nodes.base;
  context.scene->models.emplace(base, std::move(nodes));
}

void PoseNodes(const Context& context, v1::PoseNodes& command) {
  const auto found = context.scene->models.find(command.base());
  if (found == context.scene->models.end()) {
    throw Error(Error::Kind::NotFound, "frame " + std::to_string(command.base()),
                "it holds no model whose nodes are frames; accepted: the base that import_nodes "
                "returned");
  }
  const ModelNodes& nodes = found->second;
  FrameTree& frames = context.Frames();
  const std::vector<std::string> uneven =
      nodes.PoseAt(frames, command.animation(), command.time_s());
  if (!uneven.empty()) {
    context.reply.add_warning("file '" + nodes.GetModel().path + "': the animation scales node '" +
                              uneven.front() + "' differently along its axes" +
                              (uneven.size() > 1 ? ", and others" : "") + "; frames show the mean");
  }
  google::protobuf::RepeatedField<double>* out = context.reply.mutable_poses()->mutable_pose();
  for (const FrameId id : nodes.frames) {
    const Pose& X = frames.LocalPose(id);
    for (const double value : {X.position.x(), X.position.y(), X.position.z(), X.rotation.w(),
                               X.rotation.x(), X.rotation.y(), X.rotation.z(), X.scale}) {
      out->Add(value);
    }
  }
}

} // namespace

void AddNodeCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kImportNodes, &C::mutable_import_nodes, ImportNodes);
  registry.Add(C::kPoseNodes, &C::mutable_pose_nodes, PoseNodes);
}

} // namespace dspace::session
