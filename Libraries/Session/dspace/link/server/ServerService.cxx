#include <dspace/link/server/ServerService.h>

#include <algorithm>
#include <thread>

#include <dspace/Checks.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/ErrorReply.h>

namespace dspace::session {
namespace {

using grpc::Status;
using grpc::StatusCode;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds ToOpen{10};
constexpr seconds ToSayGoodbye{10};
constexpr std::size_t LargestEvent = 1 << 20;  // of viewers, bytes
constexpr std::size_t WaitingEvents = 8 << 20; // for one simulation, bytes

// Counts a connection while it exists. Not Good() if there are `maximum` already.
class Connection {
public:
  Connection(unsigned& count, std::mutex& mutex, unsigned maximum) : Count_(count), Mutex_(mutex) {
    const std::lock_guard lock(mutex);
    this->Good_ = count < maximum;
    count += this->Good_ ? 1 : 0;
  }
  ~Connection() {
    if (this->Good_) {
      const std::lock_guard lock(this->Mutex_);
      --this->Count_;
    }
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  bool Good() const { return this->Good_; }

private:
  unsigned& Count_;
  std::mutex& Mutex_;
  bool Good_ = false;
};

Status TooMany(unsigned maximum, const char* what) {
  return {StatusCode::RESOURCE_EXHAUSTED,
          "there are " + std::to_string(maximum) + " " + what + " already; accepted: no more"};
}

// OK, or what is wrong with the protocol version or the name of a client.
Status CheckClient(const std::string& protocol, const std::string& name) {
  if (protocol != LinkProtocol) {
    return {StatusCode::FAILED_PRECONDITION, "the client speaks protocol '" +
                                                 protocol.substr(0, 64) + "'; accepted: '" +
                                                 LinkProtocol + "'"};
  }
  if (name.size() > 256) {
    return {StatusCode::INVALID_ARGUMENT, "the client's name is " + std::to_string(name.size()) +
                                              " bytes long; accepted: up to 256"};
  }
  return Status::OK;
}

// Whether the client closed its side. A broken connection may be reported a moment after the end of
// the stream.
bool HasLeft(const grpc::ServerContext& context) {
  for (int i = 0; i < 10; ++i) {
    if (context.IsCancelled()) {
      return false;
    }
    std::this_thread::sleep_for(milliseconds(i < 5 ? 2 : 10));
  }
  return true;
}

std::shared_ptr<v1::DriveReply> MakeClosed(v1::Error::Kind kind, const std::string& message) {
  auto reply = std::make_shared<v1::DriveReply>();
  PutError(reply->mutable_closed()->mutable_error(), kind, "link", "link: " + message);
  return reply;
}

// Rejects values that a simulation must not take for input of a person.
void CheckEvent(const v1::ViewerEvent& event) {
  if (event.has_edited()) {
    RequireFinite("value '" + event.edited().name() + "'", "the value", event.edited().value());
  } else if (event.has_dragged()) {
    ToPose(event.dragged().pose(), "goal '" + event.dragged().goal() + "'");
  }
}

} // namespace

Status Server::Service::Hello(grpc::ServerContext*, const v1::HelloRequest* request,
                              v1::HelloReply* reply) {
  const Status good = CheckClient(request->protocol(), "");
  if (!good.ok()) {
    return good;
  }
  const std::lock_guard lock(this->Hub_.mutex);
  reply->set_protocol(LinkProtocol);
  reply->set_server(ToUtf8(this->Hub_.options.name));
  reply->set_writer(this->Hub_.writer.stream ? this->Hub_.writer.name : "");
  reply->set_viewers(std::uint32_t(this->Hub_.viewers.size()));
  reply->set_maximum_message(this->Hub_.options.maximumMessage);
  reply->set_command_set(v1::COMMAND_SET_VERSION);
  return Status::OK;
}

// A call of Drive. When it ends, nothing refers to its context, and its sender has ended.
struct Server::Service::Driving {
  Hub& hub;
  grpc::ServerContext* context;
  std::shared_ptr<DriveStream> me;
  std::thread sender;

  ~Driving() {
    std::unique_lock lock(this->hub.mutex);
    this->me->out.ended = true;
    this->me->out.ready.notify_all();
    // A client that does not read its last messages gets no more time than one with a lost
    // connection.
    const auto seat = std::chrono::duration_cast<LinkClock::duration>(
        std::chrono::duration<double>(this->hub.options.reservation_s));
    auto& deadline = this->hub.deadlines[this->context];
    deadline = std::min(deadline, LinkClock::now() + seconds(1) + seat);
    if (this->hub.writer.stream == this->me) {
      this->hub.writer.stream.reset();
      this->hub.writer.lost = LinkClock::now();
      this->hub.SendWriterName();
    }
    lock.unlock();
    if (this->sender.joinable()) {
      this->sender.join();
    }
    lock.lock();
    this->hub.deadlines.erase(this->context);
  }
};

Status Server::Service::Drive(grpc::ServerContext* context, Stream* stream) {
  Hub& hub = this->Hub_;
  const Connection connection(hub.driving, hub.mutex, DrivesAtOnce);
  if (!connection.Good()) {
    return TooMany(DrivesAtOnce, "connections of simulations");
  }
  const auto me = std::make_shared<DriveStream>(context);
  Driving driving{hub, context, me, {}};
  {
    const std::lock_guard lock(hub.mutex);
    hub.deadlines[context] = LinkClock::now() + ToOpen;
  }
  v1::DriveRequest first;
  const bool read = stream->Read(&first);
  if (!read || !first.has_open()) {
    return {StatusCode::INVALID_ARGUMENT, "the first message is not `open`"};
  }
  driving.sender = std::thread([&] { this->SendTo(*stream, *me); });
  std::uint64_t generation = 0;
  {
    const std::lock_guard lock(hub.mutex);
    hub.deadlines[context] = LinkClock::time_point::max();
    const Status good = this->Open(first.open(), me);
    if (!good.ok()) {
      return good;
    }
    generation = hub.writer.generation;
    hub.SendWriterName();
  }
  const Status result = this->Read(*stream, *me, generation);
  const bool left = !result.ok() || HasLeft(*context); // a rejected client is not waited for
  std::unique_lock lock(hub.mutex);
  if (left && hub.writer.stream == me) {
    hub.writer.left = true;
    // Its queued commands are executed, unless the client stops waiting or another client takes
    // over.
    while (!hub.tasks.empty() && !hub.stopping && !me->out.ended && !context->IsCancelled()) {
      hub.space.wait_for(lock, milliseconds(50));
    }
  }
  return result;
}

void Server::Service::SendTo(Stream& stream, DriveStream& me) {
  Hub& hub = this->Hub_;
  std::unique_lock lock(hub.mutex);
  while (true) {
    me.out.ready.wait(lock, [&] { return me.out.ended || !me.out.messages.empty(); });
    if (me.out.messages.empty()) {
      break;
    }
    const std::size_t size = me.out.messages.front().second;
    const auto message = me.out.Take();
    me.eventBytes -= message->has_event() ? size : 0;
    lock.unlock();
    const bool written = stream.Write(*message);
    lock.lock();
    if (!written) {
      me.context->TryCancel(); // so that reading ends
      break;
    }
  }
  me.out.ended = true;
  hub.space.notify_all();
}

Status Server::Service::Open(const v1::OpenDrive& open, const std::shared_ptr<DriveStream>& me) {
  const Status good = CheckClient(open.protocol(), open.client());
  if (!good.ok()) {
    return good;
  }
  if (open.key().size() < 16 || open.key().size() > 64) {
    return {StatusCode::INVALID_ARGUMENT,
            "the key has " + std::to_string(open.key().size()) + " bytes; accepted: 16 to 64"};
  }
  Hub& hub = this->Hub_;
  if (hub.stopping) {
    return {StatusCode::UNAVAILABLE, "the server is shutting down"};
  }
  Writer& writer = hub.writer;
  const bool resumed = writer.key == open.key();
  const std::string taken = resumed || open.take_over() ? std::string() : hub.DriverConflict();
  if (!taken.empty()) {
    return {StatusCode::ALREADY_EXISTS, taken};
  }
  if (open.again() && !resumed) {
    return {
        StatusCode::ABORTED,
        "it was restarted, or another client has driven it since: its scenes are lost or unknown; "
        "accepted: connect again"};
  }
  if (writer.stream) { // a lost connection, or the replaced driver
    DriveStream& old = *writer.stream;
    old.out.Clear();
    old.eventBytes = 0;
    if (resumed) {
      old.context->TryCancel();
    } else {
      old.out.Put(MakeClosed(v1::Error::ALREADY_EXISTS, "'" + open.client() + "' has taken over"),
                  256);
    }
    old.out.ended = true;
    old.out.ready.notify_all();
    hub.deadlines[old.context] = LinkClock::now() + ToSayGoodbye;
  }
  if (!resumed) {
    hub.tasks.clear(); // the new driver must not see them executed
    hub.taskBytes = 0;
    hub.space.notify_all();
    Writer next;
    next.generation = writer.generation + 1;
    next.due = writer.due;
    next.key = open.key();
    writer = std::move(next);
  }
  writer.left = false;
  writer.process = open.process().substr(0, 256);
  writer.name = open.client();
  writer.stream = me;
  hub.Acknowledge(open.acknowledged());
  auto reply = std::make_shared<v1::DriveReply>();
  reply->mutable_opened()->set_protocol(LinkProtocol);
  reply->mutable_opened()->set_server(ToUtf8(hub.options.name));
  reply->mutable_opened()->set_resumed(resumed);
  reply->mutable_opened()->set_last(writer.queued);
  reply->mutable_opened()->set_maximum_message(hub.options.maximumMessage);
  reply->mutable_opened()->set_command_set(v1::COMMAND_SET_VERSION);
  me->out.Put(std::move(reply), 64);
  for (const auto& [number, kept] : writer.kept) {
    me->out.Put(kept.first, kept.second);
  }
  if (resumed) {
    auto done = std::make_shared<v1::DriveReply>();
    done->mutable_done()->set_number(writer.done);
    me->out.Put(std::move(done), 64);
  }
  return Status::OK;
}

Status Server::Service::Read(Stream& stream, DriveStream& me, std::uint64_t generation) {
  Hub& hub = this->Hub_;
  const auto period = std::chrono::duration_cast<LinkClock::duration>(
      std::chrono::duration<double>(1 / hub.options.maximumRate));
  bool absorbing = false; // the session stalls
  v1::DriveRequest request;
  while (stream.Read(&request)) {
    if (!request.has_send()) {
      return {StatusCode::INVALID_ARGUMENT, "a message after the first is not `send`"};
    }
    v1::SendCommand& send = *request.mutable_send();
    std::string rejection = TakeRejection();
    // The memory of the command, which may be far larger than the message: an empty message has two
    // bytes on the wire.
    const std::size_t bytes = send.command().SpaceUsedLong() + sizeof(Task);
    std::unique_lock lock(hub.mutex);
    if (me.out.ended || generation != hub.writer.generation) {
      return Status::OK;
    }
    hub.Acknowledge(send.acknowledged());
    if (send.number() <= hub.writer.queued) {
      continue; // received before the connection was lost
    }
    if (send.number() != hub.writer.queued + 1) {
      return {StatusCode::INVALID_ARGUMENT, "command " + std::to_string(send.number()) +
                                                " came after " + std::to_string(hub.writer.queued) +
                                                "; accepted: the next number"};
    }
    // A client beyond the rate waits, and its further messages wait too. A burst of one second is
    // accepted.
    auto& due = hub.writer.due;
    due = std::max(due, LinkClock::now() - seconds(1)) + period;
    const auto free = [&] {
      return hub.stopping || me.out.ended ||
             (LinkClock::now() >= due &&
              (hub.tasks.empty() || (hub.tasks.size() < hub.options.queuedCommands &&
                                     hub.taskBytes + bytes <= hub.options.queuedBytes)));
    };
    const auto near = [&] {
      return hub.stopping || me.out.ended || hub.tasks.empty() ||
             hub.taskBytes + bytes <= ReadAheadBytes;
    };
    absorbing = !near() && (absorbing || !hub.space.wait_for(lock, ToCatchUp, near));
    while (!free()) {
      const auto now = LinkClock::now();
      hub.space.wait_until(lock, now < due ? due : now + milliseconds(200));
    }
    if (hub.stopping || me.out.ended || generation != hub.writer.generation) {
      return Status::OK;
    }
    hub.writer.queued = send.number();
    Task task{generation, send.number(), send.no_reply(), bytes, {}, {}};
    task.rejection = std::move(rejection);
    task.command.Swap(send.mutable_command());
    if (!hub.recycled.empty()) {
      send.mutable_command()->Swap(&hub.recycled.back());
      hub.recycled.pop_back();
    }
    hub.tasks.push_back(std::move(task));
    hub.taskBytes += bytes;
    lock.unlock(); // the woken thread needs it
    hub.work.notify_one();
  }
  return Status::OK;
}

Status Server::Service::Watch(grpc::ServerContext* context, const v1::WatchRequest* request,
                              grpc::ServerWriter<v1::WatchReply>* stream) {
  Hub& hub = this->Hub_;
  const unsigned most = hub.options.maximumConnections - 1; // one is reserved for the driver
  const Connection connection(hub.watching, hub.mutex, most);
  if (!connection.Good()) {
    return TooMany(most, "viewers");
  }
  const Status good = CheckClient(request->protocol(), request->viewer());
  if (!good.ok()) {
    return good;
  }
  ViewerStream me;
  me.takesParts = request->parts();
  std::unique_lock lock(hub.mutex);
  hub.viewers.insert(&me);
  hub.work.notify_one();
  while (!context->IsCancelled() && !hub.stopping && !me.out.ended) {
    if (me.out.messages.empty()) {
      if (me.behind && !me.wantsSnapshot) {
        me.wantsSnapshot = true;
        hub.work.notify_one();
      }
      me.out.ready.wait_for(lock, milliseconds(200));
      continue;
    }
    const auto message = me.Take();
    lock.unlock();
    const bool written = stream->Write(*message);
    lock.lock();
    if (!written) {
      break;
    }
  }
  hub.viewers.erase(&me);
  return hub.stopping ? Status(StatusCode::UNAVAILABLE, "the server is shutting down") : me.failed;
}

Status Server::Service::Tell(grpc::ServerContext*, const v1::TellRequest* request,
                             v1::TellReply* reply) {
  const Status good = CheckClient(request->protocol(), request->event().from());
  if (!good.ok()) {
    return good;
  }
  auto message = std::make_shared<v1::DriveReply>();
  *message->mutable_event() = request->event();
  const std::size_t size = message->ByteSizeLong() + 64;
  if (size > LargestEvent) {
    return {StatusCode::INVALID_ARGUMENT, "the event has " + std::to_string(size) +
                                              " bytes; accepted: up to " +
                                              std::to_string(LargestEvent)};
  }
  try {
    CheckEvent(request->event());
  } catch (const Error& error) {
    return {StatusCode::INVALID_ARGUMENT, error.what()};
  }
  const std::lock_guard lock(this->Hub_.mutex);
  const auto& writer = this->Hub_.writer.stream;
  // Events of viewers must not disconnect a simulation that does not read.
  if (writer && writer->out.messages.size() < 1000 && writer->eventBytes + size <= WaitingEvents) {
    writer->eventBytes += size;
    writer->out.Put(std::move(message), size);
    reply->set_delivered(true);
  }
  return Status::OK;
}

} // namespace dspace::session
