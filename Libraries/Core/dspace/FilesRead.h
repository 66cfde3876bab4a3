// Which files are read for a command: a recording notes them, whoever names them.
#ifndef DSPACE_FILES_READ_H
#define DSPACE_FILES_READ_H

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace dspace {

// A file when it was read: what is recorded of it later must still be that.
struct FileStamp {
  std::int64_t size = -1;       // bytes; -1: it could not be asked
  std::int64_t changed_ns = -1; // time of the last change, past 1970 UTC

  static FileStamp Of(const std::string& path);
  bool operator==(const FileStamp& other) const {
    return this->size == other.size && this->changed_ns == other.changed_ns;
  }
};

// By absolute path, as it was opened: ".." behind a link is the operating system's to resolve.
using FilesRead = std::map<std::string, FileStamp>;

// Gathers what this thread reads while it lives. What an inner one gathers, the outer one has too.
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

// While it lives, this thread's NoteFileRead shows each file to `look`, which throws for one that
// is not to be read. Whoever opens a file does so after NoteFileRead; of a raster or a file of
// shapes also what belongs to it is shown, before anything of it is used.
//
// A guard acts on one thread. An object that reads a file again later, perhaps in another thread,
// keeps Current() from the time when it opened the file and holds a guard with it while it reads.
class FilesGuard {
public:
  using Look = std::function<void(const std::string& path)>;
  // With an empty `look` there is no guard.
  explicit FilesGuard(Look look);
  ~FilesGuard();
  FilesGuard(const FilesGuard&) = delete;
  FilesGuard& operator=(const FilesGuard&) = delete;

  static bool Lives();
  // The looks of all guards of this thread as one; empty where no guard lives.
  static Look Current();
  // Shows a file that is not noted. Throws what `look` throws.
  static void Show(const std::string& path);

private:
  Look Look_;
  FilesGuard* Outer_;
};

// Throws Error(Unsupported) for a path that is not UTF-8: no command, reply or recording could hold
// it.
void RequireUtf8Path(const std::string& path);

// Told by whoever opens a file; where no scope lives nothing is noted. The first stamp of a file
// stays. Throws what RequireUtf8Path throws of the path, made absolute. Files of a cache count too:
// say again what was read when it was filled.
void NoteFileRead(const std::string& path);
void NoteFilesRead(const FilesRead& files);

} // namespace dspace

#endif
