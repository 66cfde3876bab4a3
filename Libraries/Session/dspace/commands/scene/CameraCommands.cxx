// Vantages and cameras.
#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/commands/scene/CameraTools.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/CustomGeometry.h>
#include <dspace/scene/Stretch.h>
#include <dspace/scene/controls/CameraFit.h>

namespace dspace::session {
namespace {

std::string VantageName(const std::string& name) {
  return name.empty() ? DefaultVantage : name;
}

void CreateVantage(const Context& context, v1::CreateVantage& command) {
  context.GetScene().CreateVantage(command.name());
}

void RemoveVantage(const Context& context, v1::RemoveVantage& command) {
  for (const auto& [name, viewport] : context.state.viewports) {
    if (viewport.scene == context.sceneName && viewport.vantage == command.name()) {
      Reject("vantage '" + command.name() + "'",
             "viewport '" + name + "' shows it; remove the viewport or show another vantage first");
    }
  }
  context.GetScene().RemoveVantage(command.name());
}

void ListVantages(const Context& context, v1::ListVantages&) {
  v1::VantageList* list = context.reply.mutable_vantages();
  for (const std::string& name : context.GetScene().VantageNames()) {
    const SceneVantage& vantage = context.GetScene().Vantage(name);
    v1::VantageInfo* info = list->add_vantage();
    info->set_name(name);
    for (const std::string& camera : vantage.CameraNames()) {
      info->add_camera(camera);
    }
    if (info->camera_size() > 0) {
      info->set_active(vantage.ActiveCamera().name);
    }
  }
}

CameraMount::ChaseAxes ToAxes(v1::Mount::Chase::Axes axes, const std::string& camera) {
  switch (axes) {
  case v1::Mount::Chase::HEADING:
    return CameraMount::ChaseAxes::Heading;
  case v1::Mount::Chase::FOLLOWED:
    return CameraMount::ChaseAxes::Followed;
  case v1::Mount::Chase::PARENT:
    return CameraMount::ChaseAxes::Parent;
  default:
    Reject(camera, "its chase axes are " + std::to_string(int(axes)) + "; accepted: 0 to 2");
  }
}

// `sight`: along which a camera looks that is given no `up`.
Eigen::Vector3d UpOr(bool given, const v1::Vector3& up, const Eigen::Vector3d& sight) {
  return given ? ToVector(up) : UpFor(sight);
}

CameraMount ToMount(const v1::Mount& from, const std::string& name) {
  const std::string label = "camera '" + name + "'";
  CameraMount to;
  to.frame = ToFrame(from.frame());
  switch (from.kind_case()) {
  case v1::Mount::kPose:
    to.X_FC = ToPose(from.pose(), label);
    break;
  case v1::Mount::kLookAt: {
    const v1::LookAt& look = from.look_at();
    const Eigen::Vector3d eye = ToVector(look.eye()), target = ToVector(look.target());
    to.X_FC = LookAt(name, eye, target, UpOr(look.has_up(), look.up(), target - eye));
    break;
  }
  case v1::Mount::kChase: {
    const v1::Mount::Chase& chase = from.chase();
    to.kind = CameraMount::Kind::Chase;
    to.axes = ToAxes(chase.axes(), label);
    to.offset = ToVector(chase.offset());
    to.target = ToVector(chase.target());
    to.up = UpOr(chase.has_up(), chase.up(), to.target - to.offset);
    if (chase.has_vertical()) {
      to.aim = ToFrame(chase.vertical().frame());
      to.vertical =
          chase.vertical().axis() ? CameraMount::Vertical::Axis : CameraMount::Vertical::Away;
    }
    to.smoothing_s = chase.smoothing_s();
    break;
  }
  case v1::Mount::kPointing: {
    const v1::Mount::Pointing& pointing = from.pointing();
    to.kind = CameraMount::Kind::Pointing;
    to.X_FC.position = ToVector(pointing.eye());
    to.aim = ToFrame(pointing.aim());
    to.target = ToVector(pointing.target());
    to.up = pointing.has_up() ? ToVector(pointing.up()) : Eigen::Vector3d::UnitZ();
    to.smoothing_s = pointing.smoothing_s();
    break;
  }
  case v1::Mount::KIND_NOT_SET:
    break;
  }
  return to;
}

void SetCamera(const Context& context, v1::SetCamera& command) {
  Scene& scene = context.GetScene();
  const std::string vantage = VantageName(command.vantage());
  const std::vector<std::string> names = scene.Vantage(vantage).CameraNames();
  Camera camera;
  if (std::find(names.begin(), names.end(), command.name()) != names.end()) {
    camera = scene.Vantage(vantage).GetCamera(command.name());
  }
  camera.name = command.name();
  if (command.has_projection()) {
    camera.projection = ToProjection(command.projection());
  }
  if (command.has_mount()) {
    camera.mount = ToMount(command.mount(), command.name());
  }
  scene.SetCamera(vantage, camera);
  DescribeCamera(context.sceneName, scene, vantage, camera.name, context.reply.mutable_camera());
}

void RemoveCamera(const Context& context, v1::RemoveCamera& command) {
  const std::string vantage = VantageName(command.vantage());
  for (const auto& [name, viewport] : context.state.viewports) {
    if (viewport.scene == context.sceneName && viewport.vantage == vantage &&
        viewport.camera == command.name()) {
      Reject("camera '" + command.name() + "'",
             "viewport '" + name + "' looks through it; give the viewport another camera first");
    }
  }
  context.GetScene().RemoveCamera(vantage, command.name());
}

void SetActiveCamera(const Context& context, v1::SetActiveCamera& command) {
  context.GetScene().SetActiveCamera(VantageName(command.vantage()), command.name());
}

void AnswerCamera(const Context& context, v1::DescribeCamera& command) {
  DescribeCamera(context.sceneName, context.GetScene(), VantageName(command.vantage()),
                 command.name(), context.reply.mutable_camera());
}

// The objects that a command names, or all visible ones.
std::vector<ObjectId> ObjectsToFit(const Scene& scene, const v1::FitCamera& command) {
  const FrameTree& frames = scene.Frames();
  for (const FrameId frame : command.frame()) {
    frames.Path(frame); // throws where there is none
  }
  std::vector<ObjectId> ids;
  for (const ObjectId id : command.object()) {
    ids.push_back(scene.Object(id).id); // throws where there is none
  }
  for (const auto& [id, object] : scene.Objects()) {
    bool wanted = command.object_size() == 0 && command.frame_size() == 0;
    for (FrameId at = object.frame; command.frame_size() > 0 && !wanted; at = frames.Parent(at)) {
      wanted =
          std::find(command.frame().begin(), command.frame().end(), at) != command.frame().end();
      if (at == RootFrame) {
        break;
      }
    }
    if (wanted && object.visible) {
      ids.push_back(id);
    }
  }
  return ids;
}

// What contains the object, in frame A: the corners of its box, or a sphere.
void AddBounds(const Scene& scene, const GraphicsObject& object, FrameId A,
               std::vector<BoundingSphere>& spheres) {
  const Pose X_AF = scene.Frames().RelativePose(A, object.frame);
  if (object.billboard) {
    spheres.push_back({X_AF.Apply(object.X_FO.translation()), 0.0});
  } else if (object.custom) {
    if (object.custom->IsBackdrop()) {
      return;
    }
    const BoundingSphere sphere = object.custom->Bounds();
    const double stretch = LargestStretch(object.X_FO) * X_AF.scale;
    spheres.push_back({X_AF.Apply(object.X_FO * sphere.center), sphere.radius * stretch});
  } else if (!object.levels.empty() && !object.levels.front().box.isEmpty()) {
    for (int i = 0; i < 8; ++i) {
      const auto corner = static_cast<Eigen::AlignedBox3d::CornerType>(i);
      spheres.push_back({X_AF.Apply(object.X_FO * object.levels.front().box.corner(corner)), 0.0});
    }
  }
}

void AnswerFit(const Context& context, v1::FitCamera& command) {
  const Scene& scene = context.GetScene();
  const std::string vantage = VantageName(command.vantage());
  const SceneVantage& views = scene.Vantage(vantage);
  const Camera& camera =
      command.name().empty() ? views.ActiveCamera() : views.GetCamera(command.name());
  const CameraPose pose = scene.PlaceCamera(vantage, camera.name);
  std::vector<BoundingSphere> spheres;
  for (const ObjectId id : ObjectsToFit(scene, command)) {
    AddBounds(scene, scene.Object(id), pose.frame, spheres);
  }
  const double margin = command.has_margin() ? command.margin() : 0.1;
  const double aspect = command.aspect() == 0.0 ? 16.0 / 9.0 : command.aspect();
  const Camera fitted = FitCamera(camera, pose, spheres, margin, aspect);
  v1::CameraInfo* info = context.reply.mutable_camera();
  info->set_scene(context.sceneName);
  info->set_vantage(vantage);
  info->set_name(camera.name);
  info->set_active(views.ActiveCamera().name == camera.name);
  Put(fitted.projection, info->mutable_projection());
  Put(fitted.mount, info->mutable_mount());
}

void GetCameraPose(const Context& context, v1::GetCameraPose& command) {
  Put(CameraPoseIn(context.GetScene(), VantageName(command.vantage()), command.name(),
                   ToFrame(command.relative_to())),
      context.reply.mutable_camera_pose()->mutable_pose());
}

} // namespace

Pose CameraPoseIn(const Scene& scene, const std::string& vantage, const std::string& camera,
                  FrameId frame) {
  const CameraPose at = scene.PlaceCamera(vantage, camera);
  Pose X_GC = scene.Frames().RelativePose(frame, at.frame) * at.X_FC;
  X_GC.scale = 1.0; // a camera has none
  return X_GC;
}

void PutLag(const std::pair<std::string, std::string>& camera, const ChaseState& from,
            v1::CameraLag* to) {
  to->set_vantage(camera.first);
  to->set_camera(camera.second);
  to->set_time_s(from.time_s);
  to->set_frame(from.frame);
  to->set_parent(from.parent);
  Put(from.p_PC, to->mutable_position());
}

void DescribeCamera(const std::string& sceneName, const Scene& scene, const std::string& vantage,
                    const std::string& name, v1::CameraInfo* info) {
  const SceneVantage& views = scene.Vantage(vantage);
  const Camera& camera = name.empty() ? views.ActiveCamera() : views.GetCamera(name);
  info->set_scene(sceneName);
  info->set_vantage(vantage);
  info->set_name(camera.name);
  Put(camera.projection, info->mutable_projection());
  Put(camera.mount, info->mutable_mount());
  info->set_active(views.ActiveCamera().name == camera.name);
  const auto lag = scene.GetLags().find({vantage, camera.name});
  if (lag != scene.GetLags().end() && lag->second.started) {
    PutLag(lag->first, lag->second, info->mutable_lag());
  }
}

void AddCameraCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateVantage, &C::mutable_create_vantage, CreateVantage);
  registry.Add(C::kRemoveVantage, &C::mutable_remove_vantage, RemoveVantage);
  registry.Add(C::kListVantages, &C::mutable_list_vantages, ListVantages);
  registry.Add(C::kSetCamera, &C::mutable_set_camera, SetCamera);
  registry.Add(C::kRemoveCamera, &C::mutable_remove_camera, RemoveCamera);
  registry.Add(C::kSetActiveCamera, &C::mutable_set_active_camera, SetActiveCamera);
  registry.Add(C::kDescribeCamera, &C::mutable_describe_camera, AnswerCamera);
  registry.Add(C::kGetCameraPose, &C::mutable_get_camera_pose, GetCameraPose);
  registry.Add(C::kFitCamera, &C::mutable_fit_camera, AnswerFit);
}

} // namespace dspace::session
