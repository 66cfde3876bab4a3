#include <dspace/link/client/ClientLink.h>

#include <algorithm>
#include <random>
#include <utility>

#include <unistd.h>

#include <grpcpp/impl/codegen/sync_stream.h>

#include <dspace/Checks.h>
#include <dspace/Error.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/link/LinkChannel.h>
#include <dspace/link/ProcessName.h>
#include <dspace/messages/ErrorReply.h>
#include <dspace/messages/TextFields.h>

namespace dspace::session {
namespace {

using std::chrono::milliseconds;

constexpr std::chrono::seconds ToLeave{3};
constexpr std::size_t MostEvents = 10000;
constexpr std::size_t MostEventBytes = 16 << 20;
// How far a sender may be ahead of the written bytes: a few steps, so that their memory is reused
// while it is in the processor's caches. If writing stalls for ToCatchUp, the sender may fill the
// window.
constexpr std::size_t UnsentBytes = 1 << 20;
constexpr std::chrono::milliseconds ToCatchUp{5};

std::string RandomKey() {
  std::random_device device;
  std::string key;
  for (int i = 0; i < 8; ++i) {
    const unsigned value = device();
    key.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  return key;
}

grpc::ByteBuffer ToBytes(const v1::DriveRequest& request) {
  const std::size_t size = request.ByteSizeLong();
  grpc_slice bytes = grpc_slice_malloc(size);
  request.SerializeWithCachedSizesToArray(GRPC_SLICE_START_PTR(bytes));
  const grpc::Slice slice(bytes, grpc::Slice::STEAL_REF);
  return grpc::ByteBuffer(&slice, 1);
}

} // namespace

RemoteClient::Link::Link(const RemoteClientOptions& from)
    : options(from), process(getpid()), key(RandomKey()) {
  if (!(this->options.timeout_s > 0 && this->options.timeout_s <= 1e6)) {
    throw Error(Error::Kind::InvalidArgument, "server '" + this->options.address + "'",
                "the timeout is " + NumberText(this->options.timeout_s) +
                    " s; accepted: above 0, up to 1e6");
  }
  if (!(this->options.keepalive_s > 0 && this->options.keepalive_s <= 1e6)) {
    throw Error(Error::Kind::InvalidArgument, "server '" + this->options.address + "'",
                "the keepalive time is " + NumberText(this->options.keepalive_s) +
                    " s; accepted: above 0, up to 1e6");
  }
  this->pacer.SetRate(this->options.pace);
  this->channel =
      MakeChannel(this->options.address, this->options.security, this->options.keepalive_s);
}

// Drive of the generated stub, for serialized messages.
std::unique_ptr<RemoteClient::Link::Stream> RemoteClient::Link::Call(grpc::ClientContext& context) {
  static const grpc::internal::RpcMethod method("/dspace.v1.Dspace/Drive",
                                                grpc::internal::RpcMethod::BIDI_STREAMING);
  return std::unique_ptr<Stream>(
      grpc::internal::ClientReaderWriterFactory<grpc::ByteBuffer, v1::DriveReply>::Create(
          this->channel.get(), method, &context));
}

bool RemoteClient::Link::Forked() const {
  return getpid() != this->process;
}

v1::Reply RemoteClient::Link::ForkedError() {
  return this->Fault(
      v1::Error::UNSUPPORTED,
      "process " + std::to_string(this->process) +
          " opened the connection, and this one is its child; accepted: a connection "
          "of its own");
}

void RemoteClient::Link::Break(v1::Error::Kind kind, const std::string& message) {
  this->error = this->Fault(kind, message).error();
  this->broken = true;
  this->changed.notify_all();
  this->toSend.notify_all();
}

void RemoteClient::Link::End() {
  {
    std::unique_lock lock(this->mutex);
    this->ending = true;
    this->toSend.notify_all();
    // The writing thread closes the stream, so that the server keeps no reservation.
    if (this->leaving || (this->connected && !this->broken)) {
      this->changed.wait_for(lock, ToLeave, [this] { return !this->context; });
    }
    if (this->context) {
      this->context->TryCancel();
    }
  }
  if (this->thread.joinable()) {
    this->thread.join();
  }
}

// --- The user's thread -------------------------------------------------------------------------

v1::Reply RemoteClient::Link::Fault(v1::Error::Kind kind, const std::string& message) {
  const std::string object = "server '" + this->options.address + "'";
  return ErrorReply(kind, object, object + ": " + message);
}

void RemoteClient::Link::Finish(v1::Reply&& with) {
  this->reply = std::move(with);
  this->activity = Activity::Done;
}

// A command that waits for its reply is sent after all commands without replies are completed. If
// one of these has failed, it is not executed.
void RemoteClient::Link::BeginWaitForEarlier() {
  this->deadline = After(this->options.timeout_s);
  if (!this->noReply && this->done < this->unawaited && !this->broken) {
    this->activity = Activity::Earlier;
  } else {
    this->Admit();
  }
}

bool RemoteClient::Link::WaitForEarlier(std::unique_lock<std::mutex>& lock,
                                        LinkClock::time_point until) {
  if (this->changed.wait_until(lock, std::min(until, this->deadline), [this] {
        return this->broken || this->failure.has_error() || this->done >= this->unawaited;
      })) {
    this->Admit();
  } else if (LinkClock::now() < this->deadline) {
    return false;
  } else {
    this->Finish(
        this->Fault(v1::Error::DEADLINE_EXCEEDED, "earlier commands were not completed within " +
                                                      NumberText(this->options.timeout_s) +
                                                      " s; this command was not sent"));
  }
  return true;
}

// Checks whether the command must be sent.
void RemoteClient::Link::Admit() {
  this->catchUp = LinkClock::now() + ToCatchUp;
  if (this->failure.has_error()) {
    this->Finish(std::exchange(this->failure, {}));
    return;
  }
  if (FindInvalidText(this->command)) { // the server could not parse it and would never reply
    this->Finish(Catch([&]() -> v1::Reply {
      RequireUtf8(this->command, "command " + CommandName(this->command));
      return {};
    }));
    return;
  }
  if (this->options.onlyChanges && !this->filter.Pass(this->command) && !this->broken) {
    this->Finish({});
    return;
  }
  this->bytes = this->command.ByteSizeLong();
  if (this->opened && this->bytes > this->server.maximumMessage) {
    this->filter.Clear();
    this->Finish(this->Fault(v1::Error::RESOURCE, "the command has " + std::to_string(this->bytes) +
                                                      " bytes; accepted: up to " +
                                                      std::to_string(this->server.maximumMessage)));
    return;
  }
  this->bytes += 64;
  this->activity = Activity::Window;
}

bool RemoteClient::Link::WaitForWindow(std::unique_lock<std::mutex>& lock,
                                       LinkClock::time_point until) {
  const auto room = [this] {
    return this->broken || this->pending.empty() ||
           (this->pending.size() < this->options.windowCommands &&
            this->pendingBytes + this->bytes <= this->options.windowBytes);
  };
  const auto near = [this] {
    return this->broken || this->absorbing || this->unsentBytes == 0 ||
           this->unsentBytes + this->bytes <= UnsentBytes;
  };
  this->crowded = !near();
  const bool come =
      this->changed.wait_until(lock, std::min({until, this->deadline, this->catchUp}), near);
  this->crowded = false;
  if (!come) {
    if (LinkClock::now() < std::min(this->deadline, this->catchUp)) {
      return false;
    }
    this->absorbing = true;
  }
  if (!this->changed.wait_until(lock, std::min(until, this->deadline), room)) {
    if (LinkClock::now() < this->deadline) {
      return false;
    }
    this->filter.Clear();
    this->Finish(this->Fault(v1::Error::DEADLINE_EXCEEDED, "the send window stayed full for " +
                                                               NumberText(this->options.timeout_s) +
                                                               " s; the command was not sent"));
  } else if (this->broken) {
    v1::Reply gone;
    *gone.mutable_error() = this->error;
    this->Finish(std::move(gone));
  } else {
    this->Put();
    lock.unlock(); // the woken thread needs it
    this->toSend.notify_one();
    lock.lock();
  }
  return true;
}

void RemoteClient::Link::Put() {
  ++this->last;
  if (this->options.onlyChanges) {
    this->filter.Sent(this->command, this->last);
  }
  v1::SendCommand& send = *this->scratch.mutable_send();
  send.set_number(this->last);
  send.set_no_reply(this->noReply);
  send.set_acknowledged(this->acknowledged);
  send.mutable_command()->Swap(&this->command);
  this->pending.push_back({this->last, this->bytes, ToBytes(this->scratch)});
  this->pendingBytes += this->bytes;
  this->unsentBytes += this->bytes;
  ++this->counts.sent;
  this->counts.bytes += this->bytes - 64;
  if (this->noReply) {
    this->unawaited = this->last;
    this->Finish({});
  } else {
    this->awaited = this->last;
    this->activity = Activity::Reply;
  }
}

bool RemoteClient::Link::WaitForReply(std::unique_lock<std::mutex>& lock,
                                      LinkClock::time_point until) {
  const bool come = this->changed.wait_until(lock, std::min(until, this->deadline),
                                             [this] { return this->broken || this->awaited == 0; });
  if (this->awaited == 0) {
    this->activity = Activity::Done; // with the reply that has come
    return true;
  }
  if (!come && LinkClock::now() < this->deadline) {
    return false;
  }
  this->abandoned.insert(std::exchange(this->awaited, 0));
  this->filter.Clear();
  v1::Reply lost;
  if (come) {
    *lost.mutable_error() = this->error;
  } else {
    lost = this->Fault(v1::Error::DEADLINE_EXCEEDED,
                       "no reply within " + NumberText(this->options.timeout_s) +
                           " s; it is unknown whether the command was executed");
  }
  this->Finish(std::move(lost));
  return true;
}

bool RemoteClient::Link::WaitForFlush(std::unique_lock<std::mutex>& lock,
                                      LinkClock::time_point until) {
  const bool come = this->changed.wait_until(lock, std::min(until, this->deadline), [this] {
    return this->broken || this->done >= this->last;
  });
  v1::Reply result;
  if (this->broken) {
    *result.mutable_error() = this->error;
  } else if (!come && LinkClock::now() < this->deadline) {
    return false;
  } else if (!come) {
    this->Finish(
        this->Fault(v1::Error::DEADLINE_EXCEEDED, std::to_string(this->last - this->done) +
                                                      " commands were not completed within " +
                                                      NumberText(this->options.timeout_s) + " s"));
    return true;
  }
  if (this->failure.has_error()) { // the first thing that went wrong
    result = std::exchange(this->failure, {});
  }
  this->Finish(std::move(result));
  return true;
}

void RemoteClient::Link::MoveUnawaitedReplies(v1::Reply& reply) {
  // Earlier warnings and events come first.
  reply.mutable_warning()->MergeFrom(this->unawaitedReplies.warning());
  if (this->unawaitedReplies.frame_event_size() > 0) {
    auto events = std::move(*this->unawaitedReplies.mutable_frame_event());
    events.MergeFrom(reply.frame_event());
    reply.mutable_frame_event()->Swap(&events);
  }
  this->unawaitedReplies.Clear();
}

// --- The link's threads ------------------------------------------------------------------------

void RemoteClient::Link::RunConnection() {
  auto lost = LinkClock::now();
  std::unique_lock lock(this->mutex);
  while (!this->ending && !this->broken) {
    lock.unlock();
    grpc::Status status;
    const bool opened = this->Drive(status);
    lock.lock();
    if (opened) {
      lost = LinkClock::now();
    }
    if (this->ending || this->broken) {
      break;
    }
    bool final = false;
    const v1::Error error = ToError(this->options.address, status, final);
    // A client that reconnects is not rejected because its old connection still exists. (An opened
    // stream fails with this status because of the size of its messages.)
    const bool crowded =
        this->opened && !opened && status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED;
    final = final && !crowded;
    if (final || LinkClock::now() - lost > std::chrono::duration<double>(this->options.timeout_s)) {
      this->error = error;
      this->broken = true;
      this->changed.notify_all();
      break;
    }
    this->toSend.wait_for(lock, milliseconds(50));
  }
}

bool RemoteClient::Link::Drive(grpc::Status& status) {
  const auto soon = std::chrono::system_clock::now() + milliseconds(200);
  if (!this->channel->WaitForConnected(soon)) {
    status = {grpc::StatusCode::UNAVAILABLE, "it does not respond, or rejects the connection"};
    return false;
  }
  grpc::ClientContext drive;
  std::unique_ptr<Stream> stream;
  v1::DriveRequest open;
  {
    const std::lock_guard lock(this->mutex);
    if (this->ending) {
      return false;
    }
    this->context = &drive;
    open.mutable_open()->set_protocol(LinkProtocol);
    open.mutable_open()->set_client(ToUtf8(this->options.name));
    open.mutable_open()->set_key(this->key);
    open.mutable_open()->set_take_over(this->options.takeOver && !this->opened);
    open.mutable_open()->set_acknowledged(this->acknowledged);
    open.mutable_open()->set_command_set(v1::COMMAND_SET_VERSION);
    open.mutable_open()->set_process(ProcessName());
    open.mutable_open()->set_again(this->opened);
  }
  stream = this->Call(drive);
  v1::DriveReply message;
  const bool answered = stream->Write(ToBytes(open)) && stream->Read(&message);
  bool good = answered && message.has_opened();
  bool over = !answered; // the stream ends with a status
  v1::Reply rejected;
  if (good) {
    const std::lock_guard lock(this->mutex);
    rejected = this->Resume(message.opened());
    good = !rejected.has_error();
    this->leaving = !good;
    this->changed.notify_all();
  }
  if (rejected.has_error()) { // releases the reservation first, then reports the error
    stream->WritesDone();
    over = true;
    while (stream->Read(&message)) {
    }
    const std::lock_guard lock(this->mutex);
    this->error = rejected.error();
    this->broken = true;
    this->changed.notify_all();
  }
  std::thread writer;
  if (good) {
    writer = std::thread([&] { this->Write(*stream); });
    over = true;
    while (over && stream->Read(&message)) {
      {
        const std::lock_guard lock(this->mutex);
        this->HandleReply(message);
        over = !this->broken;
      }
      this->changed.notify_all(); // without the mutex, which the woken thread needs
    }
  }
  {
    const std::lock_guard lock(this->mutex);
    this->connected = false;
    this->toSend.notify_all();
  }
  if (!over) {
    drive.TryCancel();
  }
  if (writer.joinable()) {
    writer.join();
  }
  status = stream->Finish();
  const std::lock_guard lock(this->mutex);
  this->context = nullptr;
  this->leaving = false;
  this->changed.notify_all(); // End waits for it
  return good;
}

v1::Reply RemoteClient::Link::Resume(const v1::Opened& message) {
  if (message.protocol() != LinkProtocol) {
    return this->Fault(v1::Error::UNSUPPORTED, "it speaks protocol '" + message.protocol() +
                                                   "'; accepted: '" + LinkProtocol + "'");
  }
  if (this->opened && !message.resumed()) { // the server does not know `again`
    return this->Fault(v1::Error::IO,
                       "it was restarted, or another client has driven it since: its scenes are "
                       "lost or unknown; accepted: connect again");
  }
  this->counts.reconnections += this->opened ? 1 : 0;
  this->opened = this->connected = true;
  this->server = {message.server(), message.command_set(), message.maximum_message()};
  this->Rewind(message.last());
  return {};
}

void RemoteClient::Link::Write(Stream& stream) {
  std::unique_lock lock(this->mutex);
  while (true) {
    this->toSend.wait(lock, [&] {
      return this->ending || this->broken || !this->connected || this->next < this->pending.size();
    });
    if (this->ending && this->connected && !this->broken) {
      lock.unlock();
      stream.WritesDone();
      return;
    }
    if (this->broken || !this->connected) {
      return;
    }
    const auto request = this->TakeNext();
    grpc::WriteOptions options;
    if (this->next < this->pending.size()) {
      options.set_buffer_hint(); // the next message flushes it
    }
    lock.unlock();
    const bool written = stream.Write(request, options);
    lock.lock();
    if (!written) {
      return; // reading ends too
    }
  }
}

grpc::ByteBuffer RemoteClient::Link::TakeNext() {
  const Pending& command = this->pending[this->next++];
  this->unsentBytes -= command.bytes;
  if (this->unsentBytes <=
      UnsentBytes / 2) { // not for each command: the waiting thread then sends several
    this->absorbing = false;
    if (this->crowded) {
      this->changed.notify_all();
    }
  }
  return command.request;
}

void RemoteClient::Link::Rewind(std::uint64_t last) {
  this->next = 0;
  this->unsentBytes = this->pendingBytes;
  while (this->next < this->pending.size() && this->pending[this->next].number <= last) {
    this->unsentBytes -= this->pending[this->next].bytes;
    ++this->next;
  }
}

void RemoteClient::Link::HandleReply(v1::DriveReply& message) {
  if (message.has_event()) {
    const std::size_t size = message.event().SpaceUsedLong();
    while (!this->events.empty() &&
           (this->events.size() >= MostEvents || this->eventBytes + size > MostEventBytes)) {
      this->eventBytes -= this->events.front().SpaceUsedLong();
      this->events.pop_front();
    }
    this->eventBytes += size;
    this->events.push_back(std::move(*message.mutable_event()));
  } else if (message.has_closed()) {
    this->broken = true;
    this->error = message.closed().error();
  } else if (message.has_done()) {
    const std::uint64_t number = message.done().number();
    this->done = std::max(this->done, number);
    while (!this->pending.empty() && this->pending.front().number <= number) {
      this->pendingBytes -= this->pending.front().bytes;
      this->unsentBytes -= this->next > 0 ? 0 : this->pending.front().bytes;
      this->next -= this->next > 0 ? 1 : 0;
      this->pending.pop_front();
    }
    if (message.done().has_reply() && number > this->acknowledged) {
      this->acknowledged = number;
      this->TakeReply(number, *message.mutable_done()->mutable_reply());
    }
    this->filter.Accepted(this->done);
  }
}

void RemoteClient::Link::TakeReply(std::uint64_t number, v1::Reply& reply) {
  if (reply.has_error()) {
    this->filter.Clear(); // its values were not set
  }
  if (number == this->awaited) {
    this->reply = std::move(reply);
    this->awaited = 0;
    return;
  }
  const bool dropped = this->abandoned.count(number) != 0;
  // Replies come in order: there will be none for an earlier number.
  this->abandoned.erase(this->abandoned.begin(), this->abandoned.upper_bound(number));
  if (reply.has_error() && !dropped && !this->failure.has_error()) {
    *this->failure.mutable_error() = reply.error();
  }
  this->unawaitedReplies.mutable_warning()->MergeFrom(reply.warning());
  this->unawaitedReplies.mutable_frame_event()->MergeFrom(reply.frame_event());
}

} // namespace dspace::session
