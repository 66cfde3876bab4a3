// UTF-8 checks of messages: protobuf rejects a message with text that is not UTF-8. Inside the
// library only.
#ifndef DSPACE_SESSION_TEXT_FIELDS_H
#define DSPACE_SESSION_TEXT_FIELDS_H

#include <string>

#include <google/protobuf/message.h>

namespace dspace::session {

// The first text field, at any depth, that is not UTF-8; null: all are. Unknown fields and bytes
// fields contain no text.
const google::protobuf::FieldDescriptor* FindInvalidText(const google::protobuf::Message& message);

// Throws Error(InvalidArgument) that names `object` and the first such field.
void RequireUtf8(const google::protobuf::Message& message, const std::string& object);

// Converts all text to UTF-8 (Utf8.h) before a message is sent. Otherwise the receiver could not
// parse the message and would wait forever.
void MakeTextUtf8(google::protobuf::Message& message);

} // namespace dspace::session

#endif
