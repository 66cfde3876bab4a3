#include <dspace/FilesRead.h>

#include <filesystem>

#include <sys/stat.h>

namespace dspace {
namespace {

thread_local FilesReadScope* Innermost = nullptr;

} // namespace

FileStamp FileStamp::Of(const std::string& path) {
  struct stat state = {};
  FileStamp stamp;
  if (::stat(path.c_str(), &state) == 0) {
    stamp.size = state.st_size;
    stamp.changed_ns = std::int64_t(state.st_mtim.tv_sec) * 1000000000 + state.st_mtim.tv_nsec;
  }
  return stamp;
}

FilesReadScope::FilesReadScope() : Outer_(Innermost) {
  Innermost = this;
}

FilesReadScope::~FilesReadScope() {
  Innermost = this->Outer_;
  NoteFilesRead(this->Files_);
}

void NoteFileRead(const std::string& path) {
  if (!Innermost || path.empty()) {
    return;
  }
  std::error_code error;
  const std::string whole = std::filesystem::absolute(path, error).string();
  Innermost->Files_.emplace(error ? path : whole, FileStamp::Of(path));
}

void NoteFilesRead(const FilesRead& files) {
  if (Innermost) {
    Innermost->Files_.insert(files.begin(), files.end());
  }
}

} // namespace dspace
