// The traits of commands, as their .proto files state them (options.proto).
#ifndef DSPACE_SESSION_COMMAND_TRAITS_H
#define DSPACE_SESSION_COMMAND_TRAITS_H

#include <cstdint>
#include <string>
#include <vector>

namespace google::protobuf {
class FieldDescriptor;
}
namespace dspace::v1 {
class Command;
}

namespace dspace::session {

enum class Effect { Change, Request };

// The options of one command. The options of all commands are read once, on first use.
class CommandTraits {
public:
  // The kind of entity that a change applies to. `None`: the command is not a change.
  enum class Owner { None, Scene, Object, Terrain, Vantage, Viewport };

  // The traits of the command with this number (v1::Command::CommandCase); null for an unknown
  // number. Throws Error(Internal), naming the command or field and the option, if any command
  // lacks an option.
  static const CommandTraits* Find(int number);
  // In the order of their numbers. Throws as Find does.
  static const std::vector<CommandTraits>& All();

  int Number() const { return this->Number_; }
  const std::string& Name() const { return this->Name_; } // "create_frame"
  Effect GetEffect() const { return this->Effect_; }
  // Names of the possible results in v1::Reply; empty: the command has no result.
  const std::vector<std::string>& Results() const { return this->Results_; }

  Owner GetOwner() const { return this->Owner_; }
  // A snapshot restores the change with the last command of its kind for each owner, without code
  // for this command.
  bool LatestIsKept() const { return this->LatestIsKept_; }
  // The command changes no local pose and no telemetry value that was set before.
  bool KeepsPoses() const { return this->KeepsPoses_; }
  // A client that does not wait continues without the reply.
  bool MayGoUnawaited() const { return this->MayGoUnawaited_; }
  // It has a field, at any depth, with a file to read (ReadsFiles) or with any file (NamesFiles).
  bool ReadsFiles() const { return this->ReadsFiles_; }
  bool NamesFiles() const { return this->NamesFiles_; }

  // The owner's name in a command of this kind, for a vantage, viewport or terrain; empty for other
  // owners.
  std::string OwnerName(const v1::Command& command) const;
  // The part of the owner that a command of this kind changes, for messages: "colour bar 'height'".
  // Empty: the command's options name no part.
  std::string PartName(const v1::Command& command) const;
  // The owner's id, for an object; 0 for other owners.
  std::uint32_t OwnerId(const v1::Command& command) const;

private:
  friend class CommandTraitsReader;

  int Number_ = 0;
  std::string Name_;
  Effect Effect_ = Effect::Request;
  std::vector<std::string> Results_;
  Owner Owner_ = Owner::None;
  const google::protobuf::FieldDescriptor* Field_ = nullptr; // of v1::Command
  const google::protobuf::FieldDescriptor* Key_ = nullptr;   // null: the scene is the owner
  bool LatestIsKept_ = false;
  bool KeepsPoses_ = true;
  bool MayGoUnawaited_ = false;
  bool ReadsFiles_ = false;
  bool NamesFiles_ = false;
};

} // namespace dspace::session

#endif
