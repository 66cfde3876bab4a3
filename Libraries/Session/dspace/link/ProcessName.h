// Which process a client is, so that a server on the same machine knows once it has died.
#ifndef DSPACE_SESSION_PROCESS_NAME_H
#define DSPACE_SESSION_PROCESS_NAME_H

#include <string>

namespace dspace::session {

// This process: the machine's boot, the namespace of its number, its number, when it began. Empty
// where the system does not say (/proc is not there).
std::string ProcessName();

// Whether the process that has this name is known to have died. False for one that lives, for one
// of another machine, boot or container, and for what is no such name.
bool HasDied(const std::string& name);

} // namespace dspace::session

#endif
