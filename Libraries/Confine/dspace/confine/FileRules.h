// Which files this process may open from now on, by the kernel's Landlock.
#ifndef DSPACE_CONFINE_FILERULES_H
#define DSPACE_CONFINE_FILERULES_H

#include <cstdint>
#include <string>

namespace dspace::confine {

enum class FileAccess : std::uint8_t {
  Read,    // read files, list folders
  Program, // the same, and execute
  Write,   // the same as Read, and write, create, rename and remove files and folders
  Socket,  // create and remove Unix sockets in a folder
  Device   // read and write a device, and its ioctl calls
};

// A file that no rule allows can then be neither opened nor created, renamed or removed, by this
// process and all that come from it, as long as they live. The rules hold for files as the kernel
// finds them, with links resolved, and for folders with all below. Descriptors that are open stay
// usable, and names, sizes and times of files can still be asked for.
//
// Kernels have different versions (ABI) of Landlock: 1 (Linux 5.13) files; 2 (5.19) allows renaming
// between folders; 3 (6.2) truncating by name; 4 (6.7) TCP ports; 5 (6.10) ioctl calls of devices;
// 6 (6.12) signals and abstract sockets to other processes. What a version lacks stays unrestricted
// (CallFilter makes up for part of it), except renaming between folders, which version 1 forbids.
class FileRules {
public:
  // The version of the running kernel; 0: none, or turned off.
  static int KernelAbi();

  // abi: the version to use, at most the kernel's; 0: no rule has an effect. listen, connect: TCP
  // ports may be bound, and connected to. Throws std::system_error.
  FileRules(int abi, bool listen, bool connect);
  ~FileRules();
  FileRules(const FileRules&) = delete;
  FileRules& operator=(const FileRules&) = delete;

  // Throws std::system_error, which names the path, also where there is no such file.
  void Allow(const std::string& path, FileAccess access);

  // From now on, for good. The process has one thread; no-new-privileges is set. Throws
  // std::system_error.
  void Enforce() const;

private:
  std::uint64_t Handled_ = 0;
  int Ruleset_ = -1;
};

} // namespace dspace::confine

#endif
