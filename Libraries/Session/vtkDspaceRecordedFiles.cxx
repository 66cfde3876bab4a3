#include "vtkDspaceRecordedFiles.h"

#include <optional>

#include "RecordingThread.h"

#include <dspace/HomeProcess.h>
#include <dspace/recording/RecordedFiles.h>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDspaceRecordedFiles);

struct vtkDspaceRecordedFiles::Internals {
  dspace::HomeProcess home;
  std::optional<dspace::session::RecordingReader> reader;
  std::optional<dspace::session::RecordedFiles> files; // goes before the reader
  dspace::session::RecordingThread thread;             // goes first
};

vtkDspaceRecordedFiles::vtkDspaceRecordedFiles() : Impl(std::make_unique<Internals>()) {}

vtkDspaceRecordedFiles::~vtkDspaceRecordedFiles() {
  if (!this->Impl->home.IsHere()) {
    (void)this->Impl.release(); // HomeProcess.h
  }
}

void vtkDspaceRecordedFiles::BeginOpen(const std::string& recording, bool check,
                                       unsigned long long unpackLimit) {
  this->Close();
  this->Impl->thread.Begin(
      [=](dspace::v1::RecordingReply&, const dspace::session::CancelCheck& checkCancel) {
        this->Impl->reader.emplace(recording);
        this->Impl->reader->SetUnpackLimit(unpackLimit);
        this->Impl->files.emplace(*this->Impl->reader, check, checkCancel);
      });
}

void vtkDspaceRecordedFiles::BeginUpdate() {
  this->Impl->thread.Begin(
      [this](dspace::v1::RecordingReply&, const dspace::session::CancelCheck&) {
        if (this->Impl->files) {
          this->Impl->files->Update();
        }
      });
}

bool vtkDspaceRecordedFiles::Wait(double seconds) {
  return this->Impl->thread.Wait(seconds);
}

std::string vtkDspaceRecordedFiles::TakeReply() {
  return this->Impl->thread.TakeReply();
}

void vtkDspaceRecordedFiles::Cancel() {
  this->Impl->thread.End();
}

std::string vtkDspaceRecordedFiles::GetFolder() {
  return this->Impl->files ? this->Impl->files->Folder() : std::string();
}

std::string vtkDspaceRecordedFiles::Locate(const std::string& path) {
  return this->Impl->files ? this->Impl->files->Locate(path) : path;
}

std::string vtkDspaceRecordedFiles::Map(const std::string& bytes) {
  dspace::v1::Command command;
  if (!this->Impl->files || this->Impl->files->Folder().empty() ||
      bytes.find('/') == std::string::npos || !command.ParseFromString(bytes)) {
    return bytes;
  }
  this->Impl->files->Map(command);
  return command.SerializeAsString();
}

dspace::FilesGuard::Check vtkDspaceRecordedFiles::GetLook() const {
  return this->Impl->files ? this->Impl->files->Look() : dspace::FilesGuard::Check();
}

void vtkDspaceRecordedFiles::FillIn(dspace::v1::Command& command) {
  if (this->Impl->files) {
    this->Impl->files->FillIn(command);
  }
}

void vtkDspaceRecordedFiles::Close() {
  this->Impl->thread.End();
  this->Impl->files.reset();
  this->Impl->reader.reset();
}

void vtkDspaceRecordedFiles::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Folder: " << this->GetFolder() << "\n";
}
