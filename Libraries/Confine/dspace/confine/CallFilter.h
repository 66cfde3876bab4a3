// Which system calls this process may make from now on, by the kernel's seccomp.
#ifndef DSPACE_CONFINE_CALLFILTER_H
#define DSPACE_CONFINE_CALLFILTER_H

#include <vector>

#include <linux/filter.h>

namespace dspace::confine {

struct CallRules {
  bool listen = false;     // bind sockets of TCP and Unix paths, and accept connections
  bool listenUnix = false; // the same with Unix paths alone
  bool connect = false;    // connect, also by UDP
  bool truncate = false;   // shorten a file by its name, which Landlock restricts since version 3
};

// A rejected call fails with EPERM or, where libraries then try an older one, ENOSYS. Rejected are:
// - Sockets of other kinds than `rules` need, and messages to addresses through other sockets.
// - Changes of rights, owners and times by a file's name, which Landlock does not restrict. By an
//   open descriptor they are possible.
// - What reaches around Landlock or other processes: io_uring, ptrace, memory and limits of other
//   processes, memory and messages of System V and POSIX, handles of files, namespaces, mounts,
//   keys, BPF, faked input of a terminal.
// - Administration of the machine: modules, reboot, clocks, swap and the like.
//
// The process has one thread; no-new-privileges is set. Throws std::runtime_error.
void FilterCalls(const CallRules& rules);

// The filter of a process that only reads, for FilterCallsOfReader: it takes most of a millisecond
// to make. Rejected with EPERM are also:
// - All sockets but those that are open, and messages to addresses.
// - Opening a file to write, and changes of folders. Of what is open for reading: its rights,
//   owner, times and attributes, and all calls of devices.
// - Other programs and processes (threads are possible), and signals to other processes.
// - The own limits, users and capabilities, and the signal at the end of the parent.
// Throws std::runtime_error.
std::vector<sock_filter> CallsOfReader();

// From now on, for good. The process has one thread; no-new-privileges is set. Throws
// std::runtime_error.
void FilterCallsOfReader(const std::vector<sock_filter>& calls);

} // namespace dspace::confine

#endif
