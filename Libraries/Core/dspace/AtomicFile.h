// Writes a file atomically: the target is replaced as a whole or not at all.
#ifndef DSPACE_ATOMIC_FILE_H
#define DSPACE_ATOMIC_FILE_H

#include <cstddef>
#include <cstdint>
#include <string>

#include <sys/types.h>

namespace dspace {

// Writes a temporary file in the target's folder. Commit() flushes it to the disk and renames it to
// the target. Until then, and after any failure, an existing target is untouched; the destructor
// removes a temporary file that was not committed.
//
// A new file has the mode of an ordinary creation (0666 less the umask), a replaced one keeps its
// mode. A symbolic link is followed: the file that it leads to is replaced, and the link stays. A
// link that leads to no file is rejected, because the place where the file would appear was never
// checked by the caller. A target that may not be written (mode 0444) is rejected, as are folders,
// devices, pipes and sockets.
//
// After a power failure the target is the earlier file or the new one, never a part of one. A
// process that is killed leaves its temporary file, ".NAME.DIGITS.part": the digits are its process
// id and a random number, 8 hexadecimal each.
//
// Every method throws Error: Io with the file and the system's reason, for all that the system
// reports (full disk, missing folder, missing permission, name too long); InvalidArgument for a
// path with a zero byte.
class AtomicFile {
public:
  // Creates the temporary file. `object` names the file in errors; default: "file 'PATH'".
  explicit AtomicFile(const std::string& path, const std::string& object = "");
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Appends.
  void Write(const void* data, std::size_t bytes);
  // Writes at an offset from the beginning, which Bytes() does not count [bytes].
  void WriteAt(std::uint64_t offset, const void* data, std::size_t bytes);
  // The number of bytes that Write() has appended.
  std::uint64_t Bytes() const { return this->Bytes_; }

  // For libraries that write to a path themselves. The file exists and is empty; a library may
  // also replace it. The library must have closed it before Commit().
  const std::string& TemporaryPath() const { return this->Temporary_; }

  // Once, at the end. The target is complete when it returns.
  void Commit();

  // All at once.
  static void Save(const std::string& path, const void* data, std::size_t bytes);

  // Throws what the constructor would throw for this path, and creates nothing.
  static void Check(const std::string& path);

  // The target's name of a temporary file's name, cut after its first 64 bytes; "" for the name of
  // any other file. Names without folder.
  static std::string TargetName(const std::string& temporary);

private:
  [[noreturn]] void Fail(int reason) const;
  void CloseFile();

  std::string Object_;
  std::string Target_; // with links resolved
  std::string Temporary_;
  int File_ = -1;
  mode_t Mode_ = 0;
  std::uint64_t Bytes_ = 0;
  bool Committed_ = false;
};

} // namespace dspace

#endif
