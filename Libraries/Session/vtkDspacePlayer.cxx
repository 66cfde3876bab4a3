#include "vtkDspacePlayer.h"

#include <atomic>
#include <memory>
#include <optional>
#include <utility>

#include <dspace/Error.h>
#include <dspace/HomeProcess.h>
#include <dspace/commands/beforehand/FilesAhead.h>
#include <dspace/commands/beforehand/ReadApart.h>
#include <dspace/link/watching/ViewerViews.h>
#include <dspace/link/watching/ViewportCopies.h>
#include <dspace/messages/ErrorReply.h>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceSession.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"

vtkStandardNewMacro(vtkDspacePlayer);

namespace {

// What the reading thread hands over.
struct Opened {
  std::unique_ptr<dspace::session::RecordingReader> reader;
  dspace::session::PlaybackSources sources; // goes before the reader
};

// A recording that another thread reads.
struct Opening {
  // Also asked when the open recording unpacks more.
  std::shared_ptr<std::atomic<bool>> cancelled = std::make_shared<std::atomic<bool>>(false);
  std::shared_ptr<Opened> result = std::make_shared<Opened>();
  dspace::session::ReadApart thread;

  Opening(const std::string& path, bool check)
      : thread([path, check, stop = this->cancelled, into = this->result] {
          const auto checkCancel = [stop, object = "recording '" + path + "'"] {
            if (*stop) {
              throw dspace::Error(dspace::Error::Kind::Resource, object,
                                  "opening it was cancelled");
            }
          };
          into->reader = std::make_unique<dspace::session::RecordingReader>(path);
          into->sources = dspace::session::PlaybackSources::Read(*into->reader, check, checkCancel);
          return dspace::v1::Reply();
        }) {}
};

} // namespace

struct vtkDspacePlayer::Internals {
  dspace::HomeProcess home;
  vtkSmartPointer<vtkDspaceSession> session = vtkSmartPointer<vtkDspaceSession>::New();
  dspace::session::ViewerViews views;
  dspace::session::ViewportCopies copies;
  std::unique_ptr<Opening> opening; // null: nothing is being opened
  dspace::v1::Reply opened;
  std::unique_ptr<dspace::session::RecordingReader> reader;
  std::optional<dspace::session::Playback> playback; // goes before the reader

  dspace::session::Interpreter& Interpreter() { return this->session->GetInterpreter(); }

  dspace::session::Playback& Open() {
    if (!this->playback) {
      throw dspace::Error(dspace::Error::Kind::Io, "player",
                          "no recording is open; accepted: Open first");
    }
    return *this->playback;
  }

  // Throws where nothing is open, and for a step that is not there.
  std::size_t StepOf(long long index) {
    const std::size_t count = this->Open().Steps().size();
    if (index < 0 || index >= static_cast<long long>(count)) {
      throw dspace::Error(dspace::Error::Kind::InvalidArgument, "player",
                          "the step is " + std::to_string(index) + "; accepted: 0 to " +
                              std::to_string(count - 1));
    }
    return std::size_t(index);
  }

  // A reply whose warnings are what the playback has to say.
  dspace::v1::Reply WithNotes() {
    dspace::v1::Reply reply;
    for (std::string& note : this->Open().TakeNotes()) {
      reply.add_warning(std::move(note));
    }
    return reply;
  }

  std::optional<dspace::session::CommandAhead> ReadAhead(const dspace::v1::Command& command,
                                                         const dspace::FilesGuard::Check& look) {
    using dspace::session::FilesAhead;
    const std::shared_ptr<FilesAhead> files =
        FilesAhead::Begin(this->Interpreter().GetState(), command, look);
    if (!files) {
      return {};
    }
    const auto execute = [this, files] {
      if (files->Failed().has_error()) {
        return files->Failed();
      }
      const dspace::session::ReadBeforehand::Scope scope(files->Files());
      dspace::v1::Command read = files->ToExecute(this->Interpreter().GetState());
      return this->Interpreter().Execute(read);
    };
    return dspace::session::CommandAhead{[files](double seconds) { return files->IsRead(seconds); },
                                         execute};
  }

  dspace::session::PlaybackGuests Guests() {
    dspace::session::PlaybackGuests guests;
    guests.beforeSnapshot = [this] { this->views.BeforeSnapshot(this->Interpreter()); };
    guests.afterSnapshot = [this] { this->views.AfterSnapshot(this->Interpreter()); };
    // Nobody makes what a view may wait for.
    guests.arrived = [this] { this->views.Resume(this->Interpreter(), true); };
    guests.makeRoom = [this](const dspace::v1::Command& command) {
      return this->views.RemoveConflicting(this->Interpreter(), command);
    };
    guests.readAhead = [this](const dspace::v1::Command& command,
                              const dspace::FilesGuard::Check& look) {
      return this->ReadAhead(command, look);
    };
    return guests;
  }
};

vtkDspacePlayer::vtkDspacePlayer() : Impl(std::make_unique<Internals>()) {}

vtkDspacePlayer::~vtkDspacePlayer() {
  if (!this->Impl->home.IsHere()) {
    (void)this->Impl.release(); // HomeProcess.h
    return;
  }
  this->Close();
}

void vtkDspacePlayer::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Recording: " << (this->Impl->reader ? this->Impl->reader->Path() : "none")
     << "\n";
}

void vtkDspacePlayer::ShareRenderContext(vtkDspaceSession* other) {
  this->Impl->session->SetRenderContext(other->GetRenderContext());
}

std::string vtkDspacePlayer::Open(const std::string& path, bool check) {
  constexpr double Long = 3600.0; // [s]
  this->BeginOpen(path, check);
  while (this->WaitForOpen(Long) == 0) {
  }
  return this->TakeReply();
}

void vtkDspacePlayer::BeginOpen(const std::string& path, bool check) {
  this->Close();
  this->Impl->opened = dspace::session::Catch([&] {
    this->Impl->opening = std::make_unique<Opening>(path, check);
    return dspace::v1::Reply();
  });
}

int vtkDspacePlayer::WaitForOpen(double seconds) {
  Internals& impl = *this->Impl;
  if (!impl.opening) {
    return impl.playback ? 1 : -1;
  }
  if (!impl.playback && !impl.opening->thread.IsDone(seconds)) {
    return 0;
  }
  bool there = false;
  impl.opened = impl.opening->thread.Reply();
  if (!impl.opened.has_error()) {
    impl.opened = dspace::session::Catch([&] {
      if (!impl.playback) {
        impl.copies.Follow(impl.Interpreter());
        impl.reader = std::move(impl.opening->result->reader);
        impl.playback.emplace(*impl.reader, impl.Interpreter(),
                              std::move(impl.opening->result->sources), impl.Guests());
      }
      there = impl.playback->Continue(seconds);
      return there ? impl.WithNotes() : dspace::v1::Reply();
    });
  }
  if (impl.opened.has_error()) {
    const dspace::v1::Reply failed = impl.opened;
    this->Close();
    impl.opened = failed;
    return -1;
  }
  if (there) {
    impl.opening.reset();
  }
  return there ? 1 : 0;
}

std::string vtkDspacePlayer::TakeReply() {
  return std::exchange(this->Impl->opened, {}).SerializeAsString();
}

vtkDspaceSession* vtkDspacePlayer::GetSession() {
  return this->Impl->session;
}

std::string vtkDspacePlayer::Execute(const std::string& bytes) {
  dspace::v1::Command command;
  if (!command.ParseFromString(bytes)) {
    return dspace::session::NotACommand().SerializeAsString();
  }
  if (!this->Impl->views.Owns(command)) {
    return this->Impl->session->Execute(bytes);
  }
  return this->Impl->views.Execute(this->Impl->Interpreter(), command).SerializeAsString();
}

std::string vtkDspacePlayer::CopyViewport(const std::string& viewport, const std::string& as) {
  return dspace::session::Catch([&] {
           const std::vector<dspace::v1::Command> commands =
               this->Impl->copies.Commands(viewport, as);
           if (commands.empty()) {
             throw dspace::Error(dspace::Error::Kind::NotFound, "viewport '" + viewport + "'",
                                 "there is no such viewport at this step");
           }
           dspace::v1::Reply reply;
           for (dspace::v1::Command command : commands) {
             reply = this->Impl->views.Execute(this->Impl->Interpreter(), command);
             if (reply.has_error()) {
               return reply;
             }
           }
           return dspace::v1::Reply();
         })
      .SerializeAsString();
}

std::string vtkDspacePlayer::Go(long long index) {
  return dspace::session::Catch([&] {
           const std::size_t step = this->Impl->StepOf(index);
           dspace::session::Playback& playback = *this->Impl->playback;
           playback.Step(static_cast<long long>(step) - static_cast<long long>(playback.Index()));
           return this->Impl->WithNotes();
         })
      .SerializeAsString();
}

std::string vtkDspacePlayer::BeginGo(long long index) {
  return dspace::session::Catch([&] {
           const std::size_t step = this->Impl->StepOf(index);
           this->Impl->playback->Aim(step);
           return dspace::v1::Reply();
         })
      .SerializeAsString();
}

int vtkDspacePlayer::ContinueGo(double seconds) {
  bool there = false;
  this->Impl->opened = dspace::session::Catch([&] {
    there = this->Impl->Open().Continue(seconds);
    return there ? this->Impl->WithNotes() : dspace::v1::Reply();
  });
  return this->Impl->opened.has_error() ? -1 : there ? 1 : 0;
}

long long vtkDspacePlayer::GetIndex() {
  return this->Impl->playback ? static_cast<long long>(this->Impl->playback->Index()) : 0;
}

double vtkDspacePlayer::GetTime() {
  return this->Impl->playback ? this->Impl->playback->Time() : 0.0;
}

bool vtkDspacePlayer::IsMoving() {
  return this->Impl->playback && this->Impl->playback->IsMoving();
}

std::string vtkDspacePlayer::Update() {
  return dspace::session::Catch([&] {
           this->Impl->Open().Update();
           return dspace::v1::Reply();
         })
      .SerializeAsString();
}

std::string vtkDspacePlayer::GetFolder() {
  return this->Impl->playback ? this->Impl->playback->Files().Folder() : std::string();
}

void vtkDspacePlayer::Close() {
  if (this->Impl->opening) {
    *this->Impl->opening->cancelled = true;
    this->Impl->opening.reset();
  }
  this->Impl->opened.Clear();
  this->Impl->playback.reset();
  this->Impl->reader.reset();
}

dspace::session::Playback* vtkDspacePlayer::GetPlayback() {
  return this->Impl->playback ? &*this->Impl->playback : nullptr;
}

dspace::session::RecordingReader* vtkDspacePlayer::GetReader() {
  return this->Impl->reader.get();
}
