// Replies of the classes that read recordings for Python. Inside the module only.
#ifndef DSPACE_SESSION_RECORDING_REPLIES_H
#define DSPACE_SESSION_RECORDING_REPLIES_H

#include <string>

#include <dspace/messages/ErrorReply.h>
#include <dspace/proto/recordings.pb.h>

namespace dspace::session {

// The serialized reply that `work` fills in, or the error that it throws.
template<class Work> std::string RecordingAnswer(Work work) {
  v1::RecordingReply reply;
  const v1::Reply failed = Catch([&] {
    work(reply);
    return v1::Reply();
  });
  if (failed.has_error()) {
    reply.Clear();
    *reply.mutable_error() = failed.error();
  }
  return reply.SerializeAsString();
}

} // namespace dspace::session

#endif
