#include <dspace/messages/CommandTexts.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include <google/protobuf/descriptor.h>

#include <dspace/Error.h>
#include <dspace/proto/commands.pb.h>

namespace dspace::session {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

bool IsText(const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_STRING;
}

TextKind KindOf(const FieldDescriptor& field) {
  switch (field.options().GetExtension(v1::holds)) {
  case v1::TextOptions::PLAIN:
    return TextKind::Plain;
  case v1::TextOptions::READ_FILE:
    return TextKind::ReadFile;
  case v1::TextOptions::NEW_FILE:
    return TextKind::NewFile;
  case v1::TextOptions::CRS:
    return TextKind::Crs;
  case v1::TextOptions::DATA:
    return TextKind::Data;
  default:
    throw Error(Error::Kind::Internal, "field " + field.full_name(),
                "the option `(holds)` is missing: say whether the text is PLAIN, READ_FILE, "
                "NEW_FILE, DATA or CRS "
                "(options.proto)");
  }
}

// What may hold texts, for each kind of message that a command can hold: others need no look.
class TextTree {
public:
  static const TextTree& Get() {
    static const TextTree tree;
    return tree;
  }
  const std::vector<const FieldDescriptor*>& FieldsOf(const Descriptor* message) const {
    static const std::vector<const FieldDescriptor*> none;
    const auto found = this->Fields_.find(message);
    return found == this->Fields_.end() ? none : found->second;
  }
  TextKind Kind(const FieldDescriptor* field) const { return this->Kinds_.at(field); }

private:
  TextTree() {
    std::set<const Descriptor*> open;
    this->Visit(v1::Command::descriptor(), open);
  }
  bool Visit(const Descriptor* message, std::set<const Descriptor*>& seen) {
    if (!seen.insert(message).second) {
      return !this->FieldsOf(message).empty();
    }
    std::vector<const FieldDescriptor*> fields;
    for (int i = 0; i < message->field_count(); ++i) {
      const FieldDescriptor* field = message->field(i);
      if (IsText(*field)) {
        this->Kinds_[field] = KindOf(*field);
        fields.push_back(field);
      } else if (field->message_type() && this->Visit(field->message_type(), seen)) {
        fields.push_back(field);
      }
    }
    const bool any = !fields.empty();
    this->Fields_[message] = std::move(fields);
    return any;
  }
  std::map<const Descriptor*, std::vector<const FieldDescriptor*>> Fields_;
  std::map<const FieldDescriptor*, TextKind> Kinds_;
};

} // namespace

bool HoldsText(const Descriptor& message, TextKind kind) {
  const TextTree& tree = TextTree::Get();
  const std::vector<const FieldDescriptor*>& fields = tree.FieldsOf(&message);
  return std::any_of(fields.begin(), fields.end(), [&](const FieldDescriptor* field) {
    return IsText(*field) ? tree.Kind(field) == kind : HoldsText(*field->message_type(), kind);
  });
}

void ForEachText(const Message& message, const VisitText& visit) {
  const auto* reflection = message.GetReflection();
  std::string scratch;
  for (const FieldDescriptor* field : TextTree::Get().FieldsOf(message.GetDescriptor())) {
    const bool one = !field->is_repeated();
    const int n = one ? (reflection->HasField(message, field) ? 1 : 0)
                      : reflection->FieldSize(message, field);
    for (int i = 0; i < n; ++i) {
      if (IsText(*field)) {
        visit(one ? reflection->GetStringReference(message, field, &scratch)
                  : reflection->GetRepeatedStringReference(message, field, i, &scratch),
              *field, TextTree::Get().Kind(field));
      } else {
        ForEachText(one ? reflection->GetMessage(message, field)
                        : reflection->GetRepeatedMessage(message, field, i),
                    visit);
      }
    }
  }
}

void ChangeTexts(Message& message, const ChangeText& change) {
  const auto* reflection = message.GetReflection();
  std::string scratch;
  for (const FieldDescriptor* field : TextTree::Get().FieldsOf(message.GetDescriptor())) {
    const bool one = !field->is_repeated();
    const int n = one ? (reflection->HasField(message, field) ? 1 : 0)
                      : reflection->FieldSize(message, field);
    if (IsText(*field) && TextTree::Get().Kind(field) == TextKind::Data) {
      continue;
    }
    for (int i = 0; i < n; ++i) {
      if (!IsText(*field)) {
        ChangeTexts(one ? *reflection->MutableMessage(&message, field)
                        : *reflection->MutableRepeatedMessage(&message, field, i),
                    change);
        continue;
      }
      const std::string before =
          one ? reflection->GetStringReference(message, field, &scratch)
              : reflection->GetRepeatedStringReference(message, field, i, &scratch);
      const std::string after = change(before, *field, TextTree::Get().Kind(field));
      if (after != before) {
        one ? reflection->SetString(&message, field, after)
            : reflection->SetRepeatedString(&message, field, i, after);
      }
    }
  }
}

} // namespace dspace::session
