// What the threads of a client share. Inside the library only.
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

// The user's thread puts commands into `pending`; one thread keeps the connection and hears
// answers, another writes. What is pending stays until it is done, so that it can be sent again.
struct RemoteClient::Link {
  explicit Link(const RemoteClientOptions& options); // throws for what is wrong with them
  struct Pending {
    std::uint64_t number;
    std::size_t bytes;
    grpc::ByteBuffer request; // a DriveRequest, in bytes: it may be sent more than once
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
  std::size_t next = 0;              // of `pending`, to be sent
  std::size_t unsentBytes = 0;       // of `pending` from there on
  bool crowded = false;              // the user's thread waits for less of them
  bool absorbing = false;            // the other side stalls: `pending` may fill its window
  std::uint64_t last = 0;            // number given
  std::uint64_t unawaited = 0;       // the last number that nobody waits for
  std::uint64_t done = 0;            // by the server
  std::uint64_t acknowledged = 0;    // the last number whose reply has come
  std::uint64_t awaited = 0;         // by the user's thread; 0: none
  std::set<std::uint64_t> abandoned; // by it: their replies, which may yet come, are dropped
  v1::Reply reply;                   // to `awaited`, or whatever Take is to return
  v1::Reply failure;                 // the first error of what nobody waited for
  v1::Reply unawaitedReplies;        // warnings and frame events of the same
  std::deque<v1::ViewerEvent> events;
  std::size_t eventBytes = 0; // of them
  PoseFilter filter;
  v1::DriveRequest scratch; // what is put into bytes
  Counts counts;
  grpc::ClientContext* context = nullptr; // of the stream that there is
  ServerInfo server;
  bool opened = false;    // once
  bool connected = false; // now
  bool leaving = false;   // a place that it cannot use
  bool broken = false;    // for good, because of
  v1::Error error;
  bool ending = false;

  // What the user's thread is about, and its own.
  enum class Activity { Nothing, Pace, Earlier, Window, Reply, Flush, Done };
  Activity activity = Activity::Nothing;
  v1::Command command; // of Pace, BeginWaitForEarlier and Room
  std::size_t bytes = 0;
  bool noReply = false;
  LinkClock::time_point due;      // of Pace
  LinkClock::time_point deadline; // of all others
  LinkClock::time_point catchUp;  // of Room: the writing thread has so long to come near
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

  // Whether this is a child of the process that connects; then nothing else is to be touched.
  bool Forked() const;
  v1::Reply ForkedError(); // what it is told

  void End(); // of everything, without the mutex

  // The thread: connects, again and again.
  void RunConnection();
  bool Drive(grpc::Status& status); // one stream; whether it was opened
  std::unique_ptr<Stream> Call(grpc::ClientContext& context);
  void Write(Stream& stream);
  // With the mutex held: the command at `next`, which is sent now; nothing else is to be sent up to
  // the number `last`.
  grpc::ByteBuffer TakeNext();
  void Rewind(std::uint64_t last);
  void HandleReply(v1::DriveReply& message);
  void TakeReply(std::uint64_t number, v1::Reply& reply);
  v1::Reply Resume(const v1::Opened& opened); // an error: it cannot go on
};

// Throws the Error that the message holds.
[[noreturn]] void Raise(const v1::Error& error);
// Channels of both kinds of clients.
std::shared_ptr<grpc::Channel> MakeChannel(const std::string& address, const LinkSecurity& security,
                                           double keepalive_s = 20);
// What a status means to a user. Sets `final` where trying again is of no use.
v1::Error ToError(const std::string& address, const grpc::Status& status, bool& final);
std::string RandomKey();
// The message as it goes over the wire, written once.
grpc::ByteBuffer ToBytes(const v1::DriveRequest& request);

} // namespace dspace::session

#endif
