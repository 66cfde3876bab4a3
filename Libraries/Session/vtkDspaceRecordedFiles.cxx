#include "vtkDspaceRecordedFiles.h"

#include <optional>

#include <dspace/HomeProcess.h>
#include <dspace/messages/ErrorReply.h>
#include <dspace/recording/RecordedFiles.h>

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkDspaceRecordedFiles);

struct vtkDspaceRecordedFiles::Internals {
  dspace::HomeProcess home;
  std::optional<dspace::session::RecordingReader> reader;
  std::optional<dspace::session::RecordedFiles> files; // goes before the reader
};

vtkDspaceRecordedFiles::vtkDspaceRecordedFiles() : Impl(std::make_unique<Internals>()) {}

vtkDspaceRecordedFiles::~vtkDspaceRecordedFiles() {
  if (!this->Impl->home.IsHere()) {
    (void)this->Impl.release(); // HomeProcess.h
  }
}

std::string vtkDspaceRecordedFiles::Open(const std::string& recording, bool check) {
  this->Close();
  const dspace::v1::Reply reply = dspace::session::Catch([&] {
    this->Impl->reader.emplace(recording);
    this->Impl->files.emplace(*this->Impl->reader, check);
    return dspace::v1::Reply();
  });
  if (reply.has_error()) {
    this->Close();
  }
  return reply.SerializeAsString();
}

std::string vtkDspaceRecordedFiles::Update() {
  return dspace::session::Catch([&] {
           if (this->Impl->files) {
             this->Impl->files->Update();
           }
           return dspace::v1::Reply();
         })
      .SerializeAsString();
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
  this->Impl->files.reset();
  this->Impl->reader.reset();
}

void vtkDspaceRecordedFiles::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Folder: " << this->GetFolder() << "\n";
}
