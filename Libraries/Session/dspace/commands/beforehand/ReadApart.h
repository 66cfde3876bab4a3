// A thread that reads files.
#ifndef DSPACE_SESSION_READ_APART_H
#define DSPACE_SESSION_READ_APART_H

#include <functional>
#include <memory>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// The thread owns what `read` captures: this object may be destroyed before the thread ends.
class ReadApart {
public:
  // Starts `read`; an exception becomes the error of the reply, as Catch() has it. Throws
  // Error(Resource) if no thread can be started.
  explicit ReadApart(std::function<v1::Reply()> read);

  // Waits for the end up to this time [s].
  bool IsDone(double seconds) const;
  // Once IsDone().
  const v1::Reply& Reply() const;

  // Whether all of these threads of the process have ended; waits up to this time [s]. A program
  // asks before it ends, because GDAL and PROJ may be in use until then.
  static bool WaitForAll(double seconds);

private:
  struct Work;
  std::shared_ptr<Work> Work_;
};

} // namespace dspace::session

#endif
