#include "vtkDspaceSession.h"

#include <map>
#include <stdexcept>
#include <vector>

#include <dspace/commands/viewports/ViewportCommands.h>
#include <dspace/messages/ErrorReply.h>
#include <dspace/raster/ConfinedDrivers.h>
#include <dspace/recording/RecordingWriter.h>

#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDspaceRecordedFiles.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceScene.h"
#include "vtkDspaceViewport.h"
#include "vtkFloatArray.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedIntArray.h"

vtkStandardNewMacro(vtkDspaceSession);

namespace {

template<class Array, class T>
vtkSmartPointer<vtkDataArray> ToArray(const char* name, const std::vector<T>& values,
                                      int channels) {
  if (values.empty()) {
    return nullptr;
  }
  auto array = vtkSmartPointer<Array>::New();
  array->SetName(name);
  array->SetNumberOfComponents(channels);
  array->SetNumberOfTuples(vtkIdType(values.size()) / channels);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

} // namespace

struct vtkDspaceSession::Internals {
  // In this order: viewports are destroyed before the scenes that they show.
  dspace::session::Interpreter interpreter;
  std::map<std::string, vtkSmartPointer<vtkDspaceScene>> scenes;
  dspace::session::ViewportCommands viewports;
  dspace::v1::Command command;
  std::map<std::string, vtkSmartPointer<vtkDataArray>> planes;
  dspace::session::Ledger ledger{&interpreter.GetState()};
  double time_s = 0.0; // the last one set, of any scene
  std::unique_ptr<dspace::session::RecordingWriter> recording;
  dspace::session::RecordingCounts counts; // of the last one

  // Records the command even if the ledger fails, which only snapshots depend on. An exception
  // becomes a warning in the reply; another listener sends the command to a server's viewers.
  void OnCommand(const dspace::v1::Command& accepted, const dspace::v1::Reply& reply) {
    std::string failure;
    try {
      this->ledger.Add(accepted, reply);
    } catch (const std::exception& error) {
      failure = error.what();
    }
    if (accepted.has_set_time()) {
      this->time_s = accepted.set_time().time_s();
    }
    this->AddToRecording(accepted, reply, failure);
    if (!failure.empty()) {
      throw std::runtime_error(failure);
    }
  }

  void AddToRecording(const dspace::v1::Command& accepted, const dspace::v1::Reply& reply,
                      std::string& failure) {
    if (!this->recording) {
      return;
    }
    const std::string stopped = this->recording->Add(accepted, reply, this->ledger);
    if (!stopped.empty()) {
      failure += (failure.empty() ? "" : "; ") + stopped +
                 "; recording has stopped, what was written stays";
    }
  }

  void TakePlanes() {
    dspace::Capture& capture = this->viewports.LastCapture();
    this->planes.clear();
    this->planes["color"] = ToArray<vtkUnsignedCharArray>("color", capture.color, 4);
    this->planes["depth"] = ToArray<vtkFloatArray>("depth", capture.depth, 1);
    this->planes["label"] = ToArray<vtkUnsignedIntArray>("label", capture.label, 1);
    capture = {};
  }
};

vtkDspaceSession::vtkDspaceSession() : Impl(new Internals) {
  dspace::session::Registry& commands = this->Impl->interpreter.Commands();
  this->Impl->viewports.AddTo(commands);
  dspace::session::AddTextCommands(commands);
  this->Impl->interpreter.AddListener(
      [this](const dspace::v1::Command& command, const dspace::v1::Reply& reply) {
        this->Impl->OnCommand(command, reply);
      });
}

vtkDspaceSession::~vtkDspaceSession() = default;

std::string vtkDspaceSession::Execute(const std::string& bytes) {
  dspace::v1::Reply reply;
  dspace::v1::Command& command = this->Impl->command;
  if (!command.ParseFromString(bytes)) {
    command.Clear();
    reply = dspace::session::NotACommand();
  } else {
    reply = this->Impl->interpreter.Execute(command);
  }
  if (reply.has_capture()) {
    this->Impl->TakePlanes();
  }
  return reply.SerializeAsString();
}

std::string vtkDspaceSession::GetCommand() {
  return this->Impl->command.SerializeAsString();
}

vtkDataArray* vtkDspaceSession::GetPlane(const std::string& name) {
  const auto found = this->Impl->planes.find(name);
  return found == this->Impl->planes.end() ? nullptr : found->second.Get();
}

vtkDspaceScene* vtkDspaceSession::GetScene(const std::string& name) {
  const std::shared_ptr<dspace::Scene> scene = this->Impl->interpreter.FindScene(name);
  if (!scene) {
    this->Impl->scenes.erase(name);
    return nullptr;
  }
  vtkSmartPointer<vtkDspaceScene>& mirror = this->Impl->scenes[name];
  if (!mirror || !mirror->Mirrors(*scene)) {
    mirror = vtkSmartPointer<vtkDspaceScene>::New();
    mirror->SetScene(scene);
  }
  return mirror;
}

vtkDspaceViewport* vtkDspaceSession::GetViewport(const std::string& name) {
  return this->Impl->viewports.Find(name);
}

std::string vtkDspaceSession::RunInViewport(const std::string& name) {
  vtkDspaceViewport* viewport = this->GetViewport(name);
  if (!viewport) {
    return "viewport '" + name + "': there is no such viewport";
  }
  try {
    viewport->Run([this](vtkRenderWindow*) { this->InvokeEvent(vtkCommand::UserEvent); });
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

void vtkDspaceSession::SetRenderContext(vtkDspaceRenderContext* context) {
  this->Impl->viewports.SetRenderContext(context);
}

vtkDspaceRenderContext* vtkDspaceSession::GetRenderContext() {
  return this->Impl->viewports.GetRenderContext();
}

std::string vtkDspaceSession::Record(const std::string& path, double commitEvery, bool pack) {
  if (this->Impl->recording) {
    return "recording '" + path + "': the session records into '" + this->Impl->recording->Path() +
           "'; accepted: one recording at a time";
  }
  try {
    dspace::session::RecordingOptions options;
    options.commitEvery_s = commitEvery;
    options.pack = pack;
    this->Impl->recording = std::make_unique<dspace::session::RecordingWriter>(
        path, this->Impl->ledger, this->Impl->time_s, options,
        &this->Impl->interpreter.GetState().files);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

void vtkDspaceSession::TakeRecording(vtkDspaceSession* other) {
  this->Impl->recording = std::move(other->Impl->recording);
  this->Impl->counts = other->Impl->counts;
  if (this->Impl->recording) {
    this->Impl->recording->Resync(this->Impl->ledger, this->Impl->time_s,
                                  &this->Impl->interpreter.GetState().files);
  }
}

std::string vtkDspaceSession::StopRecording() {
  std::string failure = this->FlushRecording();
  if (this->Impl->recording) {
    this->Impl->counts = this->Impl->recording->Counts();
  }
  this->Impl->recording.reset();
  return failure;
}

std::string vtkDspaceSession::FlushRecording() {
  return this->Impl->recording ? this->Impl->recording->Flush() : std::string();
}

const dspace::session::RecordingCounts& vtkDspaceSession::GetRecordingCounts() {
  if (this->Impl->recording) {
    this->Impl->counts = this->Impl->recording->Counts();
  }
  return this->Impl->counts;
}

unsigned long long vtkDspaceSession::GetRecordingCount(const std::string& name) {
  return dspace::session::CountOf(this->GetRecordingCounts(), name);
}

std::string vtkDspaceSession::GetRecordingPath() {
  return this->Impl->recording ? this->Impl->recording->Path() : std::string();
}

std::string vtkDspaceSession::GetRecordingFailure() {
  return this->GetRecordingCounts().failure;
}

std::string vtkDspaceSession::GetRecordingMissing() {
  std::string lines;
  for (const std::string& path : this->GetRecordingCounts().missing) {
    lines += (lines.empty() ? "" : "\n") + path;
  }
  return lines;
}

std::string vtkDspaceSession::Replay(const std::string& bytes, vtkDspaceRecordedFiles* files) {
  const dspace::FilesGuard::Look look = files ? files->GetLook() : dspace::FilesGuard::Look();
  if (!look) {
    dspace::v1::Reply reply;
    reply.mutable_error()->set_kind(dspace::v1::Error::INVALID_ARGUMENT);
    reply.mutable_error()->set_object("recording");
    reply.mutable_error()->set_message("recording: its files are closed; accepted: open ones");
    return reply.SerializeAsString();
  }
  const dspace::FilesGuard guard(look);
  dspace::v1::Command command;
  const auto* entry = command.ParseFromString(bytes)
                          ? this->Impl->interpreter.Commands().Find(command.command_case())
                          : nullptr;
  if (entry && entry->effect != dspace::session::Effect::Change) {
    const std::string name = dspace::session::CommandName(command);
    return dspace::session::ErrorReply(dspace::v1::Error::CORRUPT, "command " + name,
                                       "command " + name +
                                           ": it changes nothing; recordings contain only changes")
        .SerializeAsString();
  }
  return this->Execute(bytes);
}

void vtkDspaceSession::ConfineProcess() {
  const dspace::ConfinedDrivers confined;
}

std::string vtkDspaceSession::AddFailed(const dspace::v1::Command& accepted,
                                        const std::string& why) {
  this->Impl->ledger.AddFailed(accepted, why);
  std::string failure;
  this->Impl->AddToRecording(accepted, dspace::v1::Reply(), failure);
  return failure;
}

const dspace::session::Ledger& vtkDspaceSession::GetLedger() {
  return this->Impl->ledger;
}

void vtkDspaceSession::EndBackgroundWork() {
  for (auto& [name, scene] : this->Impl->interpreter.GetState().scenes) {
    for (auto& [terrainName, terrain] : scene.terrains) {
      terrain->EndBackgroundWork();
    }
  }
}

dspace::session::Interpreter& vtkDspaceSession::GetInterpreter() {
  return this->Impl->interpreter;
}

void vtkDspaceSession::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Scenes: " << this->Impl->interpreter.GetState().scenes.size() << "\n"
     << indent << "Viewports: " << this->Impl->interpreter.GetState().viewports.size() << "\n";
}
