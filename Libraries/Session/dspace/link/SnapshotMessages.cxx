#include <dspace/link/SnapshotMessages.h>

#include <string>

#include <dspace/Error.h>

namespace dspace::session {
namespace {

constexpr std::size_t Slack = 64; // of a message, for its own fields

void RequireRoom(std::size_t bytes, std::size_t largest) {
  if (bytes > largest) {
    throw Error(Error::Kind::Resource, "snapshot",
                "a message of it would have " + std::to_string(bytes) + " bytes; accepted: up to " +
                    std::to_string(largest) + " in one");
  }
}

} // namespace

SnapshotMessages::SnapshotMessages(std::vector<v1::Command> commands, std::uint64_t sequence,
                                   const SnapshotLimits& limits)
    : Limits_(limits) {
  std::shared_ptr<v1::WatchReply> part;
  const auto begin = [&] {
    if (part) {
      part->mutable_snapshot()->set_more(true);
    }
    part = std::make_shared<v1::WatchReply>();
    part->set_sequence(sequence);
    part->mutable_snapshot()->set_command_set(v1::COMMAND_SET_VERSION);
    part->mutable_snapshot()->set_part(std::uint32_t(this->Parts_.size()));
    this->Parts_.push_back({part, Slack});
  };
  begin();
  for (v1::Command& command : commands) {
    const std::size_t bytes = command.ByteSizeLong() + 8; // with its length
    if (part->snapshot().command_size() > 0 &&
        this->Parts_.back().bytes + bytes > this->Limits_.part) {
      begin();
    }
    part->mutable_snapshot()->add_command()->Swap(&command);
    this->Parts_.back().bytes += bytes;
  }
}

const std::vector<SnapshotMessages::Message>& SnapshotMessages::For(bool parts) {
  if (parts || this->Parts_.size() == 1) {
    for (const Message& part : this->Parts_) {
      RequireRoom(part.bytes, this->Limits_.largest);
    }
    return this->Parts_;
  }
  if (this->Whole_.empty()) {
    std::size_t bytes = 0;
    for (const Message& part : this->Parts_) {
      bytes += part.bytes;
    }
    RequireRoom(bytes, this->Limits_.largest);
    const auto whole = std::make_shared<v1::WatchReply>();
    for (const Message& part : this->Parts_) {
      whole->MergeFrom(*part.reply);
    }
    whole->mutable_snapshot()->clear_part();
    whole->mutable_snapshot()->clear_more();
    this->Whole_.push_back({whole, bytes});
  }
  return this->Whole_;
}

bool SnapshotJoin::Take(v1::WatchReply& message) {
  if (!message.has_snapshot()) {
    return true;
  }
  v1::WatchReply::Snapshot& snapshot = *message.mutable_snapshot();
  if (snapshot.part() == 0) {
    this->Gathered_.Clear();
    this->Next_ = 0;
  }
  if (snapshot.part() != this->Next_) {
    throw Error(Error::Kind::Corrupt, "snapshot",
                "part " + std::to_string(snapshot.part()) + " came where part " +
                    std::to_string(this->Next_) + " is next");
  }
  this->Next_ = snapshot.more() ? this->Next_ + 1 : 0;
  if (this->Gathered_.command_size() == 0) {
    this->Gathered_.Swap(&snapshot);
  } else {
    for (v1::Command& command : *snapshot.mutable_command()) {
      this->Gathered_.add_command()->Swap(&command);
    }
    this->Gathered_.set_more(snapshot.more());
  }
  if (this->Gathered_.more()) {
    return false;
  }
  this->Gathered_.clear_part();
  snapshot.Swap(&this->Gathered_);
  this->Gathered_.Clear();
  return true;
}

} // namespace dspace::session
