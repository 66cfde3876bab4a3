#include <dspace/ledger/Ledger.h>

#include <map>
#include <string>

#include <dspace/Error.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/ledger/LedgerFrames.h>
#include <dspace/ledger/LedgerNames.h>
#include <dspace/ledger/LedgerObjects.h>
#include <dspace/ledger/LedgerSky.h>
#include <dspace/ledger/LedgerViewports.h>
#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/CommandTraits.h>
#include <dspace/state/MessageLog.h>
#include <dspace/state/State.h>
#include <dspace/state/Telemetry.h>

namespace dspace::session {
namespace {

struct LedgerScene {
  explicit LedgerScene(const v1::CreateScene& create) : names(create) {}
  LedgerNames names;
  LedgerFrames frames;
  LedgerObjects objects;
  LedgerSky sky;
  Telemetry telemetry;
  MessageLog messages;

  void Remove(LedgerId frame) {
    const LedgerFrames::Removed removed = this->frames.Remove(frame);
    this->objects.RemoveOn(removed);
    this->names.RemoveLightsOn(removed.frames);
    this->sky.RemoveOn(removed.frames);
  }

  bool AddSky(const v1::Command& command, const v1::Reply& reply) {
    for (const v1::Command& effect : LedgerSky::Effects(command, reply)) {
      if (effect.has_set_poses()) {
        this->frames.SetPoses(effect.set_poses());
      } else {
        this->names.Add(effect, {});
      }
    }
    return this->sky.Add(command);
  }

  bool AddFrames(const v1::Command& command, const v1::Reply& reply) {
    using C = v1::Command;
    switch (command.command_case()) {
    case C::kCreateFrame:
      this->frames.Create(command);
      return true;
    case C::kCreateFrames:
      this->frames.Create(command.create_frames());
      return true;
    case C::kRemoveFrame:
      this->Remove(command.remove_frame().frame());
      return true;
    case C::kReparentFrame:
      this->frames.Reparent(command.reparent_frame(), reply);
      return true;
    case C::kRenameFrame:
      this->frames.Rename(command.rename_frame());
      return true;
    case C::kSetPoses:
      this->frames.SetPoses(command.set_poses());
      return true;
    case C::kLoadRobot:
      this->frames.Load(command, reply.robot());
      this->objects.Load(command.load_robot().name(), command, reply.robot());
      return true;
    case C::kImportNodes:
      this->objects.Load(ModelKey(reply.nodes().base()), command,
                         this->frames.Import(command, reply.nodes()));
      for (const v1::SetLight& light : reply.nodes().light()) {
        v1::Command set;
        *set.mutable_set_light() = light;
        this->names.Add(set, {});
      }
      return true;
    case C::kPoseNodes:
      this->frames.PoseNodes(command.pose_nodes(), reply.poses());
      return true;
    case C::kRemoveRobot:
      this->Remove(this->frames.Robots().at(command.remove_robot().robot()).about.base());
      return true;
    case C::kSetJoints:
      this->frames.SetJoints(command.set_joints());
      return true;
    default:
      return false;
    }
  }

  bool AddObjects(const v1::Command& command, const v1::Reply& reply) {
    using C = v1::Command;
    switch (command.command_case()) {
    case C::kImportObject:
      this->objects.Create(command, command.import_object().object());
      return true;
    case C::kCreatePrimitive:
      this->objects.Create(command, command.create_primitive().object());
      return true;
    case C::kCreateText:
      this->objects.Create(command, command.create_text().object());
      return true;
    case C::kCreateMesh:
      this->objects.Create(command, command.create_mesh().object());
      return true;
    case C::kCreateDrawn:
      this->objects.Create(command, command.create_drawn().object());
      return true;
    case C::kCreateTrail:
      this->objects.Create(command, command.create_trail().object());
      return true;
    case C::kCreateTrajectory:
      this->objects.Create(command, command.create_trajectory().object());
      return true;
    case C::kCreateBody:
      this->objects.Create(command, command.create_body().object());
      return true;
    case C::kCreateStars:
      this->objects.Create(command, command.create_stars().object());
      return true;
    case C::kRemoveObject:
      this->objects.RemoveObject(command.remove_object().object());
      return true;
    case C::kOpenTerrain:
      this->objects.Open(command);
      return true;
    case C::kRemoveTerrain:
      this->objects.RemoveTerrain(command.remove_terrain().terrain());
      return true;
    default:
      return this->objects.Change(command, reply);
    }
  }

  // Telemetry, events and questions. Accepted commands contain the ids, numbers and times.
  bool AddMessages(const v1::Command& command) {
    using C = v1::Command;
    switch (command.command_case()) {
    case C::kCreateTelemetry:
      this->telemetry.Create(command.create_telemetry(), 0);
      return true;
    case C::kSetTelemetryLimits:
      this->telemetry.SetLimits(command.set_telemetry_limits());
      return true;
    case C::kSetTelemetry:
      this->telemetry.Set(command.set_telemetry(), this->names.Time());
      return true;
    case C::kSetTelemetryTexts:
      this->telemetry.SetTexts(command.set_telemetry_texts(), this->names.Time());
      return true;
    case C::kRemoveTelemetry:
      this->telemetry.Remove(command.remove_telemetry());
      return true;
    case C::kLogEvent: {
      v1::LogEvent event = command.log_event();
      this->messages.Log(event, this->names.Time());
      return true;
    }
    case C::kAskOperator: {
      v1::AskOperator question = command.ask_operator();
      this->messages.Ask(question, this->names.Time());
      return true;
    }
    case C::kCloseQuestion:
      this->messages.Close(command.close_question());
      return true;
    default:
      return false;
    }
  }

  void Put(const std::string& name, const State* state, std::vector<v1::Command>& out) const {
    this->names.PutFirst(name, out);
    const std::vector<std::string> fragments = this->names.Fragments();
    this->objects.PutOrphanedVisuals(name, fragments, out);
    this->frames.Put(name, fragments, out);
    this->objects.Put(name, this->frames, fragments, state, out);
    this->sky.Put(name, out);
    this->names.PutLast(name, out);
    this->sky.PutLast(name, out);
    this->telemetry.Put(name, out);
    this->messages.Put(
        name, [this](LedgerId frame) { return this->frames.Contains(frame); }, out);
  }
};

} // namespace

struct Ledger::Impl {
  const State* state = nullptr;
  std::map<std::string, LedgerScene> scenes;
  LedgerViewports viewports;
  std::vector<v1::Command> others; // of a later version, with unknown numbers
  // The reasons why scenes are unknown, by scene; "": data that belongs to no scene.
  std::map<std::string, std::string> faults;
  bool unnamed = false; // there was no memory to store the reason

  void Apply(const v1::Command& accepted, const v1::Reply& reply, const std::string& name);
  void Fail(const v1::Command& command, const std::string& name, const std::string& why);
  LedgerViewports::SceneView ViewOf(const std::string& scene) const {
    const auto found = this->scenes.find(scene.empty() ? DefaultScene() : scene);
    if (found == this->scenes.end()) {
      return {{}, [](const std::string&) { return 0u; }};
    }
    return {found->second.names.Fragments(),
            [&objects = found->second.objects](const std::string& terrain) {
              return objects.TerrainObject(terrain).value_or(0);
            }};
  }
  // The scene that the command changes; empty for viewports, which belong to the session.
  static std::string FaultKey(const v1::Command& command) {
    const CommandTraits* traits = CommandTraits::Find(command.command_case());
    const bool viewport = traits && traits->GetOwner() == CommandTraits::Owner::Viewport;
    return viewport ? std::string() : SceneName(command);
  }
};

Ledger::Ledger(const State* state) : Impl_(std::make_unique<Impl>()) {
  this->Impl_->state = state;
}
Ledger::~Ledger() = default;
Ledger::Ledger(Ledger&&) noexcept = default;
Ledger& Ledger::operator=(Ledger&&) noexcept = default;

void Ledger::Impl::Apply(const v1::Command& accepted, const v1::Reply& reply,
                         const std::string& name) {
  if (accepted.has_create_scene()) {
    this->scenes.erase(name);
    this->scenes.emplace(name, accepted.create_scene());
    this->faults.erase(name);
    return;
  }
  if (accepted.has_remove_scene()) {
    this->scenes.erase(name);
    this->faults.erase(name);
    return;
  }
  if (!CommandTraits::Find(accepted.command_case())) {
    this->others.push_back(accepted);
    return;
  }
  const auto terrain = [&](const std::string& of) {
    return this->ViewOf(this->viewports.SceneOf(accepted.style_terrain_in_viewport().viewport()))
        .terrain(of);
  };
  if (this->viewports.Add(accepted, terrain)) {
    return;
  }
  const auto found = this->scenes.find(name);
  if (found == this->scenes.end()) {
    throw Error(Error::Kind::Internal, "ledger", "there is no scene '" + name + "'");
  }
  if (!(found->second.AddSky(accepted, reply) || found->second.AddFrames(accepted, reply) ||
        found->second.AddObjects(accepted, reply) || found->second.AddMessages(accepted) ||
        found->second.names.Add(accepted, reply))) {
    throw Error(Error::Kind::Internal, "ledger",
                "its .proto states `kept: LEDGER`, but the ledger has no code for it");
  }
}

void Ledger::Impl::Fail(const v1::Command& command, const std::string& name,
                        const std::string& why) {
  this->unnamed = true;
  std::string text = "command " + CommandName(command) + " is missing from it (" + why +
                     "); there are no more snapshots" +
                     (name.empty() ? "" : " until scene '" + name + "' is removed");
  this->faults.emplace(name, std::move(text));
  this->unnamed = false;
}

void Ledger::Add(const v1::Command& accepted, const v1::Reply& reply) {
  v1::Command recorded;
  if (accepted.has_viewport_event()) {
    if (ToRecorded(accepted, reply, recorded)) {
      this->Add(recorded, reply);
    }
    return;
  }
  Impl& impl = *this->Impl_;
  const std::string& scene = SceneName(accepted);
  const std::string name = Impl::FaultKey(accepted);
  const bool resets = accepted.has_create_scene() || accepted.has_remove_scene();
  if (!impl.faults.empty() && !resets && impl.faults.count(name)) {
    return;
  }
  try {
    impl.Apply(accepted, reply, scene);
  } catch (const std::exception& error) {
    impl.Fail(accepted, name, error.what());
    throw Error(Error::Kind::Internal, "state", impl.faults.at(name));
  }
}

void Ledger::AddFailed(const v1::Command& accepted, const std::string& why) {
  this->Impl_->Fail(accepted, Impl::FaultKey(accepted), why);
}

std::vector<v1::Command> Ledger::Commands() const {
  if (this->Impl_->unnamed || !this->Impl_->faults.empty()) {
    throw Error(Error::Kind::Internal, "state",
                this->Impl_->unnamed ? "out of memory" : this->Impl_->faults.begin()->second);
  }
  std::vector<v1::Command> out;
  for (const auto& [name, scene] : this->Impl_->scenes) {
    scene.Put(name, this->Impl_->state, out);
  }
  this->Impl_->viewports.Put(
      [this](const std::string& scene) { return this->Impl_->ViewOf(scene); }, out);
  out.insert(out.end(), this->Impl_->others.begin(), this->Impl_->others.end());
  return out;
}

bool ToRecorded(const v1::Command& accepted, const v1::Reply& reply, v1::Command& recorded) {
  if (!accepted.has_viewport_event()) {
    recorded = accepted;
    return true;
  }
  recorded.Clear();
  if (!reply.has_camera()) {
    return false;
  }
  recorded.set_scene(reply.camera().scene());
  v1::SetCamera* set = recorded.mutable_set_camera();
  set->set_vantage(reply.camera().vantage());
  set->set_name(reply.camera().name());
  *set->mutable_projection() = reply.camera().projection();
  *set->mutable_mount() = reply.camera().mount();
  return true;
}

} // namespace dspace::session
