// Vantages and cameras.
#include <algorithm>
#include <cmath>

#include <dspace/scene/Checks.h>
#include <dspace/session/Convert.h>
#include <dspace/session/Registry.h>

namespace dspace::session {
namespace {

std::string VantageName(const std::string& name) {
  return name.empty() ? DefaultVantage : name;
}

void CreateVantage(const Context& context, v1::CreateVantage& command) {
  context.TheScene().CreateVantage(command.name());
}

void RemoveVantage(const Context& context, v1::RemoveVantage& command) {
  for (const auto& [name, viewport] : context.state.viewports) {
    if (viewport.scene == context.sceneName && viewport.vantage == command.name()) {
      Refuse("vantage '" + command.name() + "'",
             "viewport '" + name + "' shows it; remove the viewport or show another vantage first");
    }
  }
  context.TheScene().RemoveVantage(command.name());
}

void ListVantages(const Context& context, v1::ListVantages&) {
  v1::VantageList* list = context.reply.mutable_vantages();
  for (const std::string& name : context.TheScene().VantageNames()) {
    const SceneVantage& vantage = context.TheScene().Vantage(name);
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

void PutProjection(const Projection& from, v1::Projection* to) {
  switch (from.kind) {
  case Projection::Kind::Perspective:
    to->mutable_perspective()->set_vertical_fov_deg(from.verticalFov_deg);
    break;
  case Projection::Kind::Orthographic:
    to->mutable_orthographic()->set_height(from.height);
    break;
  case Projection::Kind::Frustum:
    to->mutable_frustum()->set_left(from.left);
    to->mutable_frustum()->set_right(from.right);
    to->mutable_frustum()->set_top(from.top);
    to->mutable_frustum()->set_bottom(from.bottom);
    break;
  }
  to->set_near(from.nearDistance);
  to->set_far(from.farDistance);
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

v1::Mount::Chase::Axes FromAxes(CameraMount::ChaseAxes axes) {
  switch (axes) {
  case CameraMount::ChaseAxes::Followed:
    return v1::Mount::Chase::FOLLOWED;
  case CameraMount::ChaseAxes::Parent:
    return v1::Mount::Chase::PARENT;
  case CameraMount::ChaseAxes::Heading:
    break;
  }
  return v1::Mount::Chase::HEADING;
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

void PutMount(const CameraMount& from, v1::Mount* to) {
  to->set_frame(from.frame);
  if (from.kind == CameraMount::Kind::Fixed) {
    Put(from.X_FC, to->mutable_pose());
    return;
  }
  v1::Mount::Chase* chase = to->mutable_chase();
  chase->set_axes(FromAxes(from.axes));
  Put(from.offset, chase->mutable_offset());
  Put(from.target, chase->mutable_target());
  Put(from.up, chase->mutable_up());
  chase->set_smoothing_s(from.smoothing_s);
}

void SetCamera(const Context& context, v1::SetCamera& command) {
  Scene& scene = context.TheScene();
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
  context.TheScene().RemoveCamera(vantage, command.name());
}

void SetActiveCamera(const Context& context, v1::SetActiveCamera& command) {
  context.TheScene().SetActiveCamera(VantageName(command.vantage()), command.name());
}

void DescribeCamera(const Context& context, v1::DescribeCamera& command) {
  const std::string name = VantageName(command.vantage());
  const SceneVantage& vantage = context.TheScene().Vantage(name);
  const Camera& camera =
      command.name().empty() ? vantage.ActiveCamera() : vantage.GetCamera(command.name());
  v1::CameraInfo* info = context.reply.mutable_camera();
  info->set_vantage(name);
  info->set_name(camera.name);
  PutProjection(camera.projection, info->mutable_projection());
  PutMount(camera.mount, info->mutable_mount());
  info->set_active(vantage.ActiveCamera().name == camera.name);
}

} // namespace

void AddCameraCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateVantage, &C::mutable_create_vantage, Effect::Change, CreateVantage);
  registry.Add(C::kRemoveVantage, &C::mutable_remove_vantage, Effect::Change, RemoveVantage);
  registry.Add(C::kListVantages, &C::mutable_list_vantages, Effect::Request, ListVantages);
  registry.Add(C::kSetCamera, &C::mutable_set_camera, Effect::Change, SetCamera);
  registry.Add(C::kRemoveCamera, &C::mutable_remove_camera, Effect::Change, RemoveCamera);
  registry.Add(C::kSetActiveCamera, &C::mutable_set_active_camera, Effect::Change, SetActiveCamera);
  registry.Add(C::kDescribeCamera, &C::mutable_describe_camera, Effect::Request, DescribeCamera);
}

} // namespace dspace::session
