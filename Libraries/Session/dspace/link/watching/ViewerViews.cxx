#include <dspace/link/watching/ViewerViews.h>

#include <algorithm>

#include <dspace/ledger/Ledger.h>
#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/CommandTraits.h>

namespace dspace::session {
namespace {

bool Begins(const std::string& name) {
  return name.rfind(OwnViews::Prefix, 0) == 0;
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

bool OwnViews::OwnsVantage(const std::string& scene, const std::string& vantage) const {
  return this->Vantages_.count({scene, vantage}) != 0;
}

bool OwnViews::Owns(const v1::Command& command) const {
  if (command.has_create_viewport()) {
    return command.create_viewport().name().empty() || Begins(command.create_viewport().name());
  }
  if (command.has_create_vantage()) {
    return Begins(command.create_vantage().name());
  }
  if (const auto viewport = ViewportOf(command)) {
    return this->Viewports_.count(*viewport) != 0;
  }
  const auto vantage = VantageOf(command);
  return vantage && this->OwnsVantage(SceneName(command), *vantage);
}

v1::Reply OwnViews::Execute(Interpreter& interpreter, v1::Command& command) {
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
      for (const auto& [scene, views] : this->Sleeping_) { // of whatever scene
        this->Forget(scene, command.create_viewport().name());
      }
    } else if (command.has_create_vantage()) {
      this->Forget(SceneName(command), command.create_vantage().name());
    }
    this->Keep(command, reply);
  }
  return reply;
}

// Another one has taken the name of one that sleeps.
void OwnViews::Forget(const std::string& scene, const std::string& name) {
  const auto found = this->Sleeping_.find(scene);
  if (found == this->Sleeping_.end()) {
    return;
  }
  std::vector<v1::Command>& commands = found->second.commands;
  commands.erase(std::remove_if(commands.begin(), commands.end(),
                                [&](const v1::Command& each) {
                                  return ViewportOf(each) == name || VantageOf(each) == name;
                                }),
                 commands.end());
}

void OwnViews::Keep(const v1::Command& command, const v1::Reply& reply) {
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

v1::Reply OwnViews::ExecuteEvent(Interpreter& interpreter, v1::Command& command) {
  const v1::ViewportEvent& event = command.viewport_event();
  const std::string name = event.viewport();
  if (event.type() == v1::ViewportEvent::PRESS) {
    this->Pressed_.insert(name);
  } else if (event.type() == v1::ViewportEvent::RELEASE) {
    this->Pressed_.erase(name);
  }
  const ViewportPlace before = interpreter.GetState().viewports[name];
  const bool moves = event.type() == v1::ViewportEvent::WHEEL ||
                     event.type() == v1::ViewportEvent::KEY || this->Pressed_.count(name);
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
    this->Keep(recorded, reply);
  } else if (given) { // nothing has moved: it goes on looking through the scene's camera
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

// The viewport looks through a camera like `to`, in a vantage of its own name.
bool OwnViews::GiveCamera(Interpreter& interpreter, const std::string& viewport,
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

// --- What the simulation does goes before ------------------------------------------------------

std::vector<std::string> OwnViews::ViewportsIn(Interpreter& interpreter,
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

bool OwnViews::MakeRoom(Interpreter& interpreter, const v1::Command& refused) {
  const std::string scene = SceneName(refused);
  if (!interpreter.FindScene(scene)) {
    return false;
  }
  if (refused.has_remove_scene()) {
    this->Leave(interpreter);
    this->Sleep(interpreter, scene);
    const std::vector<std::string> names = this->ViewportsIn(interpreter, scene);
    for (const std::string& name : names) {
      v1::Command remove;
      remove.mutable_remove_viewport()->set_viewport(name);
      this->Execute(interpreter, remove);
    }
    this->Names_.erase(scene);
    this->Vantages_.erase(this->Vantages_.lower_bound({scene, ""}),
                          this->Vantages_.lower_bound({scene + '\0', ""}));
    return !names.empty();
  }
  if (refused.has_remove_frame()) {
    return this->FreeCameras(interpreter, scene, refused.remove_frame().frame());
  }
  if (refused.has_remove_robot()) {
    v1::Command ask;
    ask.set_scene(scene);
    ask.mutable_describe_robot()->set_robot(refused.remove_robot().robot());
    const v1::Reply reply = interpreter.Execute(ask);
    return reply.has_robot() && this->FreeCameras(interpreter, scene, reply.robot().base());
  }
  if (refused.has_remove_vantage()) {
    return this->FreeViewports(interpreter, scene, refused.remove_vantage().name(), "");
  }
  if (refused.has_remove_camera()) {
    const std::string& vantage = refused.remove_camera().vantage();
    return this->FreeViewports(interpreter, scene, vantage.empty() ? DefaultVantage : vantage,
                               refused.remove_camera().name());
  }
  return false;
}

// Cameras on a frame that is to go stay where they are, in the root.
bool OwnViews::FreeCameras(Interpreter& interpreter, const std::string& name, std::uint64_t frame) {
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
      if (IsBelow(scene->Frames(), mount.frame, frame)) {
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

// Viewports that look through a camera that is to go look through a copy; empty: any camera.
bool OwnViews::FreeViewports(Interpreter& interpreter, const std::string& scene,
                             const std::string& vantage, const std::string& camera) {
  bool any = false;
  for (const std::string& name : this->ViewportsIn(interpreter, scene)) {
    const ViewportPlace place = interpreter.GetState().viewports[name];
    if (place.vantage == vantage && (camera.empty() || place.camera == camera)) {
      const auto copy = CameraOf(interpreter, scene, vantage, place.camera);
      any = (copy && this->GiveCamera(interpreter, name, *copy)) || any;
    }
  }
  return any;
}

} // namespace dspace::session
