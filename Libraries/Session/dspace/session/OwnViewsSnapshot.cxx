// Views of one's own when a snapshot takes the place of what they look at.
#include <dspace/session/OwnViews.h>

#include <dspace/session/Convert.h>

namespace dspace::session {
namespace {

std::string SceneOf(const v1::Command& command) {
  return command.scene().empty() ? DefaultScene : command.scene();
}

} // namespace

std::optional<v1::SetCamera> OwnViews::CameraOf(Interpreter& interpreter, const std::string& scene,
                                                const std::string& vantage,
                                                const std::string& camera) {
  v1::Command command;
  command.set_scene(scene);
  command.mutable_describe_camera()->set_vantage(vantage);
  command.mutable_describe_camera()->set_name(camera);
  const v1::Reply reply = interpreter.Execute(command);
  if (!reply.has_camera()) {
    return std::nullopt;
  }
  v1::SetCamera set;
  set.set_vantage(vantage);
  set.set_name(reply.camera().name());
  *set.mutable_projection() = reply.camera().projection();
  *set.mutable_mount() = reply.camera().mount();
  return set;
}

v1::Mount OwnViews::RootMount(const Scene& scene, const std::string& vantage,
                              const std::string& camera) {
  const CameraPose at = scene.PlaceCamera(vantage, camera);
  Pose X_RC = scene.Frames().WorldPose(at.frame) * at.X_FC;
  X_RC.scale = 1.0; // a camera has none
  v1::Mount mount;
  mount.set_frame(RootFrame);
  Put(X_RC, mount.mutable_pose());
  return mount;
}

void OwnViews::Leave(Interpreter& interpreter) {
  this->Cameras_.clear();
  this->Views_.clear();
  const auto place = [&](const std::string& scene, const std::string& vantage,
                         const std::string& camera) -> std::optional<Place> {
    const auto set = CameraOf(interpreter, scene, vantage, camera);
    if (!set) {
      return std::nullopt;
    }
    return Place{set->projection(), RootMount(*interpreter.FindScene(scene), vantage, set->name())};
  };
  for (const auto& [scene, vantage] : this->Vantages_) {
    for (const std::string& camera : interpreter.FindScene(scene)->Vantage(vantage).CameraNames()) {
      if (const auto at = place(scene, vantage, camera)) {
        this->Cameras_[{{scene, vantage}, camera}] = *at;
      }
    }
  }
  for (const std::string& name : this->Viewports_) {
    const ViewportPlace& view = interpreter.GetState().viewports[name];
    if (const auto at = place(view.scene, view.vantage, view.camera)) {
      this->Views_[name] = *at;
    }
  }
}

std::vector<v1::Command> OwnViews::Commands(Interpreter& interpreter) const {
  std::vector<v1::Command> commands;
  for (const auto& [scene, names] : this->Names_) {
    names.PutLast(scene, commands);
  }
  this->Ledger_.Put(
      [&](const std::string& scene) {
        const auto found = interpreter.FindScene(scene.empty() ? DefaultScene : scene);
        return found ? found->Fragments().Names() : std::vector<std::string>();
      },
      commands);
  return commands;
}

void OwnViews::Enter(Interpreter& interpreter) {
  std::vector<v1::Command> commands = this->Commands(interpreter);
  this->Viewports_.clear();
  this->Pressed_.clear();
  this->Vantages_.clear();
  this->Names_.clear();
  this->Ledger_ = {};
  for (v1::Command& command : commands) {
    // Time is the simulation's, and so are scenes: one that is gone took its views along.
    if (!command.has_set_time() && interpreter.FindScene(SceneOf(command))) {
      this->MakeAgain(interpreter, command);
    }
  }
}

void OwnViews::MakeAgain(Interpreter& interpreter, v1::Command& command) {
  if (command.has_create_fragment() || command.has_remove_fragment()) {
    interpreter.Execute(command); // one that is hidden in a viewport, and not there any more
    return;
  }
  if (!this->Owns(command)) { // of a viewport or vantage that could not be made
    return;
  }
  if (!this->Execute(interpreter, command).has_error()) {
    return;
  }
  if (command.has_set_camera()) { // its frame is gone
    v1::SetCamera& set = *command.mutable_set_camera();
    const auto at = this->Cameras_.find({{SceneOf(command), set.vantage()}, set.name()});
    if (at != this->Cameras_.end()) {
      *set.mutable_mount() = at->second.mount;
      this->Execute(interpreter, command);
    }
  } else if (command.has_create_viewport()) { // what it looked through is gone
    v1::CreateViewport& create = *command.mutable_create_viewport();
    const auto at = this->Views_.find(create.name());
    if (at == this->Views_.end()) {
      return;
    }
    v1::Command camera;
    camera.set_scene(command.scene());
    camera.mutable_create_vantage()->set_name(create.name());
    this->Execute(interpreter, camera);
    camera.mutable_set_camera()->set_vantage(create.name());
    camera.mutable_set_camera()->set_name("camera");
    *camera.mutable_set_camera()->mutable_projection() = at->second.projection;
    *camera.mutable_set_camera()->mutable_mount() = at->second.mount;
    this->Execute(interpreter, camera);
    create.set_vantage(create.name());
    create.set_camera("camera");
    this->Execute(interpreter, command);
  }
}

} // namespace dspace::session
