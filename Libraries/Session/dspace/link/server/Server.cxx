#include <dspace/link/server/Server.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <mutex>
#include <thread>

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <grpcpp/resource_quota.h>

#include <dspace/Checks.h>
#include <dspace/Error.h>
#include <dspace/link/server/ServerService.h>
#include <dspace/messages/ErrorReply.h>

namespace dspace::session {
namespace {

// Room for a message's own fields around a command.
constexpr int Slack = 4096;
// How long the completion of commands without replies may be delayed.
constexpr std::chrono::microseconds DoneDelay{500};

void Check(const ServerOptions& options) {
  const auto reject = [](const char* what, const std::string& value, const char* accepted) {
    throw Error(Error::Kind::InvalidArgument, "server",
                std::string(what) + " is " + value + "; accepted: " + accepted);
  };
  if (options.maximumMessage < 1024 || options.maximumMessage > (std::size_t(1) << 30)) {
    reject("the largest message", std::to_string(options.maximumMessage), "1 KiB to 1 GiB");
  }
  if (options.maximumConnections < 1 || options.maximumConnections > 1000) {
    reject("the number of connections", std::to_string(options.maximumConnections), "1 to 1000");
  }
  if (!(options.maximumRate > 0)) {
    reject("the number of commands a second", std::to_string(options.maximumRate), "above 0");
  }
  if (!(options.reservation_s >= 0 && options.reservation_s <= 1e6)) {
    reject("the reservation time", NumberText(options.reservation_s) + " s", "0 to 1e6");
  }
  if (!(options.keepalive_s > 0 && options.keepalive_s <= 1e6)) {
    reject("the keepalive time", NumberText(options.keepalive_s) + " s", "above 0, up to 1e6");
  }
}

// Prevents gRPC from replacing the socket of a running server.
void RejectTakenSocket(const LinkAddress& address) {
  if (address.path.empty()) {
    return;
  }
  sockaddr_un place = {};
  place.sun_family = AF_UNIX;
  std::copy(address.path.begin(), address.path.end(), place.sun_path);
  struct stat info = {};
  if (lstat(address.path.c_str(), &info) != 0) {
    return;
  }
  bool taken = !S_ISSOCK(info.st_mode);
  const int probe = taken ? -1 : socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (probe >= 0) {
    // A server with a full queue is alive too.
    taken = connect(probe, reinterpret_cast<const sockaddr*>(&place), sizeof(place)) == 0 ||
            (errno != ECONNREFUSED && errno != ENOENT);
    close(probe);
  }
  if (taken) {
    throw Error(Error::Kind::Io, "address '" + address.target + "'",
                "the path exists already; accepted: a free path");
  }
}

} // namespace

Server::Server(const ServerOptions& options) : Hub_(new Hub) {
  Check(options);
  Hub& hub = *this->Hub_;
  hub.options = options;
  const LinkAddress address = LinkAddress::Parse(options.listen);
  const auto credentials = MakeServerCredentials(address, options.security);
  RejectTakenSocket(address);
  hub.service = std::make_unique<Service>(hub);
  grpc::ServerBuilder builder;
  // Half of the descriptors stay available for files and replies.
  hub.listener = std::make_unique<ServerListener>(
      address,
      std::min(std::size_t(4 * options.maximumConnections + 32), RaiseDescriptorLimit() / 2));
  auto acceptor = builder.experimental().AddExternalConnectionAcceptor(
      grpc::ServerBuilder::experimental_type::ExternalConnectionType::FROM_FD, credentials);
  builder.RegisterService(hub.service.get());
  builder.SetMaxReceiveMessageSize(int(options.maximumMessage) + Slack);
  builder.SetMaxSendMessageSize(-1); // pictures
  // Limits the threads, so that connections beyond the limit cannot block one.
  grpc::ResourceQuota quota("dspace");
  quota.SetMaxThreads(int(options.maximumConnections + DrivesAtOnce) + 8);
  builder.SetResourceQuota(quota);
  // A client that connects and sends nothing is disconnected soon.
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, 5000);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, 60000);
  const int keepalive_ms = int(std::max(1.0, 1e3 * options.keepalive_s));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, keepalive_ms);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, std::min(keepalive_ms, 10000));
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 200);
  builder.AddChannelArgument(GRPC_ARG_TCP_READ_CHUNK_SIZE, LinkReadBytes);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_FRAME_SIZE, LinkFrameBytes);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, LinkAheadBytes);
  hub.server = builder.BuildAndStart();
  if (!hub.server) {
    throw Error(Error::Kind::Io, "address '" + address.target + "'", "gRPC cannot serve there");
  }
  hub.listener->Start(std::move(acceptor));
  hub.address = address.target;
  if (address.path.empty()) {
    hub.address.replace(hub.address.rfind(':') + 1, std::string::npos,
                        std::to_string(hub.listener->Port()));
  }
}

Server::~Server() {
  this->Stop();
  Hub& hub = *this->Hub_;
  if (!hub.server) {
    return;
  }
  hub.listener->Stop();
  // Connections of clients that do not read are closed.
  std::mutex mutex;
  std::condition_variable ended;
  bool over = false;
  std::thread cutter([&] {
    std::unique_lock lock(mutex);
    auto pause = std::chrono::milliseconds(700);
    while (!ended.wait_for(lock, pause, [&] { return over; })) {
      hub.listener->CloseConnections();
      pause = std::chrono::milliseconds(100);
    }
  });
  hub.server->Shutdown(std::chrono::system_clock::now() + std::chrono::milliseconds(200));
  hub.server->Wait();
  {
    const std::lock_guard lock(mutex);
    over = true;
  }
  ended.notify_one();
  cutter.join();
  hub.listener.reset();
}

const std::string& Server::Address() const {
  return this->Hub_->address;
}

void Server::Stop() {
  const std::lock_guard lock(this->Hub_->mutex);
  Hub& hub = *this->Hub_;
  hub.stopping = true;
  hub.work.notify_all();
  hub.space.notify_all();
  for (ViewerStream* viewer : hub.viewers) {
    viewer->out.ended = true;
    viewer->out.ready.notify_all();
  }
  if (hub.writer.stream) {
    hub.writer.stream->out.ended = true;
    hub.writer.stream->out.ready.notify_all();
  }
}

Server::Counts Server::GetCounts() const {
  const std::lock_guard lock(this->Hub_->mutex);
  Counts counts = this->Hub_->counts;
  counts.connections = this->Hub_->driving + this->Hub_->watching;
  counts.viewers = unsigned(this->Hub_->viewers.size());
  counts.waitingBytes = this->Hub_->taskBytes + this->Hub_->writer.keptBytes;
  if (this->Hub_->writer.stream) {
    counts.waitingBytes += this->Hub_->writer.stream->out.bytes;
  }
  for (const ViewerStream* viewer : this->Hub_->viewers) {
    counts.waitingBytes += viewer->out.bytes;
  }
  return counts;
}

bool Server::Run(const SessionWork& work, double seconds) {
  const auto until = LinkClock::now() + std::chrono::duration_cast<LinkClock::duration>(
                                            std::chrono::duration<double>(seconds));
  Hub& hub = *this->Hub_;
  std::unique_lock lock(hub.mutex);
  while (!hub.stopping) {
    hub.PutSnapshots(work, lock);
    hub.DisconnectLate();
    if (hub.tasks.empty() && hub.writer.unacknowledgedDone > 0) {
      hub.work.wait_for(lock, DoneDelay, [&] { return hub.stopping || !hub.tasks.empty(); });
      if (hub.tasks.empty() && hub.writer.unacknowledgedDone > 0) {
        hub.SendDone();
      }
    }
    if (hub.tasks.empty()) {
      const auto now = LinkClock::now();
      if (now >= until) {
        break;
      }
      hub.work.wait_until(lock,
                          hub.SnapshotDue(std::min(until, now + std::chrono::milliseconds(200))));
      continue;
    }
    Task task = std::move(hub.tasks.front());
    hub.tasks.pop_front();
    hub.taskBytes -= task.bytes;
    if (hub.taskBytes <=
        ReadAheadBytes / 2) { // not for each task: the waiting thread then queues several
      hub.space.notify_all();
    }
    if (task.generation != hub.writer.generation) {
      continue; // another client has taken over
    }
    const bool fresh = hub.options.freshOnConnect && task.generation != hub.freshGeneration;
    hub.freshGeneration = task.generation;
    lock.unlock();
    if (fresh) {
      work.reset();
    }
    v1::Reply reply =
        task.rejection.empty()
            ? work.execute(task.command)
            : ErrorReply(v1::Error::RESOURCE, "command",
                         "command " + std::to_string(task.number) + ": " + task.rejection);
    lock.lock();
    ++hub.counts.commands;
    hub.Recycle(std::move(task.command), task.bytes);
    if (task.generation == hub.writer.generation) {
      hub.writer.done = task.number;
      hub.Answer(task.number, task.noReply, std::move(reply));
    }
    if (LinkClock::now() >= until) {
      break;
    }
  }
  return !hub.stopping;
}

void Server::Publish(const v1::Command& command) {
  Hub& hub = *this->Hub_;
  const std::lock_guard lock(hub.mutex);
  ++hub.sequence;
  hub.snapshot.reset();
  std::shared_ptr<v1::WatchReply> message;
  std::size_t size = 0;
  for (ViewerStream* viewer : hub.viewers) {
    if (viewer->behind) {
      continue;
    }
    if (!message) { // one for all of them
      message = std::make_shared<v1::WatchReply>();
      message->set_sequence(hub.sequence);
      *message->mutable_command() = command;
      size = message->ByteSizeLong() + 64;
    }
    if (viewer->out.bytes - viewer->partBytes + size > hub.options.unreadBytes) {
      viewer->FallBehind(); // it gets a snapshot when it reads again
    } else {
      viewer->out.Put(message, size);
    }
  }
}

} // namespace dspace::session
