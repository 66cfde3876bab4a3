// A snapshot in messages: cut by the server, put together by viewers. Inside the library only.
#ifndef DSPACE_SESSION_SNAPSHOT_MESSAGES_H
#define DSPACE_SESSION_SNAPSHOT_MESSAGES_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <dspace/proto/service.pb.h>

namespace dspace::session {

struct SnapshotLimits {
  std::size_t part = 2 << 20; // bytes; a command that has more by itself is a part of its own
  std::size_t largest = std::size_t(2000) << 20; // of any message; protobuf's own limit is 2 GiB
};

class SnapshotMessages {
public:
  struct Message {
    std::shared_ptr<const v1::WatchReply> reply;
    std::size_t bytes = 0;
  };

  SnapshotMessages(std::vector<v1::Command> commands, std::uint64_t sequence,
                   const SnapshotLimits& limits);

  // For a viewer that takes parts, or one message for one that does not. Throws Error(Resource)
  // where a message would be larger than the largest.
  const std::vector<Message>& For(bool parts);

private:
  SnapshotLimits Limits_;
  std::vector<Message> Parts_;
  std::vector<Message> Whole_; // empty until somebody asks
};

// What a viewer hears of snapshots, one message after the other.
class SnapshotJoin {
public:
  // False where more parts follow; else `message` is a whole snapshot, or none. Throws
  // Error(Corrupt) for a part that is not the next one.
  bool Take(v1::WatchReply& message);

private:
  v1::WatchReply::Snapshot Gathered_;
  std::uint32_t Next_ = 0; // part
};

} // namespace dspace::session

#endif
