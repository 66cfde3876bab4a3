#include "vtkDspaceWatcher.h"

#include <deque>
#include <set>
#include <utility>
#include <vector>

#include <dspace/HomeProcess.h>
#include <dspace/link/watching/LatestSteps.h>
#include <dspace/link/watching/LinkBanner.h>
#include <dspace/link/watching/ViewerViews.h>
#include <dspace/link/watching/ViewportCopies.h>
#include <dspace/link/watching/Watcher.h>
#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/ErrorReply.h>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceSession.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"

vtkStandardNewMacro(vtkDspaceWatcher);

namespace {

constexpr int MostChanges = 100000;     // pending frame events
constexpr double WriterTimeout = 2.0;   // [s] of a snapshot
constexpr std::size_t MostEvents = 100; // that wait to be sent
constexpr double EventTimeout = 10.0;   // [s] of one that is sent in the background
constexpr double PickTimeout = 1.0;     // [s]: a click is not to stop the viewer for longer

} // namespace

struct vtkDspaceWatcher::Internals {
  dspace::HomeProcess home;
  dspace::session::WatcherOptions options;
  std::unique_ptr<dspace::session::Watcher> watcher;
  vtkSmartPointer<vtkDspaceSession> session = vtkSmartPointer<vtkDspaceSession>::New();
  dspace::session::ViewerViews views;
  dspace::session::ViewportCopies copies;
  bool background = false;
  std::deque<dspace::v1::ViewerEvent> events; // to be sent; the first one may be on its way
  bool sending = false;
  std::uint64_t sequence = 0;
  std::string writer;
  bool writerConnected = false;
  bool writerPending = false; // not received since the last snapshot
  std::string error;
  std::string failed; // the reply with the error of a connection or an event
  dspace::session::LinkBanner banner;
  std::set<std::string> followed; // scenes with frame events
  dspace::v1::Reply changes;      // their pending events
  std::set<std::string> leftOut;  // objects whose drawers are missing here, that were told of

  dspace::session::Interpreter& Interpreter() { return this->session->GetInterpreter(); }

  void Apply(dspace::v1::WatchReply& message) {
    if (message.has_snapshot()) {
      this->Begin(*message.mutable_snapshot());
      this->writerPending = true;
    } else if (message.has_command()) {
      this->Apply(*message.mutable_command());
    } else if (message.has_writer()) {
      this->writer = message.writer().name();
      this->writerConnected = message.writer().connected();
      this->writerPending = false;
    }
    this->sequence = message.sequence();
  }

  // Applies messages in order, without superseded steps.
  void Apply(std::vector<dspace::v1::WatchReply>& messages) {
    std::size_t at = 0;
    while (at < messages.size()) {
      if (!dspace::session::IsStep(messages[at]) || !this->OnlyLatest()) {
        this->Apply(messages[at++]);
        continue;
      }
      for (const bool superseded : dspace::session::SupersededSteps(messages, at)) {
        if (superseded) {
          this->NoteTime(messages[at].command());
          this->sequence = messages[at].sequence();
        } else {
          this->Apply(messages[at]);
        }
        ++at;
      }
    }
  }

  // The beginning of a scene is the least time, of steps that are skipped too.
  void NoteTime(const dspace::v1::Command& command) {
    auto& scenes = this->Interpreter().GetState().scenes;
    const auto found = scenes.find(dspace::session::SceneName(command));
    if (command.has_set_time() && found != scenes.end()) {
      found->second.NoteTime(command.set_time().time_s());
    }
  }

  // Whether intermediate steps are not recorded, followed or needed by a lagging camera.
  bool OnlyLatest() {
    return this->followed.empty() && this->session->GetRecordingPath().empty() &&
           !dspace::session::HasLaggingCamera(this->Interpreter().GetState());
  }

  void Begin(dspace::v1::WatchReply::Snapshot& snapshot) {
    this->views.BeforeSnapshot(this->Interpreter());
    // The new session keeps the render context with its GPU resources.
    const vtkSmartPointer<vtkDspaceRenderContext> context = this->session->GetRenderContext();
    const vtkSmartPointer<vtkDspaceSession> before = this->session;
    this->session = vtkSmartPointer<vtkDspaceSession>::New();
    this->session->SetRenderContext(context);
    this->error.clear();
    this->banner.Follow(this->Interpreter());
    this->copies.Follow(this->Interpreter());
    const std::set<std::string> scenes =
        std::exchange(this->followed, {}); // a snapshot causes no events
    for (dspace::v1::Command& command : *snapshot.mutable_command()) {
      this->Apply(command);
    }
    this->views.AfterSnapshot(this->Interpreter());
    this->followed = scenes;
    for (const std::string& scene : scenes) {
      this->Follow(scene);
    }
    this->session->TakeRecording(before);
  }

  void Apply(dspace::v1::Command& command) {
    if (command.has_remove_scene()) {
      this->views.RemoveConflicting(this->Interpreter(), command);
    }
    dspace::v1::Reply reply = this->Interpreter().Execute(command);
    if (reply.has_error() && this->views.RemoveConflicting(this->Interpreter(), command)) {
      reply = this->Interpreter().Execute(command);
    }
    if (reply.has_error()) {
      this->session->AddFailed(command, reply.error().message());
      this->error = this->error.empty() ? reply.error().message() : this->error;
    }
    if (command.has_create_drawn() && this->leftOut.insert(command.create_drawn().object().name())
                                          .second) { // once, however many snapshots come
      this->changes.mutable_warning()->MergeFrom(reply.warning());
    }
    this->changes.mutable_frame_event()->MergeFrom(reply.frame_event());
    if (this->changes.frame_event_size() > MostChanges) {
      this->changes.mutable_frame_event()->DeleteSubrange(0, MostChanges / 2);
    }
    if (command.has_create_scene() && this->followed.count(dspace::session::SceneName(command))) {
      this->Follow(command.scene());
    }
  }

  void Follow(const std::string& scene) {
    dspace::v1::Command command;
    command.set_scene(scene);
    command.mutable_follow_frames();
    this->Interpreter().Execute(command); // a missing scene is followed when it is created
  }

  void ShowBanner() {
    using dspace::session::LinkBanner;
    LinkBanner::Text text;
    if (this->watcher && !this->watcher->Connected()) {
      text = LinkBanner::ServerLost();
    } else if (!this->writerConnected && !this->writer.empty()) {
      text = LinkBanner::SimulationGone(this->writer);
    }
    this->banner.Show(this->Interpreter(), text);
  }

  dspace::v1::Reply Execute(dspace::v1::Command& command) {
    using dspace::session::Effect;
    if (command.has_capture()) {
      command.mutable_capture()->set_inline_data(true); // the planes must be in the reply
    } else if (command.has_simulate_image()) {
      command.mutable_simulate_image()->set_inline_data(true);
    }
    if (command.has_follow_frames()) {
      dspace::v1::Reply reply = this->Interpreter().Execute(command);
      if (!reply.has_error()) {
        command.follow_frames().stop()
            ? void(this->followed.erase(dspace::session::SceneName(command)))
            : void(this->followed.insert(dspace::session::SceneName(command)));
      }
      return reply;
    }
    const auto* entry = this->Interpreter().Commands().Find(command.command_case());
    if (!entry || entry->effect != Effect::Change) {
      return this->Interpreter().Execute(command);
    }
    if (!this->views.Owns(command)) {
      const std::string name = dspace::session::CommandName(command);
      return dspace::session::ErrorReply(
          dspace::v1::Error::UNSUPPORTED, "command " + name,
          "command " + name +
              ": a viewer cannot change the scene; accepted: requests, and changes of the viewer's "
              "own "
              "viewports, vantages and cameras, whose names begin with '" +
              std::string(dspace::session::ViewerViews::Prefix) + "'");
    }
    const dspace::v1::Reply reply = this->views.Execute(this->Interpreter(), command);
    if (command.has_viewport_event() && reply.pick().object() != 0) {
      this->SendPick(command.viewport_event().viewport(), reply.pick());
    }
    if (command.has_viewport_event() && reply.has_input()) {
      this->SendInput(command.viewport_event().viewport(), reply.input());
    }
    if (command.has_create_viewport() || command.has_resize_viewport()) {
      this->ShowBanner();
    }
    return reply;
  }

  // Sends a pick to the simulation. Without a driver, only the viewer receives it.
  void SendPick(const std::string& viewport, const dspace::v1::PickReply& pick) {
    dspace::v1::ViewerEvent event;
    event.mutable_picked()->set_scene(this->Interpreter().GetState().viewports[viewport].scene);
    event.mutable_picked()->set_viewport(viewport);
    *event.mutable_picked()->mutable_pick() = pick;
    this->Send(event);
  }

  // The same of a key or a click that did not move the camera.
  void SendInput(const std::string& viewport, const dspace::v1::InputReply& input) {
    dspace::v1::ViewerEvent event;
    event.mutable_input()->set_scene(this->Interpreter().GetState().viewports[viewport].scene);
    event.mutable_input()->set_viewport(viewport);
    *event.mutable_input()->mutable_input() = input;
    this->Send(event);
  }

  void Send(const dspace::v1::ViewerEvent& event) {
    if (!this->watcher || !this->watcher->Connected() || !this->writerConnected) {
      return;
    }
    if (this->background) {
      if (this->events.size() < MostEvents) {
        this->events.push_back(event);
      }
      this->SendWaiting();
      return;
    }
    dspace::session::Catch([&] {
      this->watcher->SendEvent(event, PickTimeout);
      return dspace::v1::Reply();
    });
  }

  // Sends what waits, without waiting. What fails is dropped, as without a driver.
  void SendWaiting() {
    while (this->watcher && !this->events.empty()) {
      const dspace::v1::Reply reply = dspace::session::Catch([&] {
        if (!this->sending) {
          this->watcher->BeginSendEvent(this->events.front(), EventTimeout);
          this->sending = true;
        }
        if (this->watcher->WaitForSendEvent(0.0)) {
          this->sending = false;
          this->events.pop_front();
          this->watcher->TakeSendEventResult();
        }
        return dspace::v1::Reply();
      });
      if (reply.has_error() && this->sending) {
        this->sending = false;
        this->events.pop_front();
      }
      if (this->sending) {
        return;
      }
    }
  }
};

vtkDspaceWatcher::vtkDspaceWatcher() : Impl(new Internals) {
  this->Impl->banner.Follow(this->Impl->Interpreter());
  this->Impl->copies.Follow(this->Impl->Interpreter());
}
vtkDspaceWatcher::~vtkDspaceWatcher() {
  if (!this->Impl->home.IsHere()) {
    (void)this->Impl.release(); // HomeProcess.h
  }
}

void vtkDspaceWatcher::SetCertificates(const std::string& certificate, const std::string& key,
                                       const std::string& authority) {
  this->Impl->options.security.certificate = certificate;
  this->Impl->options.security.key = key;
  this->Impl->options.security.authority = authority;
}

void vtkDspaceWatcher::SetInsecure(bool insecure) {
  this->Impl->options.security.insecure = insecure;
}

void vtkDspaceWatcher::SetTimeout(double seconds) {
  this->Impl->options.timeout_s = seconds;
}

void vtkDspaceWatcher::SetInBackground(bool background) {
  this->Impl->background = background;
}

void vtkDspaceWatcher::ShareRenderContext(vtkDspaceSession* other) {
  this->Impl->session->SetRenderContext(other->GetRenderContext());
}

std::string vtkDspaceWatcher::CopyViewport(const std::string& viewport, const std::string& as) {
  return dspace::session::Catch([&] {
           const std::vector<dspace::v1::Command> commands =
               this->Impl->copies.Commands(viewport, as, dspace::session::LinkBanner::TableName);
           if (commands.empty()) {
             throw dspace::Error(dspace::Error::Kind::NotFound, "viewport '" + viewport + "'",
                                 "there is no such viewport");
           }
           for (dspace::v1::Command command : commands) {
             const dspace::v1::Reply reply = this->Impl->Execute(command);
             if (reply.has_error()) {
               return reply;
             }
           }
           return dspace::v1::Reply();
         })
      .SerializeAsString();
}

std::string vtkDspaceWatcher::Connect(const std::string& address, const std::string& name) {
  const std::string reply = this->BeginConnect(address, name);
  int state = 0;
  while (this->Impl->watcher && (state = this->WaitForConnect(1e6)) == 0) {
  }
  return state < 0 ? this->TakeReply() : reply;
}

std::string vtkDspaceWatcher::BeginConnect(const std::string& address, const std::string& name) {
  using dspace::session::Watcher;
  this->Impl->options.address = address;
  this->Impl->options.name = name;
  return dspace::session::Catch([this] {
           this->Impl->watcher.reset();
           this->Impl->watcher =
               std::make_unique<Watcher>(this->Impl->options, Watcher::NonBlocking());
           return dspace::v1::Reply();
         })
      .SerializeAsString();
}

int vtkDspaceWatcher::WaitForConnect(double seconds) {
  bool connected = false;
  const dspace::v1::Reply reply = dspace::session::Catch([&] {
    if (!this->Impl->watcher) {
      throw dspace::Error(dspace::Error::Kind::Io, "watcher",
                          "no connection was started; accepted: BeginConnect first");
    }
    connected = this->Impl->watcher->WaitForConnect(seconds);
    return dspace::v1::Reply();
  });
  if (reply.has_error()) {
    this->Impl->watcher.reset();
    this->Impl->failed = reply.SerializeAsString();
    return -1;
  }
  return connected ? 1 : 0;
}

std::string vtkDspaceWatcher::TakeReply() {
  return std::exchange(this->Impl->failed, std::string());
}

int vtkDspaceWatcher::Update(double wait) {
  std::size_t applied = 0;
  std::vector<dspace::v1::WatchReply> messages;
  // Limited: messages that arrive faster than they are applied wait for the next call.
  const auto longest = [&] {
    return applied == 0 ? wait
           : this->Impl->writerPending && !this->Impl->background && this->GetConnected()
               ? WriterTimeout
               : 0.0;
  };
  while (this->Impl->watcher && applied < 10000 &&
         this->Impl->watcher->TakeAll(messages, longest())) {
    this->Impl->Apply(messages);
    applied += messages.size();
  }
  this->Impl->views.Resume(this->Impl->Interpreter(), !this->Impl->writerConnected);
  this->Impl->ShowBanner();
  if (this->Impl->background) {
    this->Impl->SendWaiting();
  }
  return static_cast<int>(applied);
}

long long vtkDspaceWatcher::GetSequence() {
  return static_cast<long long>(this->Impl->sequence);
}

bool vtkDspaceWatcher::GetConnected() {
  return this->Impl->watcher && this->Impl->watcher->Connected();
}

bool vtkDspaceWatcher::GetWriterConnected() {
  return this->Impl->writerConnected && this->GetConnected();
}

std::string vtkDspaceWatcher::GetWriterName() {
  return this->Impl->writer;
}

std::string vtkDspaceWatcher::GetError() {
  const std::string rejection =
      this->Impl->watcher ? this->Impl->watcher->Rejection() : std::string();
  return rejection.empty() ? this->Impl->error : rejection;
}

std::string vtkDspaceWatcher::Execute(const std::string& bytes) {
  dspace::v1::Command command;
  const dspace::v1::Reply reply = command.ParseFromString(bytes) ? this->Impl->Execute(command)
                                                                 : dspace::session::NotACommand();
  return reply.SerializeAsString();
}

std::string vtkDspaceWatcher::TakeFrameEvents() {
  const std::string bytes = this->Impl->changes.SerializeAsString();
  this->Impl->changes.Clear();
  return bytes;
}

std::string vtkDspaceWatcher::BeginSendEvent(const std::string& bytes) {
  return dspace::session::Catch([&] {
           dspace::v1::ViewerEvent event;
           if (!this->Impl->watcher || !event.ParseFromString(bytes)) {
             throw dspace::Error(dspace::Error::Kind::Corrupt, "event",
                                 "the bytes are not a ViewerEvent, or there is no connection");
           }
           this->Impl->watcher->BeginSendEvent(event, this->Impl->options.timeout_s);
           return dspace::v1::Reply();
         })
      .SerializeAsString();
}

int vtkDspaceWatcher::WaitForSendEvent(double seconds) {
  bool told = false;
  const dspace::v1::Reply reply = dspace::session::Catch([&] {
    if (!this->Impl->watcher) {
      throw dspace::Error(dspace::Error::Kind::Io, "event", "there is no connection");
    }
    told = this->Impl->watcher->WaitForSendEvent(seconds);
    if (told && !this->Impl->watcher->TakeSendEventResult()) {
      throw dspace::Error(dspace::Error::Kind::NotFound, "simulation",
                          "the server has no driver; the event is dropped");
    }
    return dspace::v1::Reply();
  });
  if (reply.has_error()) {
    this->Impl->failed = reply.SerializeAsString();
    return -1;
  }
  return told ? 1 : 0;
}

void vtkDspaceWatcher::CancelSendEvent() {
  if (this->Impl->watcher) {
    this->Impl->watcher->CancelSendEvent();
  }
}

std::string vtkDspaceWatcher::QueueEvent(const std::string& bytes) {
  return dspace::session::Catch([&] {
           Internals& self = *this->Impl;
           dspace::v1::ViewerEvent event;
           if (!event.ParseFromString(bytes)) {
             throw dspace::Error(dspace::Error::Kind::Corrupt, "event",
                                 "the bytes are not a ViewerEvent");
           }
           if (!self.background) {
             throw dspace::Error(dspace::Error::Kind::Unsupported, "event",
                                 "nothing sends it later; accepted: SetInBackground first");
           }
           if (!this->GetWriterConnected()) {
             throw dspace::Error(dspace::Error::Kind::NotFound, "simulation",
                                 "the server has no driver; the event is dropped");
           }
           if (self.events.size() >= MostEvents) {
             throw dspace::Error(dspace::Error::Kind::Resource, "event",
                                 std::to_string(MostEvents) +
                                     " others wait to be sent; accepted: fewer");
           }
           self.Send(event);
           return dspace::v1::Reply();
         })
      .SerializeAsString();
}

vtkDspaceSession* vtkDspaceWatcher::GetSession() {
  return this->Impl->session;
}

void vtkDspaceWatcher::Close() {
  this->Impl->watcher.reset();
}

void vtkDspaceWatcher::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Address: " << this->Impl->options.address << "\n"
     << indent << "Sequence: " << this->GetSequence() << "\n";
}
