// A unique name of a process, with which a server on the same machine detects that a client has
// died.
#ifndef DSPACE_SESSION_PROCESS_NAME_H
#define DSPACE_SESSION_PROCESS_NAME_H

#include <string>

namespace dspace::session {

// The name of this process: boot id, pid namespace, pid, start time. Empty without /proc.
std::string ProcessName();

// Whether the process of this name has certainly died. False for a running process, for a process
// of another machine, boot or container, and for an invalid name.
bool HasDied(const std::string& name);

} // namespace dspace::session

#endif
