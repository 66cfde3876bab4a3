#include <dspace/FilesRead.h>

#include <filesystem>
#include <utility>
#include <vector>

#include <sys/stat.h>

#include <dspace/Error.h>
#include <dspace/SystemFiles.h>
#include <dspace/Utf8.h>

namespace dspace {
namespace {

thread_local FilesReadScope* Innermost = nullptr;
thread_local FilesGuard* Guard = nullptr;

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
  if (Innermost) {
    Innermost->Files_.insert(this->Files_.begin(), this->Files_.end());
  }
}

FilesGuard::FilesGuard(Check check) : Check_(std::move(check)), Outer_(Guard) {
  if (this->Check_) {
    Guard = this;
  }
}

FilesGuard::~FilesGuard() {
  Guard = this->Outer_;
}

bool FilesGuard::IsActive() {
  return Guard != nullptr;
}

FilesGuard::Check FilesGuard::Current() {
  if (!Guard) {
    return {};
  }
  if (!Guard->Outer_) {
    return Guard->Check_;
  }
  std::vector<Check> checks;
  for (const FilesGuard* guard = Guard; guard; guard = guard->Outer_) {
    checks.push_back(guard->Check_);
  }
  return [checks](const std::string& path) {
    for (const Check& check : checks) {
      check(path);
    }
  };
}

void FilesGuard::CheckFile(const std::string& path) {
  for (const FilesGuard* guard = Guard; guard; guard = guard->Outer_) {
    guard->Check_(path);
  }
}

void RequireUtf8Path(const std::string& path) {
  if (!IsUtf8(path)) {
    throw Error(Error::Kind::Unsupported, "file '" + path + "'",
                "its name, or that of a folder above it, is not UTF-8; accepted: names in UTF-8, "
                "which commands and recordings can hold");
  }
}

void NoteFileRead(const std::string& path) {
  std::error_code error;
  const std::string whole = std::filesystem::absolute(path, error).string();
  RequireUtf8Path(error ? path : whole);
  FilesGuard::CheckFile(path);
  if (!Innermost || path.empty()) {
    return;
  }
  Innermost->Files_.emplace(error ? path : whole, FileStamp::Of(path));
}

void NoteSystemFile(const std::string& path) {
  FilesGuard* const guard = std::exchange(Guard, nullptr);
  NoteFileRead(path);
  Guard = guard;
}

void NoteFilesRead(const FilesRead& files) {
  if (Guard) {
    for (const auto& [path, stamp] : files) {
      FilesGuard::CheckFile(path);
    }
  }
  if (Innermost) {
    Innermost->Files_.insert(files.begin(), files.end());
  }
}

} // namespace dspace
