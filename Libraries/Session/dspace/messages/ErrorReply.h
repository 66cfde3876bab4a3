// Errors as messages, and as replies of classes that must not throw. Inside the library only.
#ifndef DSPACE_SESSION_ERROR_REPLY_H
#define DSPACE_SESSION_ERROR_REPLY_H

#include <exception>
#include <string>

#include <dspace/Error.h>
#include <dspace/Utf8.h>
#include <dspace/messages/Convert.h>
#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Both texts may quote a file, a library or another process, and are converted to UTF-8.
inline void PutError(v1::Error* error, v1::Error::Kind kind, const std::string& object,
                     const std::string& message) {
  error->set_kind(kind);
  error->set_object(ToUtf8(object));
  error->set_message(ToUtf8(message));
}

inline v1::Reply ErrorReply(v1::Error::Kind kind, const std::string& object,
                            const std::string& message) {
  v1::Reply reply;
  PutError(reply.mutable_error(), kind, object, message);
  return reply;
}

// The result of `work`, or the error that it throws.
template<class Work> v1::Reply Catch(Work work) {
  try {
    return work();
  } catch (const Error& error) {
    return ErrorReply(FromKind(error.GetKind()), error.GetObjectName(), error.what());
  } catch (const std::exception& error) {
    return ErrorReply(v1::Error::INTERNAL, "link", error.what());
  }
}

inline v1::Reply NotACommand() {
  return ErrorReply(v1::Error::CORRUPT, "command", "command: the bytes are not a Command message");
}

} // namespace dspace::session

#endif
