#include "vtkDspacePlayer.h"

#include <optional>

#include <dspace/Error.h>
#include <dspace/HomeProcess.h>
#include <dspace/link/watching/ViewerViews.h>
#include <dspace/link/watching/ViewportCopies.h>
#include <dspace/messages/ErrorReply.h>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceSession.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"

vtkStandardNewMacro(vtkDspacePlayer);

struct vtkDspacePlayer::Internals {
  dspace::HomeProcess home;
  vtkSmartPointer<vtkDspaceSession> session = vtkSmartPointer<vtkDspaceSession>::New();
  dspace::session::ViewerViews views;
  dspace::session::ViewportCopies copies;
  std::optional<dspace::session::RecordingReader> reader;
  std::optional<dspace::session::Playback> playback; // goes before the reader

  dspace::session::Interpreter& Interpreter() { return this->session->GetInterpreter(); }

  dspace::session::Playback& Open() {
    if (!this->playback) {
      throw dspace::Error(dspace::Error::Kind::Io, "player",
                          "no recording is open; accepted: Open first");
    }
    return *this->playback;
  }

  // A reply whose warnings are what the playback has to say.
  dspace::v1::Reply WithNotes() {
    dspace::v1::Reply reply;
    for (std::string& note : this->Open().TakeNotes()) {
      reply.add_warning(std::move(note));
    }
    return reply;
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
    return guests;
  }
};

vtkDspacePlayer::vtkDspacePlayer() : Impl(std::make_unique<Internals>()) {}

vtkDspacePlayer::~vtkDspacePlayer() {
  if (!this->Impl->home.IsHere()) {
    (void)this->Impl.release(); // HomeProcess.h
  }
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
  this->Close();
  const dspace::v1::Reply reply = dspace::session::Catch([&] {
    this->Impl->copies.Follow(this->Impl->Interpreter());
    this->Impl->reader.emplace(path);
    this->Impl->playback.emplace(*this->Impl->reader, this->Impl->Interpreter(), check);
    this->Impl->playback->SetGuests(this->Impl->Guests());
    return this->Impl->WithNotes();
  });
  if (reply.has_error()) {
    this->Close();
  }
  return reply.SerializeAsString();
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
           dspace::session::Playback& playback = this->Impl->Open();
           const long long from = static_cast<long long>(playback.Index());
           if (index < 0 || index >= static_cast<long long>(playback.Steps().size())) {
             throw dspace::Error(dspace::Error::Kind::InvalidArgument, "player",
                                 "the step is " + std::to_string(index) + "; accepted: 0 to " +
                                     std::to_string(playback.Steps().size() - 1));
           }
           playback.Step(index - from);
           return this->Impl->WithNotes();
         })
      .SerializeAsString();
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
  this->Impl->playback.reset();
  this->Impl->reader.reset();
}

dspace::session::Playback* vtkDspacePlayer::GetPlayback() {
  return this->Impl->playback ? &*this->Impl->playback : nullptr;
}

dspace::session::RecordingReader* vtkDspacePlayer::GetReader() {
  return this->Impl->reader ? &*this->Impl->reader : nullptr;
}
