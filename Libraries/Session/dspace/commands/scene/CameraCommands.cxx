// Vantages and cameras.
#include <algorithm>
#include <cmath>

#include <dspace/commands/scene/CameraTools.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/Checks.h>

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
      Refuse("vantage '" + command.name() + "'",
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
    Refuse(camera, "its chase axes are " + std::to_string(int(axes)) + "; accepted: 0 to 2");
  }
}

Eigen::Vector3d UpOr(bool given, const v1::Vector3& up) {
  return given ? ToVector(up) : Eigen::Vector3d::UnitZ();
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
    to.X_FC =
        LookAt(name, ToVector(look.eye()), ToVector(look.target()), UpOr(look.has_up(), look.up()));
    break;
  }
  case v1::Mount::kChase: {
    const v1::Mount::Chase& chase = from.chase();
    to.kind = CameraMount::Kind::Chase;
    to.axes = ToAxes(chase.axes(), label);
    to.offset = ToVector(chase.offset());
    to.target = ToVector(chase.target());
    to.up = UpOr(chase.has_up(), chase.up());
    to.smoothing_s = chase.smoothing_s();
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
      Refuse("camera '" + command.name() + "'",
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
}

} // namespace dspace::session
