// Views of one's own when a snapshot takes the place of what they look at.
#include <dspace/link/watching/ViewerViews.h>

#include <algorithm>
#include <set>

#include <dspace/commands/scene/CameraTools.h>
#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
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
  v1::Mount mount;
  mount.set_frame(RootFrame);
  Put(CameraPoseIn(scene, vantage, camera, RootFrame), mount.mutable_pose());
  return mount;
}

void OwnViews::Leave(Interpreter& interpreter) {
  const auto place = [&](const std::string& scene, const std::string& vantage,
                         const std::string& camera) -> std::optional<Place> {
    const auto set = CameraOf(interpreter, scene, vantage, camera);
    if (!set) {
      return std::nullopt;
    }
    const std::shared_ptr<Scene> at = interpreter.FindScene(scene);
    const FrameId frame = ToFrame(set->mount().frame());
    return Place{set->projection(), RootMount(*at, vantage, set->name()),
                 frame == RootFrame ? std::string() : at->Frames().Path(frame)};
  };
  for (const auto& [scene, vantage] : this->Vantages_) {
    // A scene may be gone, and another one of its name have come.
    const std::shared_ptr<Scene> at = interpreter.FindScene(scene);
    const std::vector<std::string> there = at ? at->VantageNames() : std::vector<std::string>();
    if (std::find(there.begin(), there.end(), vantage) == there.end()) {
      continue;
    }
    for (const std::string& camera : at->Vantage(vantage).CameraNames()) {
      if (const auto stands = place(scene, vantage, camera)) {
        this->Cameras_[{{scene, vantage}, camera}] = *stands;
      }
    }
  }
  for (const std::string& name : this->Viewports_) {
    const auto view = interpreter.GetState().viewports.find(name);
    if (view == interpreter.GetState().viewports.end()) {
      continue;
    }
    const ViewportPlace& looks = view->second;
    if (const auto at = place(looks.scene, looks.vantage, looks.camera)) {
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
        const auto found = interpreter.FindScene(scene.empty() ? DefaultScene() : scene);
        return found ? found->Fragments().Names() : std::vector<std::string>();
      },
      commands);
  return commands;
}

// The scene goes, or has gone: keeps what makes its views.
void OwnViews::Sleep(Interpreter& interpreter, const std::string& scene) {
  Sleeping& views = this->Sleeping_[scene];
  for (v1::Command& command : this->Commands(interpreter)) {
    // Time is the simulation's, and so are fragments: one that is hidden and gone is hidden no
    // more.
    if (SceneName(command) == scene && !command.has_set_time() && !command.has_create_fragment() &&
        !command.has_remove_fragment()) {
      views.commands.push_back(std::move(command));
    }
  }
  views.time_s.reset();
}

void OwnViews::Enter(Interpreter& interpreter) {
  std::set<std::string> scenes;
  for (const v1::Command& command : this->Commands(interpreter)) {
    scenes.insert(SceneName(command));
  }
  for (const std::string& scene : scenes) {
    this->Sleep(interpreter, scene);
  }
  this->Viewports_.clear();
  this->Pressed_.clear();
  this->Vantages_.clear();
  this->Names_.clear();
  this->Ledger_ = {};
}

void OwnViews::Wake(Interpreter& interpreter, bool alone) {
  for (auto it = this->Sleeping_.begin(); it != this->Sleeping_.end();) {
    Sleeping& views = it->second;
    const std::shared_ptr<Scene> scene = interpreter.FindScene(it->first);
    if (!scene) {
      views.time_s.reset();
      ++it;
      continue;
    }
    if (!views.time_s) {
      views.time_s = scene->Time();
    }
    if (!alone && scene->Time() == *views.time_s && !this->IsReady(*scene, views)) {
      ++it; // it may be about to be built
      continue;
    }
    std::vector<v1::Command> commands = std::move(views.commands);
    it = this->Sleeping_.erase(it);
    for (v1::Command& command : commands) {
      this->MakeAgain(interpreter, command);
    }
  }
}

bool OwnViews::IsReady(const Scene& scene, const Sleeping& views) const {
  const std::vector<std::string> vantages = scene.VantageNames();
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const v1::Command& command : views.commands) {
    if (command.has_set_camera()) {
      const v1::SetCamera& set = command.set_camera();
      const auto at = this->Cameras_.find({{SceneName(command), set.vantage()}, set.name()});
      if (at != this->Cameras_.end() && !at->second.path.empty() &&
          scene.Frames().Find(at->second.path) == NoFrame) {
        return false;
      }
    } else if (command.has_create_viewport()) {
      const v1::CreateViewport& create = command.create_viewport();
      const std::string vantage = create.vantage().empty() ? DefaultVantage : create.vantage();
      if (vantage.rfind(Prefix, 0) == 0) {
        continue;
      }
      if (!has(vantages, vantage)) {
        return false;
      }
      const std::vector<std::string> cameras = scene.Vantage(vantage).CameraNames();
      if (create.camera().empty() ? cameras.empty() : !has(cameras, create.camera())) {
        return false;
      }
    }
  }
  return true;
}

void OwnViews::MakeAgain(Interpreter& interpreter, v1::Command& command) {
  if (!this->Owns(command)) { // of a viewport or vantage that could not be made
    return;
  }
  if (command.has_set_camera() && command.set_camera().has_mount()) {
    v1::SetCamera& set = *command.mutable_set_camera();
    const auto at = this->Cameras_.find({{SceneName(command), set.vantage()}, set.name()});
    if (at != this->Cameras_.end() && !at->second.path.empty()) {
      const FrameTree& frames = interpreter.FindScene(SceneName(command))->Frames();
      const FrameId frame = frames.Find(at->second.path); // ids may be others than they were
      if (frame == NoFrame) {
        *set.mutable_mount() = at->second.mount;
      } else {
        set.mutable_mount()->set_frame(frame);
      }
    }
  }
  if (!this->Execute(interpreter, command).has_error()) {
    return;
  }
  if (command.has_create_viewport()) { // what it looked through is gone
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
