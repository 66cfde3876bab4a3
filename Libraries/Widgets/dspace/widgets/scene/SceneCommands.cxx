#include <dspace/widgets/scene/SceneCommands.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <QObject>

#include "vtkDspaceSession.h"
#include "vtkSmartPointer.h"

#include <dspace/Error.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/proto/commands.pb.h>
#include <dspace/scene/Scene.h>
#include <dspace/scene/Stretch.h>
#include <dspace/state/State.h>
#include <dspace/widgets/scene/SceneTreeWidget.h>

namespace dspace::widgets {
namespace {

constexpr double EmptyDistance = 5.0; // [m], from a frame without objects
constexpr double EmptyAxes = 1.0;     // [m]
constexpr std::uint32_t TrailPoints = 100000;

// The commands of one widget's requests. It lives as long as the widget.
class SceneCommands {
public:
  using Executor = std::function<std::string(const std::string&)>;

  SceneCommands(vtkDspaceSession* session, std::string scene, std::string vantage, Executor execute)
      : Session_(session), Scene_(std::move(scene)), Vantage_(std::move(vantage)),
        Execute_(std::move(execute)) {
    this->Token_ = session->GetInterpreter().AddListener(
        [this](const v1::Command& command, const v1::Reply&) { this->Follow(command); });
  }
  ~SceneCommands() { this->Session_->GetInterpreter().RemoveListener(this->Token_); }
  SceneCommands(const SceneCommands&) = delete;
  SceneCommands& operator=(const SceneCommands&) = delete;

  std::shared_ptr<Scene> GetScene() const {
    return this->Session_->GetInterpreter().FindScene(this->Scene_);
  }

  void Handle(const SceneRequest& request) {
    const std::shared_ptr<Scene> scene = this->GetScene();
    if (!scene) {
      throw Error(Error::Kind::NotFound, "scene '" + this->Scene_ + "'", "it was removed");
    }
    switch (request.action) {
    case SceneAction::Show:
    case SceneAction::Hide:
      for (const ObjectId id : ObjectsOf(*scene, request.item)) {
        const bool visible = request.action == SceneAction::Show;
        if (scene->Object(id).visible != visible) {
          v1::Command command = this->New();
          command.mutable_set_object_visible()->set_object(id);
          command.mutable_set_object_visible()->set_visible(visible);
          this->Execute(command);
        }
      }
      break;
    case SceneAction::Chase:
      this->Chase(*scene, request.item);
      break;
    case SceneAction::Focus:
      this->Focus(request.item);
      break;
    case SceneAction::Trail:
      this->SwitchTrail(*scene, request.item.frame);
      break;
    case SceneAction::Axes:
      this->SwitchAxes(*scene, request.item);
      break;
    case SceneAction::CopyPath:
      break;
    }
  }

  QString KindOf(ObjectId id) const {
    session::State& state = this->Session_->GetInterpreter().GetState();
    const auto found = state.scenes.find(this->Scene_);
    if (found == state.scenes.end()) {
      return {};
    }
    const session::SceneState& scene = found->second;
    return scene.TerrainOf(id)          ? "terrain"
           : scene.trails.count(id)     ? "trail"
           : scene.texts.count(id)      ? "text"
           : scene.primitives.count(id) ? "primitive"
           : scene.drawn.count(id)      ? "drawn"
                                        : QString();
  }

private:
  v1::Command New() const {
    v1::Command command;
    command.set_scene(this->Scene_);
    return command;
  }
  v1::Reply Execute(const v1::Command& command) const {
    v1::Reply reply;
    const std::string bytes = command.SerializeAsString();
    reply.ParseFromString(this->Execute_ ? this->Execute_(bytes) : this->Session_->Execute(bytes));
    if (reply.has_error()) {
      throw Error(Error::Kind::InvalidArgument, "", reply.error().message());
    }
    return reply;
  }

  static std::vector<ObjectId> ObjectsOf(const Scene& scene, const SceneItem& item) {
    if (item.object != 0) {
      return {item.object};
    }
    const FrameTree& frames = scene.Frames();
    std::vector<ObjectId> ids;
    for (const auto& [id, object] : scene.Objects()) {
      for (FrameId at = object.frame; at != NoFrame; at = frames.Parent(at)) {
        if (at == item.frame) {
          ids.push_back(id);
          break;
        }
      }
    }
    return ids;
  }

  // From the frame's origin to the farthest point of the physical objects on it and below [m in
  // `frame`]; 0: there are none.
  static double SizeOf(const Scene& scene, const SceneItem& item, FrameId frame) {
    double size = 0.0;
    for (const ObjectId id : ObjectsOf(scene, {item.frame, 0})) {
      const GraphicsObject& object = scene.Object(id);
      if (object.nature != Nature::Physical || object.billboard) {
        continue;
      }
      const BoundingSphere sphere = object.custom           ? object.custom->Bounds()
                                    : object.levels.empty() ? BoundingSphere{}
                                                            : object.levels.front().sphere;
      const Pose X = scene.Frames().RelativePose(frame, object.frame);
      const double radius = sphere.radius * LargestStretch(object.X_FO) * X.scale;
      const Eigen::Vector3d origin = scene.Frames().RelativePose(frame, item.frame).position;
      size = std::max(size, (X.Apply(object.X_FO * sphere.center) - origin).norm() + radius);
    }
    return size;
  }

  // The name of the active camera; "main" where there is none.
  std::string CameraName(const Scene& scene) const {
    try {
      return scene.Vantage(this->Vantage_).ActiveCamera().name;
    } catch (const Error&) {
      return "main";
    }
  }

  void Chase(const Scene& scene, const SceneItem& item) const {
    const FrameId parent = scene.Frames().Parent(item.frame);
    if (parent == NoFrame) {
      throw Error(Error::Kind::InvalidArgument, "frame '/'",
                  "cannot be chased; accepted: a frame below the root");
    }
    const double size = SizeOf(scene, item, parent);
    const Eigen::Vector3d offset =
        Eigen::Vector3d(-5.0, 0.0, 2.0).normalized() * (size > 0.0 ? 3.5 * size : EmptyDistance);
    v1::Command command = this->New();
    v1::SetCamera& camera = *command.mutable_set_camera();
    camera.set_vantage(this->Vantage_);
    camera.set_name(this->CameraName(scene));
    camera.mutable_mount()->set_frame(item.frame);
    v1::Mount::Chase& chase = *camera.mutable_mount()->mutable_chase();
    chase.mutable_offset()->set_x(offset.x());
    chase.mutable_offset()->set_y(offset.y());
    chase.mutable_offset()->set_z(offset.z());
    this->Execute(command);
  }

  void Focus(const SceneItem& item) const {
    v1::Command request = this->New();
    v1::FitCamera& fit = *request.mutable_fit_camera();
    fit.set_vantage(this->Vantage_);
    if (item.object != 0) {
      fit.add_object(item.object);
    } else {
      fit.add_frame(item.frame);
    }
    const v1::Reply fitted = this->Execute(request);
    v1::Command command = this->New();
    v1::SetCamera& camera = *command.mutable_set_camera();
    camera.set_vantage(this->Vantage_);
    camera.set_name(fitted.camera().name());
    *camera.mutable_mount() = fitted.camera().mount();
    *camera.mutable_projection() = fitted.camera().projection();
    this->Execute(command);
  }

  // Removes the object of this name, if there is one.
  bool Remove(const Scene& scene, const std::string& name) {
    const ObjectId id = scene.FindObject(name);
    if (id == 0) {
      return false;
    }
    v1::Command command = this->New();
    command.mutable_remove_object()->set_object(id);
    this->Execute(command);
    return true;
  }

  void SwitchAxes(const Scene& scene, const SceneItem& item) {
    const std::string name = "axes of " + scene.Frames().Path(item.frame);
    if (this->Remove(scene, name)) {
      return;
    }
    const double size = SizeOf(scene, item, item.frame);
    v1::Command command = this->New();
    v1::CreatePrimitive& axes = *command.mutable_create_primitive();
    axes.mutable_object()->set_name(name);
    axes.mutable_object()->set_frame(item.frame);
    axes.mutable_object()->set_nature(v1::ORNAMENTAL);
    axes.mutable_axes()->set_length(size > 0.0 ? size : EmptyAxes);
    this->Execute(command);
  }

  void SwitchTrail(const Scene& scene, FrameId frame) {
    const std::string name = "trail of " + scene.Frames().Path(frame);
    if (this->Remove(scene, name)) {
      return;
    }
    v1::Command command = this->New();
    v1::CreateTrail& trail = *command.mutable_create_trail();
    trail.mutable_object()->set_name(name);
    trail.mutable_object()->set_frame(RootFrame);
    trail.mutable_object()->set_nature(v1::ORNAMENTAL);
    trail.set_capacity(TrailPoints);
    const ObjectId id = this->Execute(command).object().object();
    this->Trails_[id] = {frame, {}};
    this->Append(scene);
  }

  // After every command: frames may have moved. The trails' own commands come here, too.
  void Follow(const v1::Command& command) {
    if (this->Trails_.empty() || command.scene() != this->Scene_ || this->Appending_) {
      return;
    }
    if (const std::shared_ptr<Scene> scene = this->GetScene()) {
      this->Append(*scene);
    }
  }

  void Append(const Scene& scene) {
    this->Appending_ = true;
    for (auto it = this->Trails_.begin(); it != this->Trails_.end();) {
      FollowedFrame& followed = it->second;
      if (!scene.Frames().Contains(followed.frame) || !scene.Objects().count(it->first)) {
        it = this->Trails_.erase(it);
        continue;
      }
      const Eigen::Vector3d p = scene.Frames().RelativePose(RootFrame, followed.frame).position;
      if (!followed.last || *followed.last != p) {
        v1::Command command = this->New();
        v1::AppendTrail& trail = *command.mutable_append_trail();
        trail.set_object(it->first);
        for (const double value : {p.x(), p.y(), p.z()}) {
          trail.add_point(value);
        }
        // Not the session's Execute(), which may be in the command that is followed.
        if (this->Session_->GetInterpreter().Execute(command).has_error()) {
          it = this->Trails_.erase(it); // another scene has taken the place of this one
          continue;
        }
        followed.last = p;
      }
      ++it;
    }
    this->Appending_ = false;
  }

  struct FollowedFrame {
    FrameId frame = NoFrame;
    std::optional<Eigen::Vector3d> last; // in the root [m]
  };

  vtkSmartPointer<vtkDspaceSession> Session_;
  std::string Scene_;
  std::string Vantage_;
  Executor Execute_;
  session::Interpreter::Token Token_ = 0;
  std::map<ObjectId, FollowedFrame> Trails_;
  bool Appending_ = false;
};

} // namespace

SceneActions ActionsOf(vtkDspaceSession* session, const std::string& scene,
                       const std::string& vantage,
                       std::function<std::string(const std::string&)> execute) {
  const auto commands =
      std::make_shared<SceneCommands>(session, scene, vantage, std::move(execute));
  return {[commands] { return commands->GetScene(); },
          [commands](const SceneRequest& request) { commands->Handle(request); },
          [commands](ObjectId id) { return commands->KindOf(id); }};
}

void Connect(SceneTreeWidget& widget, const SceneActions& actions) {
  widget.SetKinds(actions.kinds);
  widget.SetHandler(actions.handler);
  widget.SetSource(actions.source);
}

void ConnectToSession(SceneTreeWidget& widget, vtkDspaceSession* session, const std::string& scene,
                      const std::string& vantage) {
  Connect(widget, ActionsOf(session, scene, vantage));
}

} // namespace dspace::widgets
