#include <dspace/interpreter/Interpreter.h>

#include <new>

#include <google/protobuf/unknown_field_set.h>

#include <dspace/FileText.h>
#include <dspace/ephemeris/Fallbacks.h>
#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/ErrorReply.h>
#include <dspace/messages/TextFields.h>
#include <dspace/state/Works.h>

namespace dspace::session {
namespace {

class Nesting {
public:
  explicit Nesting(int& depth) : Depth_(++depth) {}
  ~Nesting() { --this->Depth_; }
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;

private:
  int& Depth_;
};

} // namespace

std::string CommandName(const v1::Command& command) {
  const google::protobuf::FieldDescriptor* field =
      v1::Command::descriptor()->FindFieldByNumber(command.command_case());
  if (command.command_case() != v1::Command::COMMAND_NOT_SET && field) {
    return field->name();
  }
  const auto& unknown = command.GetReflection()->GetUnknownFields(command);
  return unknown.empty() ? "none" : "number " + std::to_string(unknown.field(0).number());
}

Interpreter::Interpreter() {
  this->State_.works = std::make_shared<Works>();
  AddSceneCommands(this->Registry_);
  AddFrameCommands(this->Registry_);
  AddObjectCommands(this->Registry_);
  AddObjectRequests(this->Registry_);
  AddPrimitiveCommands(this->Registry_);
  AddMeshCommands(this->Registry_);
  AddDrawnCommands(this->Registry_);
  AddBodyCommands(this->Registry_);
  AddStarCommands(this->Registry_);
  AddTrailCommands(this->Registry_);
  AddTrajectoryCommands(this->Registry_);
  AddRobotCommands(this->Registry_);
  AddNodeCommands(this->Registry_);
  AddFragmentCommands(this->Registry_);
  AddSunCommands(this->Registry_);
  AddSkyCommands(this->Registry_);
  AddCameraCommands(this->Registry_);
  AddTerrainCommands(this->Registry_);
  AddSightRequests(this->Registry_);
  AddLitAreaRequest(this->Registry_);
  AddRangeRequests(this->Registry_);
  AddMapRequests(this->Registry_);
  AddWorkRequests(this->Registry_);
  AddLensRequests(this->Registry_);
  AddExportCommands(this->Registry_);
  AddTelemetryCommands(this->Registry_);
  AddMessageCommands(this->Registry_);
}

v1::Reply Interpreter::Execute(v1::Command& command) {
  if (!this->Around_) {
    return this->Attempt(command);
  }
  v1::Reply reply;
  this->Around_(reply, [&] { reply = this->Attempt(command); });
  return reply;
}

v1::Reply Interpreter::Attempt(v1::Command& command) {
  v1::Reply reply;
  FrameEventLog& events = this->State_.frameEvents;
  const std::size_t before = events.Close();
  try {
    const Nesting nesting(this->Depth_);
    this->Run(command, reply);
  } catch (const Error& error) {
    reply = ErrorReply(FromKind(error.GetKind()), error.GetObjectName(), error.what());
  } catch (const std::bad_alloc&) {
    reply = ErrorReply(v1::Error::RESOURCE, "command " + CommandName(command), "out of memory");
  } catch (const std::exception& error) {
    reply = ErrorReply(v1::Error::INTERNAL, "command " + CommandName(command), error.what());
  }
  if (reply.has_error()) {
    events.DiscardSince(before);
  } else if (this->Depth_ == 0) {
    events.MoveTo(reply); // events that listeners caused
  }
  MakeTextUtf8(reply);
  return reply;
}

void Interpreter::Run(v1::Command& command, v1::Reply& reply) {
  const Registry::Entry* entry = this->Registry_.Find(command.command_case());
  if (!entry) {
    throw Error(Error::Kind::Unsupported, "command " + CommandName(command),
                "this session does not support the command");
  }
  if (FindInvalidText(command)) {
    RequireUtf8(command, "command " + CommandName(command));
  }
  const std::string name = SceneName(command);
  SceneState* scene = entry->needs == Needs::Scene ? &this->State_.FindScene(name) : nullptr;
  RequireLimits(command);
  const std::shared_ptr<const KernelSet> kernels =
      scene ? scene->sky.kernels : SkyMotions::Standard(); // the command may remove the scene
  const FilesReadScope read;
  const FallbackScope fallbacks;
  const ForeignTextScope foreign;
  entry->run(Context{this->State_, scene, name, reply}, command);
  this->State_.files.Note(command, read.Files());
  for (std::string& warning : foreign.Warnings()) {
    reply.add_warning(std::move(warning));
  }
  for (std::string& warning : fallbacks.Warnings(kernels->Scales())) {
    reply.add_warning(std::move(warning));
  }
  if (this->Depth_ == 1) {
    this->State_.frameEvents.MoveTo(reply); // before listeners are notified: they forward the reply
  }
  if (entry->effect == Effect::Change && !this->Listeners_.empty()) {
    MakeTextUtf8(command); // listeners send and record both
    MakeTextUtf8(reply);
    this->NotifyListeners(command, reply);
  }
}

void Interpreter::NotifyListeners(const v1::Command& command, v1::Reply& reply) {
  const auto listeners = this->Listeners_; // a listener may add or remove listeners
  for (const auto& [token, listener] : listeners) {
    try {
      listener(command, reply);
    } catch (const std::exception& error) {
      reply.add_warning(std::string("the command was executed, but a listener failed: ") +
                        error.what());
    }
  }
}

Interpreter::Token Interpreter::AddListener(Listener listener) {
  this->Listeners_.emplace_back(++this->LastToken_, std::move(listener));
  return this->LastToken_;
}

bool Interpreter::RemoveListener(Token token) {
  for (auto it = this->Listeners_.begin(); it != this->Listeners_.end(); ++it) {
    if (it->first == token) {
      this->Listeners_.erase(it);
      return true;
    }
  }
  return false;
}

std::shared_ptr<Scene> Interpreter::FindScene(const std::string& name) const {
  const auto found = this->State_.scenes.find(name);
  return found == this->State_.scenes.end() ? nullptr : found->second.scene;
}

} // namespace dspace::session
