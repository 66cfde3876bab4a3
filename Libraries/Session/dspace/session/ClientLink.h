// What the threads of a client share. Inside the library only.
#ifndef DSPACE_SESSION_CLIENT_LINK_H
#define DSPACE_SESSION_CLIENT_LINK_H

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include <grpcpp/grpcpp.h>

#include <dspace/session/PoseFilter.h>
#include <dspace/session/RemoteClient.h>
#include <dspace/session/service.grpc.pb.h>

namespace dspace::session {

using LinkClock = std::chrono::steady_clock;

// The user's thread puts commands into `pending`; one thread keeps the connection and hears
// answers, another writes. What is pending stays until it is done, so that it can be sent again.
struct RemoteClient::Link {
  explicit Link(const RemoteClientOptions& options); // throws for what is wrong with them
  struct Pending {
    std::uint64_t number;
    std::size_t bytes;
    std::shared_ptr<const v1::DriveRequest> request;
  };
  using Stream = grpc::ClientReaderWriter<v1::DriveRequest, v1::DriveReply>;

  RemoteClientOptions options;
  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::Dspace::Stub> stub;
  std::string key; // of this client, at random
  std::thread thread;

  std::mutex mutex;                // of all below
  std::condition_variable changed; // for the user's thread
  std::condition_variable toSend;
  std::deque<Pending> pending;
  std::size_t pendingBytes = 0;
  std::size_t next = 0;           // of `pending`, to be sent
  std::uint64_t last = 0;         // number given
  std::uint64_t done = 0;         // by the server
  std::uint64_t acknowledged = 0; // the last number whose reply has come
  std::uint64_t awaited = 0;      // by the user's thread; 0: none
  v1::Reply reply;                // to it
  v1::Reply failure;              // the first error of what nobody waited for
  v1::Reply unasked;              // warnings and frame events of the same
  std::deque<v1::ViewerEvent> events;
  PoseFilter filter;
  Counts counts;
  grpc::ClientContext* context = nullptr; // of the stream that there is
  std::size_t maximumMessage = 0;         // bytes of a command that the server takes
  bool opened = false;                    // once
  bool connected = false;                 // now
  bool broken = false;                    // for good, because of
  v1::Error error;
  bool ending = false;

  // For the user's thread, with the mutex held.
  v1::Reply Fault(v1::Error::Kind kind, const std::string& message);
  v1::Reply Put(std::unique_lock<std::mutex>& lock, v1::Command&& command, bool noReply,
                std::uint64_t* number);
  void MoveUnasked(v1::Reply& reply);
  void Break(v1::Error::Kind kind, const std::string& message);

  void End(); // of everything, without the mutex

  // The thread: connects, again and again.
  void Keep();
  bool Drive(grpc::Status& status); // one stream; whether it was opened
  void Write(Stream& stream);
  void Hear(v1::DriveReply& message);
  void TakeReply(std::uint64_t number, v1::Reply& reply);
  bool Resume(const v1::Opened& opened);
};

// Throws the Error that the message holds.
[[noreturn]] void Raise(const v1::Error& error);
// Channels of both kinds of clients.
std::shared_ptr<grpc::Channel> MakeChannel(const std::string& address,
                                           const LinkSecurity& security);
// What a status means to a user. Sets `final` where trying again is of no use.
v1::Error ToError(const std::string& address, const grpc::Status& status, bool& final);
std::string RandomKey();

} // namespace dspace::session

#endif
