// The text in messages: protobuf accepts a message only where each of its texts is UTF-8. Inside
// the library only.
#ifndef DSPACE_MESSAGES_TEXT_FIELDS_H
#define DSPACE_MESSAGES_TEXT_FIELDS_H

#include <google/protobuf/message.h>

namespace dspace::session {

// The first field of text, at any depth, that is not UTF-8; null where all are. Unknown fields and
// fields of bytes hold no text.
const google::protobuf::FieldDescriptor* FindForeignText(const google::protobuf::Message& message);

// The last guard before a message leaves: every text that is not UTF-8 is made so (Utf8.h). A
// receiver could not parse the message otherwise, and would wait for it for ever.
void MakeTextUtf8(google::protobuf::Message& message);

} // namespace dspace::session

#endif
