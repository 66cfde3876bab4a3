// The text fields of commands and their content: a file, a coordinate system, or neither. Not a
// public header.
#ifndef DSPACE_SESSION_COMMAND_TEXTS_H
#define DSPACE_SESSION_COMMAND_TEXTS_H

#include <functional>
#include <string>

namespace google::protobuf {
class Descriptor;
class FieldDescriptor;
class Message;
} // namespace google::protobuf

namespace dspace::session {

// As TextOptions in options.proto.
enum class TextKind { Plain, ReadFile, NewFile, Crs, Data };

// Whether the message has a text field of this kind at any depth. Throws Error(Internal) for a text
// field without the option `(holds)`, naming it.
bool HoldsText(const google::protobuf::Descriptor& message, TextKind kind);

// Calls `visit` with every present text, at any depth. The message is a command or a part of one.
using VisitText = std::function<void(
    const std::string& text, const google::protobuf::FieldDescriptor& field, TextKind kind)>;
void ForEachText(const google::protobuf::Message& message, const VisitText& visit);

// Replaces every present text, except DATA, by the result of `change`.
using ChangeText = std::function<std::string(
    const std::string& text, const google::protobuf::FieldDescriptor& field, TextKind kind)>;
void ChangeTexts(google::protobuf::Message& message, const ChangeText& change);

} // namespace dspace::session

#endif
