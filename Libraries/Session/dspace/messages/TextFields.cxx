#include <dspace/messages/TextFields.h>

#include <algorithm>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

namespace dspace::session {
namespace {

using Field = google::protobuf::FieldDescriptor;
using google::protobuf::Descriptor;
using google::protobuf::Message;
using google::protobuf::OneofDescriptor;
using google::protobuf::Reflection;

bool IsMessage(const Field& field) {
  return field.cpp_type() == Field::CPPTYPE_MESSAGE;
}

// Whether a message of this kind can hold text, at any depth. `seen`: kinds that have been looked
// at.
bool CanHoldText(const Descriptor& kind, std::set<const Descriptor*>& seen) {
  if (!seen.insert(&kind).second) {
    return false;
  }
  for (int i = 0; i < kind.field_count(); ++i) {
    const Field& field = *kind.field(i);
    if (field.type() == Field::TYPE_STRING ||
        (IsMessage(field) && CanHoldText(*field.message_type(), seen))) {
      return true;
    }
  }
  return false;
}

// Of a kind of message, what is text or leads to some: the other fields, which are most, need no
// look. This is done for each command and reply.
struct TextPlan {
  std::vector<const Field*> fields; // outside of oneofs
  std::vector<const OneofDescriptor*> oneofs;
  std::unordered_set<const Field*> chosen; // fields of the oneofs
};

const TextPlan& PlanOf(const Message& message) {
  thread_local std::unordered_map<const Descriptor*, TextPlan> known;
  const Descriptor* kind = message.GetDescriptor();
  const auto [found, isNew] = known.try_emplace(kind);
  TextPlan& plan = found->second; // stays where it is while others are added
  for (int i = 0; isNew && i < kind->field_count(); ++i) {
    const Field& field = *kind->field(i);
    std::set<const Descriptor*> seen;
    if (field.type() == Field::TYPE_STRING ||
        (IsMessage(field) && CanHoldText(*field.message_type(), seen))) {
      if (const OneofDescriptor* oneof = field.real_containing_oneof()) {
        plan.chosen.insert(&field);
        if (plan.oneofs.empty() || plan.oneofs.back() != oneof) {
          plan.oneofs.push_back(oneof);
        }
      } else {
        plan.fields.push_back(&field);
      }
    }
  }
  return plan;
}

// Calls visit(field) for each set field that is text or leads to some, until it returns true.
template<typename Visit> bool AnyField(const Message& message, Visit&& visit) {
  const TextPlan& plan = PlanOf(message);
  if (std::any_of(plan.fields.begin(), plan.fields.end(), visit)) {
    return true;
  }
  return std::any_of(plan.oneofs.begin(), plan.oneofs.end(), [&](const OneofDescriptor* oneof) {
    const Field* field = message.GetReflection()->GetOneofFieldDescriptor(message, oneof);
    return field && plan.chosen.count(field) != 0 && visit(field);
  });
}

int CountOf(const Message& message, const Field& field) {
  const Reflection& of = *message.GetReflection();
  return field.is_repeated() ? of.FieldSize(message, &field) : of.HasField(message, &field) ? 1 : 0;
}

} // namespace

const Field* FindInvalidText(const Message& message) {
  const Reflection& of = *message.GetReflection();
  const Field* invalid = nullptr;
  AnyField(message, [&](const Field* field) {
    std::string scratch;
    const bool many = field->is_repeated();
    const int n = CountOf(message, *field);
    for (int i = 0; !invalid && i < n; ++i) {
      if (IsMessage(*field)) {
        invalid = FindInvalidText(many ? of.GetRepeatedMessage(message, field, i)
                                       : of.GetMessage(message, field));
      } else if (!IsUtf8(many ? of.GetRepeatedStringReference(message, field, i, &scratch)
                              : of.GetStringReference(message, field, &scratch))) {
        invalid = field;
      }
    }
    return invalid != nullptr;
  });
  return invalid;
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
  AnyField(message, [&](const Field* field) {
    const int n = CountOf(message, *field);
    for (int i = 0; i < n; ++i) {
      if (IsMessage(*field)) {
        MakeTextUtf8(field->is_repeated() ? *of.MutableRepeatedMessage(&message, field, i)
                                          : *of.MutableMessage(&message, field));
      } else if (field->is_repeated()) {
        of.SetRepeatedString(&message, field, i, ToUtf8(of.GetRepeatedString(message, field, i)));
      } else {
        of.SetString(&message, field, ToUtf8(of.GetString(message, field)));
      }
    }
    return false;
  });
}

} // namespace dspace::session
