#include "vtkDspaceWatcher.h"

#include <algorithm>
#include <vector>

#include <dspace/session/ErrorReply.h>
#include <dspace/session/Watcher.h>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceSession.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"

vtkStandardNewMacro(vtkDspaceWatcher);

namespace {

constexpr const char* Own = "viewer:";        // begins the names of a watcher's own viewports
constexpr const char* Banner = "dspace.link"; // the table that says what is wrong
constexpr int MostOwnCommands = 1000;

// "viewer:1" of a command on that viewport, else empty.
std::string OwnViewport(const dspace::v1::Command& command) {
  std::string name;
  switch (command.command_case()) {
  case dspace::v1::Command::kCreateViewport:
    name = command.create_viewport().name();
    break;
  case dspace::v1::Command::kRemoveViewport:
    name = command.remove_viewport().viewport();
    break;
  case dspace::v1::Command::kResizeViewport:
    name = command.resize_viewport().viewport();
    break;
  case dspace::v1::Command::kMoveViewport:
    name = command.move_viewport().viewport();
    break;
  case dspace::v1::Command::kSetViewport:
    name = command.set_viewport().viewport();
    break;
  case dspace::v1::Command::kSetViewportFragment:
    name = command.set_viewport_fragment().viewport();
    break;
  case dspace::v1::Command::kSetTextTable:
    name = command.set_text_table().viewport();
    break;
  case dspace::v1::Command::kRemoveTextTable:
    name = command.remove_text_table().viewport();
    break;
  default:
    break;
  }
  return name.rfind(Own, 0) == 0 ? name : std::string();
}

} // namespace

struct vtkDspaceWatcher::Internals {
  dspace::session::WatcherOptions options;
  std::unique_ptr<dspace::session::Watcher> watcher;
  vtkSmartPointer<vtkDspaceSession> session = vtkSmartPointer<vtkDspaceSession>::New();
  std::vector<dspace::v1::Command> own; // on one's own viewports, in order
  int lastOwn = 0;
  std::uint64_t sequence = 0;
  std::string writer;
  bool writerConnected = false;
  std::string trouble;
  std::string banner; // that is shown

  dspace::session::Interpreter& Interpreter() { return this->session->GetInterpreter(); }

  void Apply(dspace::v1::WatchReply& message) {
    if (message.has_snapshot()) {
      this->Begin(*message.mutable_snapshot());
    } else if (message.has_command()) {
      this->Apply(*message.mutable_command());
    } else if (message.has_writer()) {
      this->writer = message.writer().name();
      this->writerConnected = message.writer().connected();
    }
    this->sequence = message.sequence();
  }

  void Begin(dspace::v1::WatchReply::Snapshot& snapshot) {
    // The context goes on, with what is on the GPU already.
    const vtkSmartPointer<vtkDspaceRenderContext> context = this->session->GetRenderContext();
    this->session = vtkSmartPointer<vtkDspaceSession>::New();
    this->session->SetRenderContext(context);
    this->trouble.clear();
    this->banner.clear();
    for (dspace::v1::Command& command : *snapshot.mutable_command()) {
      this->Apply(command);
    }
    for (dspace::v1::Command command : this->own) {
      this->Interpreter().Execute(command); // what is shown there may be gone: then it is too
    }
  }

  void Apply(dspace::v1::Command& command) {
    dspace::v1::Reply reply = this->Interpreter().Execute(command);
    if (reply.has_error() && !this->own.empty()) {
      this->RemoveOwn(); // one that shows what is to be removed is in the way
      reply = this->Interpreter().Execute(command);
    }
    if (reply.has_error() && this->trouble.empty()) {
      this->trouble = reply.error().message();
    }
  }

  std::vector<std::string> Viewports() {
    dspace::v1::Command command;
    command.mutable_list_viewports();
    const dspace::v1::Reply reply = this->Interpreter().Execute(command);
    return {reply.viewports().name().begin(), reply.viewports().name().end()};
  }

  void RemoveOwn() {
    for (const std::string& name : this->Viewports()) {
      if (name.rfind(Own, 0) == 0) {
        dspace::v1::Command command;
        command.mutable_remove_viewport()->set_viewport(name);
        this->Interpreter().Execute(command);
      }
    }
    this->own.clear();
  }

  void ShowBanner() {
    std::string text;
    std::string why;
    if (this->watcher && !this->watcher->Connected(&why)) {
      text = "server lost: waiting for it";
    } else if (!this->writerConnected && !this->writer.empty()) {
      text = "simulation '" + this->writer + "' has gone: last state";
    }
    if (text == this->banner) {
      return;
    }
    this->banner = text;
    for (const std::string& viewport : this->Viewports()) {
      dspace::v1::Command command;
      if (text.empty()) {
        command.mutable_remove_text_table()->set_viewport(viewport);
        command.mutable_remove_text_table()->set_name(Banner);
      } else {
        dspace::v1::SetTextTable* table = command.mutable_set_text_table();
        table->set_viewport(viewport);
        table->set_name(Banner);
        table->set_title(text);
        table->set_anchor(dspace::v1::SetTextTable::BOTTOM_LEFT);
        table->mutable_color()->set_r(1);
        table->mutable_color()->set_g(0.8);
        table->set_background_opacity(0.8);
      }
      this->Interpreter().Execute(command);
    }
  }

  void Remember(const dspace::v1::Command& command) {
    const auto kind = command.command_case();
    const std::string name = OwnViewport(command);
    const bool gone = command.has_remove_viewport();
    const bool newer = command.has_resize_viewport() || command.has_move_viewport();
    this->own.erase(std::remove_if(this->own.begin(), this->own.end(),
                                   [&](const dspace::v1::Command& each) {
                                     return OwnViewport(each) == name &&
                                            (gone || (newer && each.command_case() == kind));
                                   }),
                    this->own.end());
    if (!gone) {
      this->own.push_back(command);
    }
  }

  dspace::v1::Reply Execute(dspace::v1::Command& command) {
    using dspace::session::Effect;
    if (command.has_create_viewport() && command.create_viewport().name().empty()) {
      command.mutable_create_viewport()->set_name(Own + std::to_string(++this->lastOwn));
    }
    if (command.has_capture()) {
      command.mutable_capture()->set_inline_data(true); // the session does not see this one
    }
    const auto* entry = this->Interpreter().Commands().Find(command.command_case());
    if (!entry || entry->effect == Effect::Request || command.has_follow_frames()) {
      return this->Interpreter().Execute(command);
    }
    if (OwnViewport(command).empty()) {
      const std::string name = dspace::session::CommandName(command);
      return dspace::session::ErrorReply(
          dspace::v1::Error::UNSUPPORTED, "command " + name,
          "command " + name +
              ": who watches changes nothing; accepted: requests, and viewports "
              "of one's own, whose names begin with '" +
              std::string(Own) + "'");
    }
    if (int(this->own.size()) >= MostOwnCommands) {
      return dspace::session::ErrorReply(
          dspace::v1::Error::RESOURCE, "watcher",
          "watcher: it has given " + std::to_string(MostOwnCommands) +
              " commands to viewports of its own; accepted: no more");
    }
    dspace::v1::Reply reply = this->Interpreter().Execute(command);
    if (!reply.has_error()) {
      this->Remember(command);
    }
    return reply;
  }
};

vtkDspaceWatcher::vtkDspaceWatcher() : Impl(new Internals) {}
vtkDspaceWatcher::~vtkDspaceWatcher() = default;

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

std::string vtkDspaceWatcher::Connect(const std::string& address, const std::string& name) {
  this->Impl->options.address = address;
  this->Impl->options.name = name;
  return dspace::session::Catch([this] {
           this->Impl->watcher.reset();
           this->Impl->watcher = std::make_unique<dspace::session::Watcher>(this->Impl->options);
           return dspace::v1::Reply();
         })
      .SerializeAsString();
}

int vtkDspaceWatcher::Update(double wait) {
  int applied = 0;
  dspace::v1::WatchReply message;
  // Not for ever: what comes faster than it is applied is for the next call.
  while (this->Impl->watcher && applied < 10000 &&
         this->Impl->watcher->Take(message, applied == 0 ? wait : 0.0)) {
    this->Impl->Apply(message);
    ++applied;
  }
  this->Impl->ShowBanner();
  return applied;
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

std::string vtkDspaceWatcher::GetTrouble() {
  return this->Impl->trouble;
}

std::string vtkDspaceWatcher::Execute(const std::string& bytes) {
  dspace::v1::Command command;
  const dspace::v1::Reply reply = command.ParseFromString(bytes) ? this->Impl->Execute(command)
                                                                 : dspace::session::NotACommand();
  return reply.SerializeAsString();
}

std::string vtkDspaceWatcher::Tell(const std::string& bytes) {
  return dspace::session::Catch([&] {
           dspace::v1::ViewerEvent event;
           if (!this->Impl->watcher || !event.ParseFromString(bytes)) {
             throw dspace::Error(dspace::Error::Kind::Corrupt, "event",
                                 "the bytes are not a ViewerEvent, or there is no connection");
           }
           if (!this->Impl->watcher->Tell(event)) {
             throw dspace::Error(dspace::Error::Kind::NotFound, "simulation",
                                 "nobody drives the server now; the event is dropped");
           }
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
