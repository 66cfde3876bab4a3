// Text inside serialized messages. Not a public header.
#ifndef DSPACE_SESSION_WIRE_TEXT_H
#define DSPACE_SESSION_WIRE_TEXT_H

#include <optional>
#include <string>

namespace google::protobuf {
class Descriptor;
}

namespace dspace::session {

// The bytes of a message of this type with all of its text as UTF-8 (Utf8.h), as recordings of
// earlier versions need it: protobuf takes no message with other text. None where all text is UTF-8
// or the bytes are no message. Other fields stay as they are, unknown ones too.
std::optional<std::string> WithTextUtf8(const std::string& message,
                                        const google::protobuf::Descriptor& type);

// The same for messages that each follow their length (a varint).
std::optional<std::string> WithTextUtf8OfAll(const std::string& messages,
                                             const google::protobuf::Descriptor& type);

} // namespace dspace::session

#endif
