// Objects with threads or graphics in a child that was forked from their process.
#ifndef DSPACE_HOME_PROCESS_H
#define DSPACE_HOME_PROCESS_H

#include <string>

#include <sys/types.h>
#include <unistd.h>

namespace dspace {

// A member of an object that cannot be used after fork(): the child has its memory, but none of its
// threads, and its graphics context and connections are the parent's. In the child the object
// rejects every use, and its destructor leaves alone what it owns.
class HomeProcess {
public:
  bool IsHere() const { return ::getpid() == this->Process_; }
  // "belongs to process 12, from which this one was forked; accepted: ..." for an error.
  std::string Message() const;

private:
  pid_t Process_ = ::getpid();
};

// From now on a child of this process that ends with exit() skips the exit handlers that were set
// before the fork, in any library: they would wait for threads that the child does not have. What
// the child sets itself is called, and its output is written. A second call does nothing.
void EndForkedChildrenAtOnce();

} // namespace dspace

#endif
