// What the threads of a server share. Inside the library only.
#ifndef DSPACE_SESSION_SERVER_HUB_H
#define DSPACE_SESSION_SERVER_HUB_H

#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <set>

#include <grpcpp/grpcpp.h>

#include <dspace/link/SnapshotMessages.h>
#include <dspace/link/server/Server.h>
#include <dspace/link/server/ServerListener.h>
#include <dspace/proto/service.grpc.pb.h>

namespace dspace::session {

using LinkClock = std::chrono::steady_clock;

// What waits for one client: written by its own thread, one message after the other.
template<class Message> struct Outbox {
  std::deque<std::pair<std::shared_ptr<const Message>, std::size_t>> messages;
  std::size_t bytes = 0;
  std::condition_variable ready;
  bool ended = false; // the stream is over, or about to be once `messages` is empty

  void Put(std::shared_ptr<const Message> message, std::size_t size) {
    this->messages.emplace_back(std::move(message), size);
    this->bytes += size;
    this->ready.notify_one();
  }
  std::shared_ptr<const Message> Take() {
    auto [message, size] = std::move(this->messages.front());
    this->messages.pop_front();
    this->bytes -= size;
    return std::move(message);
  }
  void Clear() {
    this->messages.clear();
    this->bytes = 0;
  }
};

// Calls of Drive: whoever drives, those that come to be refused, and a broken connection that has
// not been noticed yet.
constexpr unsigned DrivesAtOnce = 8;

// Bytes of commands that are read ahead while they are carried out: a few steps, whose memory
// serves the next ones while it is in the processor's caches. Where that stalls for longer than
// ToCatchUp, ServerOptions' limits count alone.
constexpr std::size_t ReadAheadBytes = 1 << 20;
constexpr std::chrono::milliseconds ToCatchUp{5};

struct DriveStream {
  explicit DriveStream(grpc::ServerContext* of) : context(of) {}
  grpc::ServerContext* context;
  Outbox<v1::DriveReply> out;
  std::size_t eventBytes = 0; // of viewers' events in `out`, which cut nobody off
};

struct ViewerStream {
  Outbox<v1::WatchReply> out;
  bool behind = true;        // gets nothing before the next snapshot,
  bool wantsSnapshot = true; // which it is ready for
  grpc::Status failed;       // why there is none
  bool takesParts = false;   // of a snapshot
  // Of a snapshot that is on its way: the first messages in `out`. They stay, however far the
  // viewer falls behind: else one that is large would never come to its end.
  std::size_t parts = 0;
  std::size_t partBytes = 0;

  void PutPart(std::shared_ptr<const v1::WatchReply> message, std::size_t size) {
    ++this->parts;
    this->partBytes += size;
    this->out.Put(std::move(message), size);
  }
  std::shared_ptr<const v1::WatchReply> Take() {
    if (this->parts > 0) {
      --this->parts;
      this->partBytes -= this->out.messages.front().second;
    }
    return this->out.Take();
  }
  void FallBehind() {
    this->out.messages.resize(this->parts);
    this->out.bytes = this->partBytes;
    this->behind = true;
  }
};

// Who drives, or drove last: outlives its connection.
struct Writer {
  std::string key;
  std::string name;
  std::string process;                  // see ProcessName.h
  std::uint64_t generation = 0;         // of keys; what older ones sent is not carried out
  std::uint64_t queued = 0;             // the last number that has come
  std::uint64_t done = 0;               // the last one carried out
  std::uint64_t unacknowledgedDone = 0; // the same, if its client does not know yet; else 0
  std::map<std::uint64_t, std::pair<std::shared_ptr<const v1::DriveReply>, std::size_t>> kept;
  std::size_t keptBytes = 0;           // of `kept`: replies that the client has not said it has
  std::shared_ptr<DriveStream> stream; // null while disconnected
  bool left = false;                   // by itself, rather than that its connection broke,
  LinkClock::time_point lost;          // then
  LinkClock::time_point due;           // of its next command, by the rate
};

struct Task {
  std::uint64_t generation;
  std::uint64_t number;
  bool noReply;
  std::size_t bytes;
  v1::Command command;
};

struct Server::Hub {
  ServerOptions options;
  std::string address;

  mutable std::mutex mutex;      // of all below
  std::condition_variable work;  // for Run
  std::condition_variable space; // for whoever queues
  std::deque<Task> tasks;
  std::size_t taskBytes = 0;
  std::vector<v1::Command> recycled; // carried out: their memory serves the next ones
  Writer writer;
  std::set<ViewerStream*> viewers;
  std::uint64_t sequence = 0; // of published commands
  // The last one that was made, while nothing has changed since, and when another may be.
  std::shared_ptr<SnapshotMessages> snapshot;
  LinkClock::time_point nextSnapshot;
  unsigned driving = 0; // calls
  unsigned watching = 0;
  Counts counts;
  bool stopping = false;
  // Streams that must show life by then, else they are cut off.
  std::map<grpc::ServerContext*, LinkClock::time_point> deadlines;

  std::unique_ptr<Service> service;
  std::unique_ptr<grpc::Server> server;
  std::unique_ptr<ServerListener> listener;

  // All of these with the mutex held.
  void Acknowledge(std::uint64_t number);
  void Recycle(v1::Command&& command, std::size_t bytes);
  void Answer(std::uint64_t number, bool noReply, v1::Reply reply);
  void SendDone();
  void PutToWriter(std::shared_ptr<const v1::DriveReply> reply, std::size_t size);
  void SendWriterName();
  // Who drives or may come back, and what is accepted instead of driving; empty: nobody.
  std::string DriverConflict() const;
  void PutSnapshots(const SessionWork& work, std::unique_lock<std::mutex>& lock);
  // The earlier of `otherwise` and when a snapshot that somebody waits for may be made.
  LinkClock::time_point SnapshotDue(LinkClock::time_point otherwise) const;
  void DisconnectLate();
};

} // namespace dspace::session

#endif
