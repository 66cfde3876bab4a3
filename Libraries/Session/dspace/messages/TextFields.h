// The text in messages: protobuf accepts a message only where each of its texts is UTF-8. Inside
// the library only.
#ifndef DSPACE_SESSION_TEXT_FIELDS_H
#define DSPACE_SESSION_TEXT_FIELDS_H

#include <string>

#include <google/protobuf/message.h>

namespace dspace::session {

// The first field of text, at any depth, that is not UTF-8; null where all are. Unknown fields and
// fields of bytes hold no text.
const google::protobuf::FieldDescriptor* FindInvalidText(const google::protobuf::Message& message);

// Throws Error(InvalidArgument) naming `object` and that field, if there is one.
void RequireUtf8(const google::protobuf::Message& message, const std::string& object);

// The last guard before a message leaves: every text that is not UTF-8 is made so (Utf8.h). A
// receiver could not parse the message otherwise, and would wait for it for ever.
void MakeTextUtf8(google::protobuf::Message& message);

} // namespace dspace::session

#endif
