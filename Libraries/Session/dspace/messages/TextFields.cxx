#include <dspace/messages/TextFields.h>

#include <vector>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

namespace dspace::session {
namespace {

using Field = google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

std::vector<const Field*> SetFields(const Message& message) {
  std::vector<const Field*> fields;
  message.GetReflection()->ListFields(message, &fields);
  return fields;
}

} // namespace

const Field* FindInvalidText(const Message& message) {
  const Reflection& of = *message.GetReflection();
  std::string scratch;
  for (const Field* field : SetFields(message)) {
    const bool text = field->type() == Field::TYPE_STRING;
    if (!text && field->cpp_type() != Field::CPPTYPE_MESSAGE) {
      continue;
    }
    const int n = field->is_repeated() ? of.FieldSize(message, field) : 1;
    for (int i = 0; i < n; ++i) {
      if (text) {
        if (!IsUtf8(field->is_repeated()
                        ? of.GetRepeatedStringReference(message, field, i, &scratch)
                        : of.GetStringReference(message, field, &scratch))) {
          return field;
        }
      } else if (const Field* below =
                     FindInvalidText(field->is_repeated() ? of.GetRepeatedMessage(message, field, i)
                                                          : of.GetMessage(message, field))) {
        return below;
      }
    }
  }
  return nullptr;
}

void RequireUtf8(const Message& message, const std::string& object) {
  if (const Field* field = FindInvalidText(message)) {
    throw Error(Error::Kind::InvalidArgument, object,
                "its field '" + field->name() + "' is not UTF-8; accepted: text of UTF-8");
  }
}

void MakeTextUtf8(Message& message) {
  if (!FindInvalidText(message)) {
    return;
  }
  const Reflection& of = *message.GetReflection();
  for (const Field* field : SetFields(message)) {
    const int n = field->is_repeated() ? of.FieldSize(message, field) : 1;
    for (int i = 0; i < n; ++i) {
      if (field->cpp_type() == Field::CPPTYPE_MESSAGE) {
        MakeTextUtf8(field->is_repeated() ? *of.MutableRepeatedMessage(&message, field, i)
                                          : *of.MutableMessage(&message, field));
      } else if (field->type() == Field::TYPE_STRING && field->is_repeated()) {
        of.SetRepeatedString(&message, field, i, ToUtf8(of.GetRepeatedString(message, field, i)));
      } else if (field->type() == Field::TYPE_STRING) {
        of.SetString(&message, field, ToUtf8(of.GetString(message, field)));
      }
    }
  }
}

} // namespace dspace::session
