// Snapshots as messages: the server splits them, viewers join them. Inside the library only.
#ifndef DSPACE_SESSION_SNAPSHOT_MESSAGES_H
#define DSPACE_SESSION_SNAPSHOT_MESSAGES_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <dspace/proto/service.pb.h>

namespace dspace::session {

struct SnapshotLimits {
  std::size_t part = 2 << 20;                    // bytes; a larger command is a part of its own
  std::size_t largest = std::size_t(2000) << 20; // of a message [bytes]; protobuf's limit is 2 GiB
};

class SnapshotMessages {
public:
  struct Message {
    std::shared_ptr<const v1::WatchReply> reply;
    std::size_t bytes = 0;
  };

  SnapshotMessages(std::vector<v1::Command> commands, std::uint64_t sequence,
                   const SnapshotLimits& limits);

  // The messages for a viewer that accepts parts; else one message. Throws Error(Resource) if a
  // message exceeds the limit.
  const std::vector<Message>& For(bool parts);

private:
  SnapshotLimits Limits_;
  std::vector<Message> Parts_;
  std::vector<Message> Whole_; // created on demand
};

// Joins the parts of a snapshot in a viewer.
class SnapshotJoin {
public:
  // False if more parts follow. Otherwise `message` is a complete snapshot or another message.
  // Throws Error(Corrupt) for a part out of order.
  bool Take(v1::WatchReply& message);

private:
  v1::WatchReply::Snapshot Gathered_;
  std::uint32_t Next_ = 0; // part
};

} // namespace dspace::session

#endif
