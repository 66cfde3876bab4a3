#include "vtkDspaceSession.h"

#include <algorithm>
#include <functional>
#include <map>
#include <stdexcept>
#include <vector>

#include <dlfcn.h>

#include <dspace/Budgets.h>
#include <dspace/HomeProcess.h>
#include <dspace/Utf8.h>
#include <dspace/commands/viewports/DrawerPlugIn.h>
#include <dspace/commands/viewports/MeasuringPictures.h>
#include <dspace/commands/viewports/ViewportCommands.h>
#include <dspace/import/worker/ModelImport.h>
#include <dspace/messages/ErrorReply.h>
#include <dspace/messages/MeshMessages.h>
#include <dspace/messages/MessageElements.h>
#include <dspace/messages/TextFields.h>
#include <dspace/raster/ConfinedDrivers.h>
#include <dspace/recording/RecordingWriter.h>
#include <dspace/render/messages/VtkErrorTrap.h>
#include <dspace/render/messages/VtkMessages.h>
#include <dspace/render/props/VtkPropGeometry.h>

#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDspaceRecordedFiles.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceScene.h"
#include "vtkDspaceViewport.h"
#include "vtkFloatArray.h"
#include "vtkObjectFactory.h"
#include "vtkProp3D.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedIntArray.h"
#include "vtkWeakPointer.h"

#include "VtkShaderCode.h"

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
  dspace::HomeProcess home;
  dspace::VtkMessages messages; // what VTK reports during any command
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
  vtkSmartPointer<vtkProp3D> offered;      // for the next CreateDrawn

  // Executes a command. What VTK reports meanwhile and no one else has put into the reply becomes a
  // warning: the command may have changed the scene, so that it is too late for an error.
  void Watch(dspace::v1::Reply& reply, const std::function<void()>& run) {
    std::string error;
    {
      const dspace::VtkErrorTrap trap(this->messages);
      run();
      error = trap.FirstError();
      error.erase(error.find_last_not_of(" \n\r\t") + 1);
    }
    const auto add = [&reply](const std::string& text, const std::string& message) {
      const auto& all = reply.warning();
      const bool known = std::any_of(all.begin(), all.end(), [&](const std::string& warning) {
        return warning.find(text) != std::string::npos;
      });
      if (!known) {
        reply.add_warning(message + text);
      }
    };
    if (!error.empty() && !reply.has_error()) {
      add(dspace::ToUtf8(error), "the command was executed, but VTK reported an error: ");
    }
    for (const std::string& warning : this->messages.TakeWarnings()) {
      add(dspace::ToUtf8(warning), "VTK reported: ");
    }
  }

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

  // The triangles of a terrain; none for other objects.
  std::vector<dspace::Part> GroundOf(const std::string& scene, const dspace::GraphicsObject& object,
                                     std::size_t budget) {
    const auto found = this->interpreter.GetState().scenes.find(scene);
    return found == this->interpreter.GetState().scenes.end()
               ? std::vector<dspace::Part>()
               : found->second.GroundOf(object, budget);
  }

  // A recording has the name of the drawer, not what it draws.
  std::string LeftOut(const std::string& object, const std::string& drawer) const {
    return "recording '" + this->recording->Path() + "': object '" + object + "' is drawn by '" +
           drawer +
           "'; the recording leaves out what it draws, and a playback without the drawer shows an "
           "empty object";
  }
  void WarnOfRecording(const dspace::v1::Command& accepted, dspace::v1::Reply& reply) const {
    if (this->recording && accepted.has_create_drawn() && !reply.has_error()) {
      const dspace::v1::CreateDrawn& drawn = accepted.create_drawn();
      reply.add_warning(this->LeftOut(drawn.object().name(), drawn.drawer()));
    }
  }

  void TakePlanes() {
    dspace::Capture& capture = this->viewports.LastCapture();
    this->planes.clear();
    this->planes["color"] = ToArray<vtkUnsignedCharArray>("color", capture.color, 4);
    this->planes["range"] = ToArray<vtkFloatArray>("range", capture.range, 1);
    this->planes["depth"] = ToArray<vtkFloatArray>("depth", capture.depth, 1);
    this->planes["label"] = ToArray<vtkUnsignedIntArray>("label", capture.label, 1);
    this->planes["radiance"] = ToArray<vtkFloatArray>("radiance", capture.radiance, 3);
    this->planes["lit_fraction"] = ToArray<vtkFloatArray>("lit_fraction", capture.litFraction, 1);
    this->planes["incidence"] = ToArray<vtkFloatArray>("incidence", capture.incidence, 1);
    this->planes["emission"] = ToArray<vtkFloatArray>("emission", capture.emission, 1);
    this->planes["phase"] = ToArray<vtkFloatArray>("phase", capture.phase, 1);
    this->planes["normal"] = ToArray<vtkFloatArray>("normal", capture.normal, 3);
    capture = {};
  }
};

vtkDspaceSession::vtkDspaceSession() : Impl(new Internals) {
  dspace::EndForkedChildrenAtOnce();
  dspace::session::Registry& commands = this->Impl->interpreter.Commands();
  this->Impl->viewports.AddTo(commands);
  this->Impl->interpreter.GetState().pictures =
      std::make_shared<dspace::session::MeasuringPictures>(this->Impl->viewports);
  dspace::session::AddTextCommands(commands);
  this->Impl->interpreter.SetAround(
      [this](dspace::v1::Reply& reply, const std::function<void()>& run) {
        this->Impl->Watch(reply, run);
      });
  this->Impl->interpreter.GetState().drawers.Register(
      "vtk",
      [impl = this->Impl.get()](const dspace::session::DrawnRequest& request)
          -> std::shared_ptr<const dspace::CustomGeometry> {
        const vtkSmartPointer<vtkProp3D> prop = std::move(impl->offered);
        impl->offered = nullptr;
        return prop ? std::make_shared<dspace::VtkPropGeometry>(prop, request.object) : nullptr;
      });
  this->Impl->interpreter.AddListener(
      [this](const dspace::v1::Command& command, const dspace::v1::Reply& reply) {
        this->Impl->OnCommand(command, reply);
      });
}

vtkDspaceSession::~vtkDspaceSession() {
  if (!this->Impl->home.IsHere()) {
    (void)this->Impl.release(); // HomeProcess.h
  }
}

void vtkDspaceSession::OfferProp(vtkProp3D* prop) {
  this->Impl->offered = prop;
}

std::string vtkDspaceSession::GetDrawerNames() {
  std::string lines;
  for (const std::string& name : this->Impl->interpreter.GetState().drawers.Names()) {
    if (name != "vtk") {
      lines += (lines.empty() ? "" : "\n") + name;
    }
  }
  return lines;
}

void vtkDspaceSession::AddDrawer(const dspace::session::DrawerPlugIn& plugIn) {
  if (!plugIn.drawer) {
    throw dspace::Error(dspace::Error::Kind::InvalidArgument, "drawer '" + plugIn.name + "'",
                        "it has no function that makes the drawer of a geometry");
  }
  this->Impl->interpreter.GetState().drawers.Register(plugIn.name, plugIn.geometry);
  this->Impl->viewports.AddDrawer(plugIn.type, plugIn.drawer);
}

std::string vtkDspaceSession::LoadPlugIn(const std::string& path) {
  const std::string label = "plug-in '" + path + "': ";
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    const char* why = dlerror();
    return label + (why ? why : "it cannot be loaded");
  }
  using Function = void (*)(vtkDspaceSession*);
  const auto function = reinterpret_cast<Function>(dlsym(library, "DspacePlugIn"));
  if (!function) {
    dlclose(library);
    return label + "it has no function DspacePlugIn; accepted: a library with `extern \"C\" void "
                   "DspacePlugIn(vtkDspaceSession*)`";
  }
  try {
    function(this);
  } catch (const std::exception& error) {
    return label + error.what();
  }
  return {};
}

std::string vtkDspaceSession::Execute(const std::string& bytes) {
  dspace::v1::Reply reply;
  if (!this->Impl->home.IsHere()) {
    return dspace::session::ErrorReply(dspace::v1::Error::UNSUPPORTED, "session",
                                       "session: it " + this->Impl->home.Message())
        .SerializeAsString();
  }
  dspace::v1::Command& command = this->Impl->command;
  if (!command.ParseFromString(bytes)) {
    command.Clear();
    reply = dspace::session::NotACommand();
  } else {
    reply = this->Impl->interpreter.Execute(command);
    this->Impl->viewports.ReleaseRenderContext();
    this->Impl->WarnOfRecording(command, reply);
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
    const vtkWeakPointer<vtkDspaceSession> self = this;
    mirror->SetScene(scene, [self, name](const dspace::GraphicsObject& object, std::size_t budget) {
      return self ? self->Impl->GroundOf(name, object, budget) : std::vector<dspace::Part>();
    });
  }
  return mirror;
}

std::string vtkDspaceSession::CheckShader(vtkShaderProperty* property) {
  try {
    dspace::session::ToSetShader(property);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

std::string vtkDspaceSession::SerializeShader(vtkShaderProperty* property) {
  return this->CheckShader(property).empty()
             ? dspace::session::ToSetShader(property).SerializeAsString()
             : std::string();
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
  this->Impl->viewports.ReleaseRenderContext();
  return {};
}

std::string vtkDspaceSession::TakeWarnings() {
  dspace::v1::Reply reply;
  this->Impl->viewports.AddWarnings(reply);
  dspace::session::MakeTextUtf8(reply);
  return reply.SerializeAsString();
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

std::string vtkDspaceSession::GetRecordingLeftOut() {
  std::string lines;
  if (!this->Impl->recording) {
    return lines;
  }
  for (const auto& [name, scene] : this->Impl->interpreter.GetState().scenes) {
    for (const auto& [id, drawn] : scene.drawn) {
      lines += (lines.empty() ? "" : "\n") +
               this->Impl->LeftOut(scene.scene->Object(id).name, drawn.drawer);
    }
  }
  return lines;
}

std::string vtkDspaceSession::Replay(const std::string& bytes, vtkDspaceRecordedFiles* files) {
  const dspace::FilesGuard::Check look = files ? files->GetLook() : dspace::FilesGuard::Check();
  if (!look) {
    dspace::v1::Reply reply;
    reply.mutable_error()->set_kind(dspace::v1::Error::INVALID_ARGUMENT);
    reply.mutable_error()->set_object("recording");
    reply.mutable_error()->set_message("recording: its files are closed; accepted: open ones");
    return reply.SerializeAsString();
  }
  const dspace::FilesGuard guard(look);
  const std::string tooMany =
      dspace::session::TooManyElements(bytes, *dspace::v1::Command::descriptor());
  if (!tooMany.empty()) {
    return dspace::session::ErrorReply(dspace::v1::Error::RESOURCE, "command",
                                       "command: " + tooMany)
        .SerializeAsString();
  }
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
  if (entry && dspace::session::HoldsMeshes(command)) {
    const dspace::v1::Reply filled = dspace::session::Catch([&] {
      files->FillIn(command);
      return dspace::v1::Reply();
    });
    return filled.has_error() ? filled.SerializeAsString()
                              : this->Execute(command.SerializeAsString());
  }
  return this->Execute(bytes);
}

void vtkDspaceSession::ConfineProcess(bool withoutNamesOnly) {
  const dspace::ConfinedDrivers confined(withoutNamesOnly);
}

std::string vtkDspaceSession::GetLimits() {
  std::string lines;
  for (const dspace::BudgetInfo& info : dspace::Budgets()) {
    lines += info.name + (" " + std::to_string(dspace::BudgetOf(info.budget))) + "\n";
  }
  return lines;
}

std::string vtkDspaceSession::SetLimit(const std::string& name, unsigned long long value) {
  try {
    dspace::SetBudget(name, value);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

void vtkDspaceSession::SetImportsApart(bool apart) {
  dspace::SetImportsApart(apart);
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
  if (!this->Impl->home.IsHere()) {
    return; // it is the parent's
  }
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
