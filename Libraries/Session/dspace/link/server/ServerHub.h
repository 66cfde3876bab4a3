// The state that a server's threads share. Inside the library only.
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
#include <dspace/link/server/RequestBytes.h>
#include <dspace/link/server/Server.h>
#include <dspace/link/server/ServerListener.h>
#include <dspace/proto/service.grpc.pb.h>

namespace dspace::session {

using LinkClock = std::chrono::steady_clock;

// The queue of messages for one client. A thread of the client's own writes them.
template<class Message> struct Outbox {
  std::deque<std::pair<std::shared_ptr<const Message>, std::size_t>> messages;
  std::size_t bytes = 0;
  std::condition_variable ready;
  bool ended = false; // the stream ends when `messages` is empty

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

// Limit of concurrent calls of Drive: the driver, clients that will be rejected, and a broken
// connection that has not been detected yet.
constexpr unsigned DrivesAtOnce = 8;

// Bytes of commands that are read ahead: a few steps, so that their memory is reused while it is in
// the processor's caches. If execution stalls for longer than ToCatchUp, only the limits of
// ServerOptions apply.
constexpr std::size_t ReadAheadBytes = 1 << 20;
constexpr std::chrono::milliseconds ToCatchUp{5};

struct DriveStream {
  explicit DriveStream(grpc::ServerContext* of) : context(of) {}
  grpc::ServerContext* context;
  Outbox<v1::DriveReply> out;
  std::size_t eventBytes = 0; // of viewers' events in `out`, which never disconnect the writer
};

struct ViewerStream {
  Outbox<v1::WatchReply> out;
  bool behind = true;        // it gets nothing before the next snapshot
  bool wantsSnapshot = true; // it is ready for a snapshot
  grpc::Status failed;       // why the snapshot failed
  bool takesParts = false;   // it accepts snapshots in parts
  // The parts of a snapshot in transfer, at the front of `out`. They stay even if the viewer falls
  // behind; otherwise a large snapshot would never complete.
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

// The present or last driver. It outlives its connection.
struct Writer {
  std::string key;
  std::string name;
  std::string process;                  // see ProcessName.h
  std::uint64_t generation = 0;         // counts keys; commands of older generations are dropped
  std::uint64_t queued = 0;             // the last received number
  std::uint64_t done = 0;               // the last completed number
  std::uint64_t unacknowledgedDone = 0; // `done`, if the client has not been informed; else 0
  std::map<std::uint64_t, std::pair<std::shared_ptr<const v1::DriveReply>, std::size_t>> kept;
  std::size_t keptBytes = 0;           // of `kept`: replies that the client has not acknowledged
  std::shared_ptr<DriveStream> stream; // null while disconnected
  bool left = false;                   // it disconnected itself; its connection did not break
  LinkClock::time_point lost;          // when it disconnected
  LinkClock::time_point due;           // of its next command, by the rate
};

struct Task {
  std::uint64_t generation;
  std::uint64_t number;
  bool noReply;
  std::size_t bytes;
  v1::Command command;
  std::string rejection; // why it came without its command
};

struct Server::Hub {
  ServerOptions options;
  std::string address;

  mutable std::mutex mutex;      // of all below
  std::condition_variable work;  // for Run
  std::condition_variable space; // for threads that queue commands
  std::deque<Task> tasks;
  std::size_t taskBytes = 0;
  std::vector<v1::Command> recycled; // executed commands, whose memory is reused
  Writer writer;
  std::uint64_t freshGeneration = 0; // of the writer that executed a command last
  std::set<ViewerStream*> viewers;
  std::uint64_t sequence = 0; // of published commands
  // The last snapshot, while it is up to date, and the earliest time of the next one.
  std::shared_ptr<SnapshotMessages> snapshot;
  LinkClock::time_point nextSnapshot;
  unsigned driving = 0; // calls
  unsigned watching = 0;
  Counts counts;
  bool stopping = false;
  // Streams that are disconnected at this time unless they make progress.
  std::map<grpc::ServerContext*, LinkClock::time_point> deadlines;

  std::unique_ptr<Service> service;
  std::unique_ptr<grpc::Server> server;
  std::unique_ptr<ServerListener> listener;

  // Call all of these with the mutex held.
  void Acknowledge(std::uint64_t number);
  void Recycle(v1::Command&& command, std::size_t bytes);
  void Answer(std::uint64_t number, bool noReply, v1::Reply reply);
  void SendDone();
  void PutToWriter(std::shared_ptr<const v1::DriveReply> reply, std::size_t size);
  void SendWriterName();
  // Why another client may not drive: the driver or its reservation, and what is accepted. Empty:
  // it may drive.
  std::string DriverConflict() const;
  void PutSnapshots(const SessionWork& work, std::unique_lock<std::mutex>& lock);
  // The time of the next requested snapshot, but not later than `otherwise`.
  LinkClock::time_point SnapshotDue(LinkClock::time_point otherwise) const;
  void DisconnectLate();
};

} // namespace dspace::session

#endif
