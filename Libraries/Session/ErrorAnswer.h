// Errors of the classes for Python that need no session. Inside the module only.
#ifndef DSPACE_SESSION_ERROR_ANSWER_H
#define DSPACE_SESSION_ERROR_ANSWER_H

#include <string>

#include <dspace/messages/ErrorReply.h>

namespace dspace::session {

// The error that `work` throws, as a serialized Reply; empty: none.
template<class Work> std::string ErrorAnswer(Work work) {
  const v1::Reply failed = Catch([&] {
    work();
    return v1::Reply();
  });
  return failed.has_error() ? failed.SerializeAsString() : std::string();
}

} // namespace dspace::session

#endif
