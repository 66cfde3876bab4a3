// The calls of the service, each in a thread of gRPC's.
#include <thread>

#include <dspace/scene/Checks.h>
#include <dspace/session/Convert.h>
#include <dspace/session/ServerHub.h>

namespace dspace::session {
namespace {

using grpc::Status;
using grpc::StatusCode;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds ToOpen{10};
constexpr seconds ToSayGoodbye{2};
constexpr std::size_t LargestEvent = 1 << 20; // of viewers, bytes

Status TooMany(unsigned maximum) {
  return {StatusCode::RESOURCE_EXHAUSTED,
          "there are " + std::to_string(maximum) + " connections already; accepted: no more"};
}

std::shared_ptr<v1::DriveReply> MakeClosed(v1::Error::Kind kind, const std::string& message) {
  auto reply = std::make_shared<v1::DriveReply>();
  v1::Error* error = reply->mutable_closed()->mutable_error();
  error->set_kind(kind);
  error->set_object("link");
  error->set_message("link: " + message);
  return reply;
}

// What a simulation would otherwise take for a person's wish.
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
  reply->set_server(this->Hub_.options.name);
  reply->set_writer(this->Hub_.writer.stream ? this->Hub_.writer.name : "");
  reply->set_viewers(std::uint32_t(this->Hub_.viewers.size()));
  reply->set_maximum_message(this->Hub_.options.maximumMessage);
  reply->set_command_set(v1::COMMAND_SET_VERSION);
  return Status::OK;
}

Status Server::Service::Drive(grpc::ServerContext* context, Stream* stream) {
  Hub& hub = this->Hub_;
  const Connection connection(hub.connections, hub.mutex, hub.options.maximumConnections);
  if (!connection.Good()) {
    return TooMany(hub.options.maximumConnections);
  }
  const auto me = std::make_shared<DriveStream>(context);
  const auto expect = [&](seconds limit) { hub.deadlines[context] = LinkClock::now() + limit; };
  {
    const std::lock_guard lock(hub.mutex);
    expect(ToOpen);
  }
  v1::DriveRequest first;
  const bool read = stream->Read(&first);
  std::uint64_t generation = 0;
  {
    const std::lock_guard lock(hub.mutex);
    hub.deadlines.erase(context);
    if (!read || !first.has_open()) {
      return {StatusCode::INVALID_ARGUMENT, "the first message is not `open`"};
    }
    const Status good = this->Open(first.open(), me);
    if (!good.ok()) {
      return good;
    }
    generation = hub.writer.generation;
    hub.TellWriterName();
  }
  std::thread sender([&] {
    std::unique_lock lock(hub.mutex);
    while (true) {
      me->out.ready.wait(lock, [&] { return me->out.ended || !me->out.messages.empty(); });
      if (me->out.messages.empty()) {
        break;
      }
      const auto message = me->out.Take();
      lock.unlock();
      const bool written = stream->Write(*message);
      lock.lock();
      if (!written) {
        context->TryCancel(); // so that reading ends
        break;
      }
    }
    me->out.ended = true;
    hub.space.notify_all();
  });
  const Status result = this->Read(*stream, *me, generation);
  {
    const std::lock_guard lock(hub.mutex);
    me->out.ended = true;
    me->out.ready.notify_all();
    if (hub.writer.stream == me) {
      hub.writer.stream.reset();
      hub.TellWriterName();
    }
  }
  sender.join();
  const std::lock_guard lock(hub.mutex);
  hub.deadlines.erase(context);
  return result;
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
    return {StatusCode::UNAVAILABLE, "the server is ending"};
  }
  Writer& writer = hub.writer;
  const bool resumed = writer.key == open.key();
  if (!resumed && writer.stream && !open.take_over()) {
    return {StatusCode::ALREADY_EXISTS,
            "'" + writer.name + "' drives; accepted: to watch, or to take over explicitly"};
  }
  if (writer.stream) { // of a lost connection, or of whom it is taken over from
    DriveStream& old = *writer.stream;
    old.out.Clear();
    if (resumed) {
      old.context->TryCancel();
    } else {
      hub.tasks.clear(); // whoever takes over is not to see them done
      hub.taskBytes = 0;
      old.out.Put(MakeClosed(v1::Error::ALREADY_EXISTS, "'" + open.client() + "' has taken over"),
                  256);
    }
    old.out.ended = true;
    old.out.ready.notify_all();
    hub.deadlines[old.context] = LinkClock::now() + ToSayGoodbye;
  }
  if (!resumed) {
    const std::uint64_t next = writer.generation + 1;
    writer = {};
    writer.generation = next;
    writer.key = open.key();
  }
  writer.name = open.client();
  writer.stream = me;
  hub.Acknowledge(open.acknowledged());
  auto reply = std::make_shared<v1::DriveReply>();
  reply->mutable_opened()->set_protocol(LinkProtocol);
  reply->mutable_opened()->set_server(hub.options.name);
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
  auto due = LinkClock::now() - seconds(1); // a second's worth may come at once
  v1::DriveRequest request;
  while (stream.Read(&request)) {
    if (!request.has_send()) {
      return {StatusCode::INVALID_ARGUMENT, "a message after the first is not `send`"};
    }
    v1::SendCommand& send = *request.mutable_send();
    const std::size_t bytes = send.command().ByteSizeLong() + sizeof(Task);
    std::unique_lock lock(hub.mutex);
    if (me.out.ended || generation != hub.writer.generation) {
      return Status::OK;
    }
    hub.Acknowledge(send.acknowledged());
    if (send.number() <= hub.writer.queued) {
      continue; // has come before the connection was lost
    }
    if (send.number() != hub.writer.queued + 1) {
      return {StatusCode::INVALID_ARGUMENT, "command " + std::to_string(send.number()) +
                                                " came after " + std::to_string(hub.writer.queued) +
                                                "; accepted: the next number"};
    }
    // Beyond the rate it waits, and what it sends waits with it.
    due = std::max(due, LinkClock::now() - seconds(1)) + period;
    const auto free = [&] {
      return hub.stopping || me.out.ended ||
             (LinkClock::now() >= due &&
              (hub.tasks.empty() || (hub.tasks.size() < hub.options.queuedCommands &&
                                     hub.taskBytes + bytes <= hub.options.queuedBytes)));
    };
    while (!free()) {
      const auto now = LinkClock::now();
      hub.space.wait_until(lock, now < due ? due : now + milliseconds(200));
    }
    if (hub.stopping || me.out.ended || generation != hub.writer.generation) {
      return Status::OK;
    }
    hub.writer.queued = send.number();
    Task task{generation, send.number(), send.no_reply(), bytes, {}};
    task.command.Swap(send.mutable_command());
    if (!hub.spent.empty()) {
      send.mutable_command()->Swap(&hub.spent.back());
      hub.spent.pop_back();
    }
    hub.tasks.push_back(std::move(task));
    hub.taskBytes += bytes;
    lock.unlock(); // whoever wakes up wants it
    hub.work.notify_one();
  }
  return Status::OK;
}

Status Server::Service::Watch(grpc::ServerContext* context, const v1::WatchRequest* request,
                              grpc::ServerWriter<v1::WatchReply>* stream) {
  Hub& hub = this->Hub_;
  const Connection connection(hub.connections, hub.mutex, hub.options.maximumConnections);
  if (!connection.Good()) {
    return TooMany(hub.options.maximumConnections);
  }
  const Status good = CheckClient(request->protocol(), request->viewer());
  if (!good.ok()) {
    return good;
  }
  ViewerStream me;
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
    const auto message = me.out.Take();
    lock.unlock();
    const bool written = stream->Write(*message);
    lock.lock();
    if (!written) {
      break;
    }
  }
  hub.viewers.erase(&me);
  return hub.stopping ? Status(StatusCode::UNAVAILABLE, "the server is ending") : Status::OK;
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
  // A simulation that does not read is not to be cut off for its viewers' sake.
  if (writer && writer->out.messages.size() < 1000 &&
      writer->out.bytes + size <= this->Hub_.options.unreadBytes / 2) {
    writer->out.Put(std::move(message), size);
    reply->set_delivered(true);
  }
  return Status::OK;
}

} // namespace dspace::session
