#include <dspace/messages/CommandLimits.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include <google/protobuf/descriptor.h>

#include <dspace/Checks.h>
#include <dspace/Error.h>
#include <dspace/messages/CommandTraits.h>
#include <dspace/proto/commands.pb.h>

namespace dspace::session {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

const v1::LimitOptions& LimitsOf(const FieldDescriptor& field) {
  return field.options().GetExtension(v1::accepts);
}

bool HasRange(const FieldDescriptor& field) {
  return LimitsOf(field).has_minimum() || LimitsOf(field).has_maximum();
}

// The fields of each kind of message that have a range, or lead to one.
class LimitTree {
public:
  static const LimitTree& Get() {
    static const LimitTree tree;
    return tree;
  }
  const std::vector<const FieldDescriptor*>& FieldsOf(const Descriptor* message) const {
    static const std::vector<const FieldDescriptor*> none;
    const auto found = this->Fields_.find(message);
    return found == this->Fields_.end() ? none : found->second;
  }

private:
  LimitTree() { this->Visit(v1::Command::descriptor()); }
  bool Visit(const Descriptor* message) {
    if (!this->Seen_.insert(message).second) {
      return this->Fields_.count(message) != 0;
    }
    std::vector<const FieldDescriptor*> fields;
    for (int i = 0; i < message->field_count(); ++i) {
      const FieldDescriptor* field = message->field(i);
      if (field->message_type() ? this->Visit(field->message_type()) : HasRange(*field)) {
        fields.push_back(field);
      }
    }
    if (fields.empty()) {
      return false;
    }
    this->Fields_[message] = std::move(fields);
    return true;
  }
  std::map<const Descriptor*, std::vector<const FieldDescriptor*>> Fields_;
  std::set<const Descriptor*> Seen_;
};

double NumberOf(const Message& message, const FieldDescriptor& field) {
  const auto* reflection = message.GetReflection();
  switch (field.cpp_type()) {
  case FieldDescriptor::CPPTYPE_UINT32:
    return reflection->GetUInt32(message, &field);
  case FieldDescriptor::CPPTYPE_INT32:
    return reflection->GetInt32(message, &field);
  case FieldDescriptor::CPPTYPE_UINT64:
    return double(reflection->GetUInt64(message, &field));
  case FieldDescriptor::CPPTYPE_DOUBLE:
    return reflection->GetDouble(message, &field);
  default:
    throw Error(
        Error::Kind::Internal, "field " + field.full_name(),
        "the option `(accepts)` has a range; accepted: of one double, uint32, int32 or uint64");
  }
}

std::string About(const v1::Command& command) {
  const CommandTraits& traits = *CommandTraits::Find(command.command_case());
  if (std::string part = traits.PartName(command); !part.empty()) {
    return part;
  }
  const std::string name = traits.OwnerName(command);
  switch (traits.GetOwner()) {
  case CommandTraits::Owner::Object:
    return "object " + std::to_string(traits.OwnerId(command));
  case CommandTraits::Owner::Terrain:
    return "terrain '" + name + "'";
  case CommandTraits::Owner::Vantage:
    return "vantage '" + name + "'";
  case CommandTraits::Owner::Viewport:
    return "viewport '" + name + "'";
  default:
    return "command " + traits.Name();
  }
}

// Whole numbers in full: %g would write the large ones with an exponent.
std::string InFull(double value) {
  const bool isWhole = std::abs(value) < 1e15 && value == std::floor(value);
  return isWhole ? std::to_string(std::int64_t(value)) : NumberText(value);
}

std::string RangeText(const v1::LimitOptions& limits) {
  if (!limits.has_maximum()) {
    return InFull(limits.minimum()) + " on";
  }
  if (!limits.has_minimum()) {
    return "up to " + InFull(limits.maximum());
  }
  return InFull(limits.minimum()) + " to " + InFull(limits.maximum());
}

void RequireNumbers(const v1::Command& command, const Message& message) {
  const auto* reflection = message.GetReflection();
  for (const FieldDescriptor* field : LimitTree::Get().FieldsOf(message.GetDescriptor())) {
    if (!field->message_type()) {
      const v1::LimitOptions& limits = LimitsOf(*field);
      if (field->has_presence() && !reflection->HasField(message, field)) {
        continue;
      }
      const double number = NumberOf(message, *field);
      if (number == 0.0 && limits.zero_is_absent()) {
        continue;
      }
      const bool within = !(limits.has_minimum() && !(number >= limits.minimum())) &&
                          !(limits.has_maximum() && !(number <= limits.maximum()));
      if (!within) {
        throw Error(Error::Kind::InvalidArgument, About(command),
                    field->name() + " is " + InFull(number) + "; accepted: " + RangeText(limits));
      }
    } else if (field->is_repeated()) {
      for (int i = 0; i < reflection->FieldSize(message, field); ++i) {
        RequireNumbers(command, reflection->GetRepeatedMessage(message, field, i));
      }
    } else if (reflection->HasField(message, field)) {
      RequireNumbers(command, reflection->GetMessage(message, field));
    }
  }
}

} // namespace

void RequireLimits(const v1::Command& command) {
  RequireNumbers(command, command);
}

std::size_t MostBytes(const char* field) {
  const FieldDescriptor* found =
      v1::Command::descriptor()->file()->pool()->FindFieldByName(std::string("dspace.v1.") + field);
  if (!found || !LimitsOf(*found).has_most_bytes()) {
    throw Error(Error::Kind::Internal, std::string("field ") + field,
                "the option `(accepts).most_bytes` is missing (options.proto)");
  }
  return LimitsOf(*found).most_bytes();
}

const std::string& DefaultScene() {
  static const std::string& name =
      LimitsOf(*v1::Command::descriptor()->FindFieldByName("scene")).standard_text();
  return name;
}

const std::string& SceneName(const v1::Command& command) {
  return command.scene().empty() ? DefaultScene() : command.scene();
}

} // namespace dspace::session
