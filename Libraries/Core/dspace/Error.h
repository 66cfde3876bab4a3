// The only exception type of Dspace.
#ifndef DSPACE_ERROR_H
#define DSPACE_ERROR_H

#include <stdexcept>
#include <string>

#include <dspace/Utf8.h>

namespace dspace {

// Every plain class throws it when input is rejected or a resource fails. The message names the
// object, the value and what is accepted. State is then unchanged.
class Error : public std::runtime_error {
public:
  // The kind of failure, as distinguished by gRPC's status codes and Python's exceptions.
  enum class Kind {
    InvalidArgument,  // a value outside what is accepted
    NotFound,         // no such frame, object, file, ...
    AlreadyExists,    // a name or id that is taken
    Unsupported,      // a format or feature that is not read or built
    Corrupt,          // a file that is damaged or not of its type
    Io,               // the operating system rejected a file
    Resource,         // memory, size or graphics limits
    DeadlineExceeded, // a wait ran out
    Internal          // a defect of Dspace
  };

  // `object` names what the error is about: "frame 'rover/mast'", "file 'a.gltf'", "camera 'left'".
  // Both texts may quote a file or a library; they are kept in the form that ToUtf8 (Utf8.h)
  // returns.
  Error(Kind kind, const std::string& object, const std::string& message)
      : std::runtime_error(ToUtf8(object.empty() ? message : object + ": " + message)), Kind_(kind),
        Object_(ToUtf8(object)) {}

  Kind GetKind() const { return this->Kind_; }
  const std::string& GetObjectName() const { return this->Object_; }

private:
  Kind Kind_;
  std::string Object_;
};

} // namespace dspace

#endif
