#include <dspace/messages/CommandTraits.h>

#include <algorithm>

#include <google/protobuf/descriptor.h>

#include <dspace/Error.h>
#include <dspace/messages/CommandTexts.h>
#include <dspace/proto/commands.pb.h>

namespace dspace::session {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

// Reads the options of a command and checks that all are there.
class CommandTraitsReader {
  using Options = v1::CommandOptions;

public:
  static std::vector<CommandTraits> ReadAll() {
    std::vector<CommandTraits> all;
    const auto* commands = v1::Command::descriptor()->FindOneofByName("command");
    for (int i = 0; i < commands->field_count(); ++i) {
      all.push_back(Read(*commands->field(i)));
    }
    std::sort(all.begin(), all.end(), [](const CommandTraits& a, const CommandTraits& b) {
      return a.Number() < b.Number();
    });
    return all;
  }

private:
  [[noreturn]] static void Fail(const FieldDescriptor& command, const std::string& what) {
    throw Error(Error::Kind::Internal, "command " + command.name(),
                what + ": state it in `option (command)` of message " +
                    command.message_type()->name() + " (options.proto)");
  }

  static CommandTraits Read(const FieldDescriptor& field) {
    const Descriptor& message = *field.message_type();
    const Options& options = message.options().GetExtension(v1::command);
    CommandTraits traits;
    traits.Number_ = field.number();
    traits.Name_ = field.name();
    traits.Field_ = &field;
    switch (options.effect()) {
    case Options::CHANGE:
      traits.Effect_ = Effect::Change;
      break;
    case Options::REQUEST:
      traits.Effect_ = Effect::Request;
      break;
    default:
      Fail(field, "the option `effect` is missing");
    }
    ReadResults(field, options, traits);
    const bool any = options.owner() || options.kept() || options.poses() || options.wait();
    if (traits.Effect_ == Effect::Change) {
      ReadChange(field, options, traits);
    } else if (any || !options.key().empty()) {
      Fail(field, "it is no CHANGE, and has options of one");
    }
    traits.ReadsFiles_ = HoldsText(message, TextKind::ReadFile);
    traits.NamesFiles_ = traits.ReadsFiles_ || HoldsText(message, TextKind::NewFile);
    return traits;
  }

  static void ReadResults(const FieldDescriptor& field, const Options& options,
                          CommandTraits& traits) {
    if (options.reply_size() == 0) {
      Fail(field, "the option `reply` is missing");
    }
    if (options.reply_size() == 1 && options.reply(0) == "none") {
      return;
    }
    for (const std::string& name : options.reply()) {
      const FieldDescriptor* result = v1::Reply::descriptor()->FindFieldByName(name);
      if (!result || !result->real_containing_oneof()) {
        Fail(field, "the option `reply` is '" + name + "', which is no result in Reply");
      }
      traits.Results_.push_back(name);
    }
  }

  static void ReadChange(const FieldDescriptor& field, const Options& options,
                         CommandTraits& traits) {
    using Owner = CommandTraits::Owner;
    traits.Owner_ = options.owner() == Options::SCENE      ? Owner::Scene
                    : options.owner() == Options::OBJECT   ? Owner::Object
                    : options.owner() == Options::TERRAIN  ? Owner::Terrain
                    : options.owner() == Options::VANTAGE  ? Owner::Vantage
                    : options.owner() == Options::VIEWPORT ? Owner::Viewport
                                                           : Owner::None;
    if (traits.Owner_ == Owner::None) {
      Fail(field, "the option `owner` is missing");
    }
    if (options.kept() == Options::KEPT_UNSPECIFIED) {
      Fail(field, "the option `kept` is missing");
    }
    if (options.poses() == Options::POSES_UNSPECIFIED) {
      Fail(field, "the option `poses` is missing");
    }
    if (options.wait() == Options::WAIT_UNSPECIFIED) {
      Fail(field, "the option `wait` is missing");
    }
    ReadKey(field, options.key(), traits);
    traits.LatestIsKept_ = options.kept() == Options::LATEST;
    if (traits.LatestIsKept_ && traits.Owner_ != Owner::Object && traits.Owner_ != Owner::Terrain &&
        traits.Owner_ != Owner::Viewport) {
      Fail(field, "the option `kept` is LATEST, which OBJECT, TERRAIN and VIEWPORT have");
    }
    traits.KeepsPoses_ = options.poses() == Options::KEEPS;
    traits.MayGoUnawaited_ = options.wait() == Options::OPTIONAL;
  }

  static void ReadKey(const FieldDescriptor& field, const std::string& key, CommandTraits& traits) {
    using Owner = CommandTraits::Owner;
    if (traits.Owner_ == Owner::Scene) {
      if (!key.empty()) {
        Fail(field, "the option `key` is '" + key + "'; a SCENE has none");
      }
      return;
    }
    traits.Key_ = field.message_type()->FindFieldByName(key);
    const FieldDescriptor::CppType type = traits.Owner_ == Owner::Object
                                              ? FieldDescriptor::CPPTYPE_UINT32
                                              : FieldDescriptor::CPPTYPE_STRING;
    if (!traits.Key_ || traits.Key_->is_repeated() || traits.Key_->cpp_type() != type) {
      Fail(field, "the option `key` is '" + key + "', which is no field with the owner's " +
                      (traits.Owner_ == Owner::Object ? "id" : "name"));
    }
  }
};

const std::vector<CommandTraits>& CommandTraits::All() {
  static const std::vector<CommandTraits> all = CommandTraitsReader::ReadAll();
  return all;
}

const CommandTraits* CommandTraits::Find(int number) {
  static const std::vector<const CommandTraits*> byNumber = [] {
    std::vector<const CommandTraits*> found(std::size_t(All().back().Number()) + 1, nullptr);
    for (const CommandTraits& traits : All()) {
      found[std::size_t(traits.Number())] = &traits;
    }
    return found;
  }();
  return number >= 0 && std::size_t(number) < byNumber.size() ? byNumber[std::size_t(number)]
                                                              : nullptr;
}

std::string CommandTraits::OwnerName(const v1::Command& command) const {
  if (!this->Key_ || this->Owner_ == Owner::Object) {
    return {};
  }
  const auto& message = command.GetReflection()->GetMessage(command, this->Field_);
  return message.GetReflection()->GetString(message, this->Key_);
}

std::string CommandTraits::PartName(const v1::Command& command) const {
  const auto& message = command.GetReflection()->GetMessage(command, this->Field_);
  const auto* descriptor = message.GetDescriptor();
  const std::string& part = descriptor->options().GetExtension(v1::command).part();
  if (part.empty()) {
    return {};
  }
  const auto* name = descriptor->FindFieldByName("name");
  if (!name) {
    return part;
  }
  return part + " '" + message.GetReflection()->GetString(message, name) + "'";
}

std::uint32_t CommandTraits::OwnerId(const v1::Command& command) const {
  if (this->Owner_ != Owner::Object) {
    return 0;
  }
  const auto& message = command.GetReflection()->GetMessage(command, this->Field_);
  return message.GetReflection()->GetUInt32(message, this->Key_);
}

} // namespace dspace::session
