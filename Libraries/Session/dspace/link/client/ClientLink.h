// The state that a client's threads share. Inside the library only.
#ifndef DSPACE_SESSION_CLIENT_LINK_H
#define DSPACE_SESSION_CLIENT_LINK_H

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <set>
#include <thread>

#include <sys/types.h>

#include <grpcpp/grpcpp.h>

#include <dspace/link/Pacer.h>
#include <dspace/link/PoseFilter.h>
#include <dspace/link/client/RemoteClient.h>
#include <dspace/proto/service.grpc.pb.h>

namespace dspace::session {

using LinkClock = std::chrono::steady_clock;

inline LinkClock::time_point After(double seconds) {
  return LinkClock::now() +
         std::chrono::duration_cast<LinkClock::duration>(std::chrono::duration<double>(seconds));
}

// The user's thread puts commands into `pending`. One thread maintains the connection and reads
// replies, another one writes. A command stays pending until it is completed, so that it can be
// resent.
struct RemoteClient::Link {
  explicit Link(const RemoteClientOptions& options); // throws errors of the options
  struct Pending {
    std::uint64_t number;
    std::size_t bytes;
    grpc::ByteBuffer request; // a serialized DriveRequest: it may be sent more than once
  };
  using Stream = grpc::ClientReaderWriter<grpc::ByteBuffer, v1::DriveReply>;

  RemoteClientOptions options;
  std::shared_ptr<grpc::Channel> channel;
  const pid_t
      process;     // that connects: a child has none of the threads, and the mutexes as they were
  std::string key; // of this client, at random
  std::thread thread;

  std::mutex mutex;                // of all below
  std::condition_variable changed; // for the user's thread
  std::condition_variable toSend;
  std::deque<Pending> pending;
  std::size_t pendingBytes = 0;
  std::size_t next = 0;              // index in `pending` of the next command to send
  std::size_t unsentBytes = 0;       // bytes of `pending` from `next` on
  bool crowded = false;              // the user's thread waits until there are fewer
  bool absorbing = false;            // the other side stalls: `pending` may fill the window
  std::uint64_t last = 0;            // the last assigned number
  std::uint64_t unawaited = 0;       // the last number that was sent without waiting
  std::uint64_t done = 0;            // the last number that the server completed
  std::uint64_t acknowledged = 0;    // the last number whose reply was received
  std::uint64_t awaited = 0;         // the number that the user's thread waits for; 0: none
  std::set<std::uint64_t> abandoned; // numbers whose replies are dropped
  v1::Reply reply;                   // the reply that Take returns
  v1::Reply failure;                 // the first error of commands sent without waiting
  v1::Reply unawaitedReplies;        // their warnings and frame events
  std::deque<v1::ViewerEvent> events;
  std::size_t eventBytes = 0; // of them
  PoseFilter filter;
  v1::DriveRequest scratch; // reused for serialization
  Counts counts;
  grpc::ClientContext* context = nullptr; // of the present stream; null: none
  ServerInfo server;
  bool opened = false;    // once
  bool connected = false; // now
  bool leaving = false;   // gives up a reservation that it cannot use
  bool broken = false;    // permanently, because of `error`
  v1::Error error;
  bool ending = false;

  // The activity of the user's thread, and its data.
  enum class Activity { Nothing, Pace, Earlier, Window, Reply, Flush, Done };
  Activity activity = Activity::Nothing;
  v1::Command command; // of Pace, Earlier and Window
  std::size_t bytes = 0;
  bool noReply = false;
  LinkClock::time_point due;      // of Pace
  LinkClock::time_point deadline; // of all other activities
  LinkClock::time_point catchUp;  // of Window: until then the writing thread may catch up
  Pacer pacer;

  // For the user's thread, with the mutex held.
  v1::Reply Fault(v1::Error::Kind kind, const std::string& message);
  void Finish(v1::Reply&& with);
  void BeginWaitForEarlier();
  bool WaitForEarlier(std::unique_lock<std::mutex>& lock, LinkClock::time_point until);
  void Admit();
  void Put();
  bool WaitForWindow(std::unique_lock<std::mutex>& lock, LinkClock::time_point until);
  bool WaitForReply(std::unique_lock<std::mutex>& lock, LinkClock::time_point until);
  bool WaitForFlush(std::unique_lock<std::mutex>& lock, LinkClock::time_point until);
  void MoveUnawaitedReplies(v1::Reply& reply);
  void Break(v1::Error::Kind kind, const std::string& message);

  // Whether this process is a child of the one that connected. Then nothing else may be used.
  bool Forked() const;
  v1::Reply ForkedError(); // the error in that case

  void End(); // ends all threads; without the mutex

  // The connection's thread: connects and reconnects.
  void RunConnection();
  bool Drive(grpc::Status& status); // runs one stream; returns whether it was opened
  std::unique_ptr<Stream> Call(grpc::ClientContext& context);
  void Write(Stream& stream);
  // With the mutex held: returns the command at `next` for sending. Rewind(last): continues after
  // the number `last`.
  grpc::ByteBuffer TakeNext();
  void Rewind(std::uint64_t last);
  void HandleReply(v1::DriveReply& message);
  void TakeReply(std::uint64_t number, v1::Reply& reply);
  v1::Reply Resume(const v1::Opened& opened); // returns an error if it cannot resume
};

} // namespace dspace::session

#endif
