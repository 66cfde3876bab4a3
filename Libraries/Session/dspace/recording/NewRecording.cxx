#include <dspace/recording/NewRecording.h>

#include <filesystem>

#include <dspace/Error.h>
#include <dspace/recording/RecordingDatabase.h>

namespace dspace::session {

NewRecording::NewRecording(const std::string& path)
    : Target_(std::filesystem::absolute(path).string()), Name_(RecordingName(this->Target_)) {
  const std::string folder = std::filesystem::path(this->Target_).parent_path().string();
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    throw Error(Error::Kind::NotFound, this->Name_,
                "there is no folder '" + folder + "'; accepted: a folder that exists");
  }
  this->RequireNone();
  try {
    this->File_ = std::make_unique<AtomicFile>(this->Target_, this->Name_);
  } catch (const Error& failure) {
    if (failure.GetKind() != Error::Kind::Io) {
      throw;
    }
    const std::string reason = std::string(failure.what()).substr(this->Name_.size() + 2);
    throw Error(Error::Kind::Io, this->Name_,
                reason + "; accepted: a new file in a folder that may be written and has room");
  }
}

NewRecording::~NewRecording() {
  for (const char* end : {"-wal", "-shm", "-journal"}) { // of SQLite, where it was broken off
    std::error_code ignored;
    std::filesystem::remove(this->Path() + end, ignored);
  }
}

void NewRecording::RequireNone() const {
  std::error_code error;
  if (std::filesystem::exists(std::filesystem::symlink_status(this->Target_, error))) {
    throw Error(Error::Kind::AlreadyExists, this->Name_,
                "there is such a file; accepted: a new one");
  }
}

const std::string& NewRecording::Path() const {
  return this->File_->TemporaryPath();
}

void NewRecording::Keep() {
  this->RequireNone();
  this->File_->Commit();
}

} // namespace dspace::session
