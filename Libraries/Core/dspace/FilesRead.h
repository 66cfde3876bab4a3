// Tracks and restricts which files a command reads.
#ifndef DSPACE_FILES_READ_H
#define DSPACE_FILES_READ_H

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace dspace {

// Identifies the state of a file at the time of reading. A recording stores the file only if its
// stamp is still the same.
struct FileStamp {
  std::int64_t size = -1;       // bytes; -1: unknown
  std::int64_t changed_ns = -1; // time of the last change since 1970 UTC; -1: unknown

  static FileStamp Of(const std::string& path);
  bool operator==(const FileStamp& other) const {
    return this->size == other.size && this->changed_ns == other.changed_ns;
  }
};

// Keys are absolute paths as opened. ".." is not resolved, because it may follow a symbolic link.
using FilesRead = std::map<std::string, FileStamp>;

// Collects the files that this thread reads during the scope's lifetime. Scopes nest: at its end an
// inner scope adds its files to the outer one.
class FilesReadScope {
public:
  FilesReadScope();
  ~FilesReadScope();
  FilesReadScope(const FilesReadScope&) = delete;
  FilesReadScope& operator=(const FilesReadScope&) = delete;

  const FilesRead& Files() const { return this->Files_; }

private:
  friend void NoteFileRead(const std::string& path);
  friend void NoteFilesRead(const FilesRead& files);
  FilesRead Files_;
  FilesReadScope* Outer_;
};

// During the guard's lifetime, every file that this thread passes to NoteFileRead is first passed
// to `check`, which throws to reject it. Code that opens a file must call NoteFileRead before it.
// For rasters and vector files, side files are checked as well, before any content is used.
//
// A guard applies to one thread. An object that reads a file again later, possibly in another
// thread, stores Current() when it opens the file and holds a guard with that check while it reads.
class FilesGuard {
public:
  using Check = std::function<void(const std::string& path)>;
  // An empty `check` installs no guard.
  explicit FilesGuard(Check check);
  ~FilesGuard();
  FilesGuard(const FilesGuard&) = delete;
  FilesGuard& operator=(const FilesGuard&) = delete;

  // Whether this thread has a guard.
  static bool IsActive();
  // The checks of all guards of this thread as one function; empty without a guard.
  static Check Current();
  // Checks a file without noting it. Throws what the check throws.
  static void CheckFile(const std::string& path);

private:
  Check Check_;
  FilesGuard* Outer_;
};

// Throws Error(Unsupported) for a path that is not UTF-8, because commands, replies and recordings
// cannot hold it.
void RequireUtf8Path(const std::string& path);

// Call before opening a file. Checks the path against the guards and adds it to the current scope,
// if any. The first stamp of a file is kept. Throws what RequireUtf8Path throws for the absolute
// path, and what a guard throws. Cached results count as reads: note the files again from which a
// cache entry was made.
void NoteFileRead(const std::string& path);
void NoteFilesRead(const FilesRead& files);

} // namespace dspace

#endif
