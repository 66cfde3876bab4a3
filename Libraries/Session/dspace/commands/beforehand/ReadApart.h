// Threads that read files while nobody waits for their end.
#ifndef DSPACE_SESSION_READ_APART_H
#define DSPACE_SESSION_READ_APART_H

#include <functional>

namespace dspace::session {

// Runs `read` in a thread of its own, which owns what it uses and throws nothing. Throws
// Error(Resource) if there can be no more threads.
void ReadApart(std::function<void()> read);

// Whether all of these threads have ended; waits for it up to this time [s]. A program asks before
// it ends: GDAL and PROJ may be in use until then.
bool WaitForReaders(double seconds);

} // namespace dspace::session

#endif
