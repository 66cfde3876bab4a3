#include <dspace/link/watching/ViewerViews.h>

#include <algorithm>
#include <set>

#include <dspace/commands/scene/CameraTools.h>
#include <dspace/ledger/Ledger.h>
#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/CommandTraits.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

bool HasPrefix(const std::string& name) {
  return name.rfind(ViewerViews::Prefix, 0) == 0;
}

// The viewport that the command is about, if it is about one.
std::optional<std::string> ViewportOf(const v1::Command& command) {
  const CommandTraits* traits = CommandTraits::Find(command.command_case());
  const bool is = traits && traits->GetOwner() == CommandTraits::Owner::Viewport;
  return is ? std::optional<std::string>(traits->OwnerName(command)) : std::nullopt;
}

// Likewise for vantages.
std::optional<std::string> VantageOf(const v1::Command& command) {
  const CommandTraits* traits = CommandTraits::Find(command.command_case());
  const bool is = traits && traits->GetOwner() == CommandTraits::Owner::Vantage;
  return is ? std::optional<std::string>(traits->OwnerName(command)) : std::nullopt;
}

bool IsBelow(const FrameTree& frames, FrameId frame, FrameId top) {
  while (frame != NoFrame && frame != top) {
    frame = frames.Parent(frame);
  }
  return frame == top;
}

} // namespace

bool ViewerViews::OwnsVantage(const std::string& scene, const std::string& vantage) const {
  return this->Vantages_.count({scene, vantage}) != 0;
}

bool ViewerViews::Owns(const v1::Command& command) const {
  if (command.has_create_viewport()) {
    return command.create_viewport().name().empty() || HasPrefix(command.create_viewport().name());
  }
  if (command.has_create_vantage()) {
    return HasPrefix(command.create_vantage().name());
  }
  if (const auto viewport = ViewportOf(command)) {
    return this->Viewports_.count(*viewport) != 0;
  }
  const auto vantage = VantageOf(command);
  return vantage && this->OwnsVantage(SceneName(command), *vantage);
}

v1::Reply ViewerViews::Execute(Interpreter& interpreter, v1::Command& command) {
  if (command.has_viewport_event()) {
    return this->ExecuteEvent(interpreter, command);
  }
  if (command.has_create_viewport() && command.create_viewport().name().empty()) {
    std::string name;
    do {
      name = Prefix + std::to_string(++this->Last_);
    } while (interpreter.GetState().viewports.count(name));
    command.mutable_create_viewport()->set_name(name);
  }
  v1::Reply reply = interpreter.Execute(command);
  if (!reply.has_error()) {
    if (command.has_create_viewport()) {
      for (const auto& [scene, views] : this->Suspended_) { // of whatever scene
        this->Forget(scene, command.create_viewport().name());
      }
    } else if (command.has_create_vantage()) {
      this->Forget(SceneName(command), command.create_vantage().name());
    }
    this->Track(command, reply);
  }
  return reply;
}

// Discards a suspended view whose name is in use again.
void ViewerViews::Forget(const std::string& scene, const std::string& name) {
  const auto found = this->Suspended_.find(scene);
  if (found == this->Suspended_.end()) {
    return;
  }
  std::vector<v1::Command>& commands = found->second.commands;
  commands.erase(std::remove_if(commands.begin(), commands.end(),
                                [&](const v1::Command& each) {
                                  return ViewportOf(each) == name || VantageOf(each) == name;
                                }),
                 commands.end());
}

void ViewerViews::Track(const v1::Command& command, const v1::Reply& reply) {
  if (command.has_create_viewport()) {
    this->Viewports_.insert(command.create_viewport().name());
  } else if (command.has_remove_viewport()) {
    this->Viewports_.erase(command.remove_viewport().viewport());
    this->Pressed_.erase(command.remove_viewport().viewport());
  }
  if (this->Ledger_.Add(command)) {
    return;
  }
  const std::string scene = SceneName(command);
  if (command.has_create_vantage()) {
    this->Vantages_.insert({scene, command.create_vantage().name()});
  } else if (command.has_remove_vantage()) {
    this->Vantages_.erase({scene, command.remove_vantage().name()});
  }
  v1::CreateScene bare;
  bare.set_no_lights(true);
  this->Names_.emplace(scene, bare).first->second.Add(command, reply);
}

v1::Reply ViewerViews::ExecuteEvent(Interpreter& interpreter, v1::Command& command) {
  const v1::ViewportEvent& event = command.viewport_event();
  const std::string name = event.viewport();
  if (event.type() == v1::ViewportEvent::PRESS) {
    this->Pressed_.insert(name);
  } else if (event.type() == v1::ViewportEvent::RELEASE) {
    this->Pressed_.erase(name);
  }
  const ViewportState before = interpreter.GetState().viewports[name];
  const bool moves = event.type() == v1::ViewportEvent::WHEEL ||
                     event.type() == v1::ViewportEvent::KEY ||
                     event.type() == v1::ViewportEvent::DOUBLE_CLICK || this->Pressed_.count(name);
  bool given = false;
  bool made = false;
  if (moves && !this->OwnsVantage(before.scene, before.vantage)) {
    if (const auto camera = CameraOf(interpreter, before.scene, before.vantage, before.camera)) {
      made = !this->OwnsVantage(before.scene, name);
      given = this->GiveCamera(interpreter, name, *camera);
    }
  }
  const v1::Reply reply = interpreter.Execute(command);
  v1::Command recorded;
  if (ToRecorded(command, reply, recorded)) {
    this->Track(recorded, reply);
  } else if (given) { // nothing has moved: it uses the scene's camera again
    v1::Command back;
    back.mutable_set_viewport()->set_viewport(name);
    back.mutable_set_viewport()->set_vantage(before.vantage);
    back.mutable_set_viewport()->set_camera(before.camera);
    this->Execute(interpreter, back);
    if (made) {
      v1::Command remove;
      remove.set_scene(before.scene);
      remove.mutable_remove_vantage()->set_name(name);
      this->Execute(interpreter, remove);
    }
  }
  return reply;
}

// Gives the viewport a copy of the camera `to` in a vantage of its own name.
bool ViewerViews::GiveCamera(Interpreter& interpreter, const std::string& viewport,
                             const v1::SetCamera& to) {
  const std::string scene = interpreter.GetState().viewports[viewport].scene;
  v1::Command command;
  command.set_scene(scene);
  if (!this->OwnsVantage(scene, viewport)) {
    command.mutable_create_vantage()->set_name(viewport);
    if (this->Execute(interpreter, command).has_error()) {
      return false; // the simulation has one of this name
    }
  }
  *command.mutable_set_camera() = to;
  command.mutable_set_camera()->set_vantage(viewport);
  if (this->Execute(interpreter, command).has_error()) {
    return false;
  }
  command.mutable_set_viewport()->set_viewport(viewport);
  command.mutable_set_viewport()->set_vantage(viewport);
  command.mutable_set_viewport()->set_camera(to.name());
  return !this->Execute(interpreter, command).has_error();
}

// --- The simulation has priority ---------------------------------------------------------------

std::vector<std::string> ViewerViews::ViewportsIn(Interpreter& interpreter,
                                                  const std::string& scene) const {
  std::vector<std::string> names;
  for (const std::string& name : this->Viewports_) {
    const auto found = interpreter.GetState().viewports.find(name);
    if (found != interpreter.GetState().viewports.end() && found->second.scene == scene) {
      names.push_back(name);
    }
  }
  return names;
}

bool ViewerViews::RemoveConflicting(Interpreter& interpreter, const v1::Command& rejected) {
  const std::string scene = SceneName(rejected);
  if (!interpreter.FindScene(scene)) {
    return false;
  }
  if (rejected.has_remove_scene()) {
    this->BeforeSnapshot(interpreter);
    this->Suspend(interpreter, scene);
    const std::vector<std::string> names = this->ViewportsIn(interpreter, scene);
    for (const v1::Command& suspended : this->Suspended_[scene].commands) {
      if (suspended.has_create_viewport()) { // before a snapshot they are already gone
        v1::Command remove;
        remove.mutable_remove_viewport()->set_viewport(suspended.create_viewport().name());
        if (this->Execute(interpreter, remove).has_error()) {
          this->Track(remove, {});
        }
      }
    }
    this->Names_.erase(scene);
    this->Vantages_.erase(this->Vantages_.lower_bound({scene, ""}),
                          this->Vantages_.lower_bound({scene + '\0', ""}));
    return !names.empty();
  }
  if (rejected.has_remove_frame()) {
    return this->DetachCameras(interpreter, scene, rejected.remove_frame().frame());
  }
  if (rejected.has_remove_robot()) {
    v1::Command ask;
    ask.set_scene(scene);
    ask.mutable_describe_robot()->set_robot(rejected.remove_robot().robot());
    const v1::Reply reply = interpreter.Execute(ask);
    return reply.has_robot() && this->DetachCameras(interpreter, scene, reply.robot().base());
  }
  if (rejected.has_remove_vantage()) {
    return this->DetachViewports(interpreter, scene, rejected.remove_vantage().name(), "");
  }
  if (rejected.has_remove_fragment()) {
    return this->RemoveStyles(interpreter, scene, rejected.remove_fragment().name());
  }
  if (rejected.has_remove_camera()) {
    const std::string& vantage = rejected.remove_camera().vantage();
    return this->DetachViewports(interpreter, scene, vantage.empty() ? DefaultVantage : vantage,
                                 rejected.remove_camera().name());
  }
  return false;
}

// Moves cameras on a frame that will be removed to the root, at their present poses.
bool ViewerViews::DetachCameras(Interpreter& interpreter, const std::string& name,
                                std::uint64_t frame) {
  bool any = false;
  const std::shared_ptr<Scene> scene = interpreter.FindScene(name);
  for (const auto& [in, vantage] : this->Vantages_) {
    const std::vector<std::string> there =
        scene->VantageNames(); // none while a snapshot is applied
    if (in != name || std::find(there.begin(), there.end(), vantage) == there.end()) {
      continue;
    }
    for (const std::string& camera : scene->Vantage(vantage).CameraNames()) {
      const auto mount = scene->Vantage(vantage).GetCamera(camera).mount;
      if (IsBelow(scene->Frames(), mount.frame, frame) ||
          (mount.aim != NoFrame && IsBelow(scene->Frames(), mount.aim, frame))) {
        v1::Command command;
        command.set_scene(name);
        command.mutable_set_camera()->set_vantage(vantage);
        command.mutable_set_camera()->set_name(camera);
        *command.mutable_set_camera()->mutable_mount() = RootMount(*scene, vantage, camera);
        any = !this->Execute(interpreter, command).has_error() || any;
      }
    }
  }
  return any;
}

// Of viewports, those that have an element in a fragment that will be removed.
bool ViewerViews::RemoveStyles(Interpreter& interpreter, const std::string& scene,
                               const std::string& fragment) {
  bool any = false;
  for (v1::StyleTerrainInViewport& style : this->Ledger_.StylesIn(scene, fragment)) {
    style.clear_style();
    v1::Command command;
    command.set_scene(scene);
    *command.mutable_style_terrain_in_viewport() = style;
    any = !this->Execute(interpreter, command).has_error() || any;
  }
  return any;
}

// Gives viewports a copy of a camera that will be removed; empty: any camera.
bool ViewerViews::DetachViewports(Interpreter& interpreter, const std::string& scene,
                                  const std::string& vantage, const std::string& camera) {
  bool any = false;
  for (const std::string& name : this->ViewportsIn(interpreter, scene)) {
    const ViewportState place = interpreter.GetState().viewports[name];
    if (place.vantage == vantage && (camera.empty() || place.camera == camera)) {
      const auto copy = CameraOf(interpreter, scene, vantage, place.camera);
      any = (copy && this->GiveCamera(interpreter, name, *copy)) || any;
    }
  }
  return any;
}

// --- Snapshots ---------------------------------------------------------------------------------

std::optional<v1::SetCamera> ViewerViews::CameraOf(Interpreter& interpreter,
                                                   const std::string& scene,
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

v1::Mount ViewerViews::RootMount(const Scene& scene, const std::string& vantage,
                                 const std::string& camera) {
  v1::Mount mount;
  mount.set_frame(RootFrame);
  Put(CameraPoseIn(scene, vantage, camera, RootFrame), mount.mutable_pose());
  return mount;
}

void ViewerViews::BeforeSnapshot(Interpreter& interpreter) {
  const auto place = [&](const std::string& scene, const std::string& vantage,
                         const std::string& camera) -> std::optional<LastPose> {
    const auto set = CameraOf(interpreter, scene, vantage, camera);
    if (!set) {
      return std::nullopt;
    }
    const std::shared_ptr<Scene> at = interpreter.FindScene(scene);
    const FrameId frame = ToFrame(set->mount().frame());
    const v1::Mount& mount = set->mount();
    const FrameId aim =
        ToFrame(mount.has_pointing() ? mount.pointing().aim() : mount.chase().vertical().frame());
    const auto path = [&at](FrameId of) {
      return of == RootFrame ? std::string() : at->Frames().Path(of);
    };
    return LastPose{set->projection(), RootMount(*at, vantage, set->name()), path(frame),
                    path(aim)};
  };
  for (const auto& [scene, vantage] : this->Vantages_) {
    // A scene may have been removed and created again.
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
    const ViewportState& looks = view->second;
    if (const auto at = place(looks.scene, looks.vantage, looks.camera)) {
      this->Views_[name] = *at;
    }
  }
}

std::vector<v1::Command> ViewerViews::Commands(Interpreter& interpreter) const {
  std::vector<v1::Command> commands;
  for (const auto& [scene, names] : this->Names_) {
    names.PutLast(scene, commands);
  }
  this->Ledger_.Put(
      [&](const std::string& scene) {
        const State& state = interpreter.GetState();
        const auto found = state.scenes.find(scene.empty() ? DefaultScene() : scene);
        LedgerViewports::SceneView view{{}, [](const std::string&) { return 0u; }};
        if (found != state.scenes.end()) {
          view.fragments = found->second.scene->Fragments().Names();
          view.terrain = [&terrains = found->second.terrains](const std::string& terrain) {
            const auto of = terrains.find(terrain);
            return of == terrains.end() ? 0u : of->second->Object();
          };
        }
        return view;
      },
      commands);
  return commands;
}

// Stores the commands that recreate the views of a removed scene.
void ViewerViews::Suspend(Interpreter& interpreter, const std::string& scene) {
  Suspended& views = this->Suspended_[scene];
  for (v1::Command& command : this->Commands(interpreter)) {
    // Time and fragments belong to the simulation: a hidden fragment that was removed is no longer
    // hidden.
    if (SceneName(command) == scene && !command.has_set_time() && !command.has_create_fragment() &&
        !command.has_remove_fragment()) {
      views.commands.push_back(std::move(command));
    }
  }
  views.time_s.reset();
}

void ViewerViews::AfterSnapshot(Interpreter& interpreter) {
  std::set<std::string> scenes;
  for (const v1::Command& command : this->Commands(interpreter)) {
    scenes.insert(SceneName(command));
  }
  for (const std::string& scene : scenes) {
    this->Suspend(interpreter, scene);
  }
  this->Viewports_.clear();
  this->Pressed_.clear();
  this->Vantages_.clear();
  this->Names_.clear();
  this->Ledger_ = {};
}

void ViewerViews::Resume(Interpreter& interpreter, bool alone) {
  for (auto it = this->Suspended_.begin(); it != this->Suspended_.end();) {
    Suspended& views = it->second;
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
      ++it; // it may still be under construction
      continue;
    }
    std::vector<v1::Command> commands = std::move(views.commands);
    it = this->Suspended_.erase(it);
    for (v1::Command& command : commands) {
      this->Restore(interpreter, command);
    }
  }
}

bool ViewerViews::IsReady(const Scene& scene, const Suspended& views) const {
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

void ViewerViews::Restore(Interpreter& interpreter, v1::Command& command) {
  if (!this->Owns(command)) { // of a viewport or vantage that could not be created
    return;
  }
  if (command.has_set_camera() && command.set_camera().has_mount()) {
    v1::SetCamera& set = *command.mutable_set_camera();
    const auto at = this->Cameras_.find({{SceneName(command), set.vantage()}, set.name()});
    if (at != this->Cameras_.end() && !(at->second.path.empty() && at->second.aim.empty())) {
      const FrameTree& frames = interpreter.FindScene(SceneName(command))->Frames();
      const auto find = [&frames](const std::string& path) { // ids may have changed
        return path.empty() ? RootFrame : frames.Find(path);
      };
      const FrameId frame = find(at->second.path);
      const FrameId aim = find(at->second.aim);
      if (frame == NoFrame || aim == NoFrame) {
        *set.mutable_mount() = at->second.mount;
      } else {
        set.mutable_mount()->set_frame(frame);
        if (set.mount().has_pointing()) {
          set.mutable_mount()->mutable_pointing()->set_aim(aim);
        }
        if (set.mount().chase().has_vertical()) {
          set.mutable_mount()->mutable_chase()->mutable_vertical()->set_frame(aim);
        }
      }
    }
  }
  if (!this->Execute(interpreter, command).has_error()) {
    return;
  }
  if (command.has_create_viewport()) { // its camera was removed
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
