// What a client does with its link's mutex held.
#include <algorithm>
#include <utility>

#include <dspace/interpreter/Interpreter.h>
#include <dspace/link/client/ClientLink.h>
#include <dspace/messages/ErrorReply.h>
#include <dspace/messages/TextFields.h>
#include <dspace/scene/Checks.h>

namespace dspace::session {
namespace {

constexpr std::size_t MostEvents = 10000;
constexpr std::size_t MostEventBytes = 16 << 20;
// How far a sender is ahead of what has been written, while it goes on: a few steps, whose memory
// serves again while it is in the processor's caches. Where it does not go on for a while the other
// side stalls, and the window takes in what comes.
constexpr std::size_t UnsentBytes = 1 << 20;
constexpr std::chrono::milliseconds ToCatchUp{5};

} // namespace

// --- The user's thread -------------------------------------------------------------------------

v1::Reply RemoteClient::Link::Fault(v1::Error::Kind kind, const std::string& message) {
  const std::string object = "server '" + this->options.address + "'";
  return ErrorReply(kind, object, object + ": " + message);
}

void RemoteClient::Link::Finish(v1::Reply&& with) {
  this->reply = std::move(with);
  this->doing = Doing::Done;
}

// A command that is waited for is sent once those are done that nobody waits for: were one of them
// refused, it is not carried out.
void RemoteClient::Link::Settle() {
  this->deadline = After(this->options.timeout_s);
  if (!this->noReply && this->done < this->unawaited && !this->broken) {
    this->doing = Doing::Settle;
  } else {
    this->Admit();
  }
}

bool RemoteClient::Link::WaitToSettle(std::unique_lock<std::mutex>& lock,
                                      LinkClock::time_point until) {
  if (this->changed.wait_until(lock, std::min(until, this->deadline), [this] {
        return this->broken || this->failure.has_error() || this->done >= this->unawaited;
      })) {
    this->Admit();
  } else if (LinkClock::now() < this->deadline) {
    return false;
  } else {
    this->Finish(this->Fault(v1::Error::DEADLINE_EXCEEDED,
                             "commands before this one are not done within " +
                                 NumberText(this->options.timeout_s) + " s; it was not sent"));
  }
  return true;
}

// Looks whether the command is to be sent at all.
void RemoteClient::Link::Admit() {
  this->catchUp = LinkClock::now() + ToCatchUp;
  if (this->failure.has_error()) {
    this->Finish(std::exchange(this->failure, {}));
    return;
  }
  if (FindForeignText(this->command)) { // the server could not parse it, and would never answer
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
    this->filter.Forget();
    this->Finish(this->Fault(v1::Error::RESOURCE, "the command has " + std::to_string(this->bytes) +
                                                      " bytes; accepted: up to " +
                                                      std::to_string(this->server.maximumMessage)));
    return;
  }
  this->bytes += 64;
  this->doing = Doing::Room;
}

bool RemoteClient::Link::WaitForRoom(std::unique_lock<std::mutex>& lock,
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
    this->filter.Forget();
    this->Finish(this->Fault(v1::Error::DEADLINE_EXCEEDED, "no room to send within " +
                                                               NumberText(this->options.timeout_s) +
                                                               " s; the command was not sent"));
  } else if (this->broken) {
    v1::Reply gone;
    *gone.mutable_error() = this->error;
    this->Finish(std::move(gone));
  } else {
    this->Put();
    lock.unlock(); // whoever wakes up wants it
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
    this->doing = Doing::Reply;
  }
}

bool RemoteClient::Link::WaitForReply(std::unique_lock<std::mutex>& lock,
                                      LinkClock::time_point until) {
  const bool come = this->changed.wait_until(lock, std::min(until, this->deadline),
                                             [this] { return this->broken || this->awaited == 0; });
  if (this->awaited == 0) {
    this->doing = Doing::Done; // with the reply that has come
    return true;
  }
  if (!come && LinkClock::now() < this->deadline) {
    return false;
  }
  this->abandoned.insert(std::exchange(this->awaited, 0));
  this->filter.Forget();
  v1::Reply lost;
  if (come) {
    *lost.mutable_error() = this->error;
  } else {
    lost = this->Fault(v1::Error::DEADLINE_EXCEEDED,
                       "no reply within " + NumberText(this->options.timeout_s) +
                           " s; whether the command was carried out is not known");
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
    this->Finish(this->Fault(v1::Error::DEADLINE_EXCEEDED, std::to_string(this->last - this->done) +
                                                               " commands are not done within " +
                                                               NumberText(this->options.timeout_s) +
                                                               " s"));
    return true;
  }
  if (this->failure.has_error()) { // the first thing that went wrong
    result = std::exchange(this->failure, {});
  }
  this->Finish(std::move(result));
  return true;
}

void RemoteClient::Link::MoveUnasked(v1::Reply& reply) {
  // What came before goes before.
  reply.mutable_warning()->MergeFrom(this->unasked.warning());
  if (this->unasked.frame_event_size() > 0) {
    auto events = std::move(*this->unasked.mutable_frame_event());
    events.MergeFrom(reply.frame_event());
    reply.mutable_frame_event()->Swap(&events);
  }
  this->unasked.Clear();
}

// --- The link's threads ------------------------------------------------------------------------

grpc::ByteBuffer RemoteClient::Link::TakeNext() {
  const Pending& command = this->pending[this->next++];
  this->unsentBytes -= command.bytes;
  if (this->unsentBytes <= UnsentBytes / 2) { // not for each: whoever waits then sends several
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

void RemoteClient::Link::Hear(v1::DriveReply& message) {
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
    this->filter.Forget(); // what it set it has not set
  }
  if (number == this->awaited) {
    this->reply = std::move(reply);
    this->awaited = 0;
    return;
  }
  const bool dropped = this->abandoned.count(number) != 0;
  // Replies come in order: none of an earlier number comes any more.
  this->abandoned.erase(this->abandoned.begin(), this->abandoned.upper_bound(number));
  if (reply.has_error() && !dropped && !this->failure.has_error()) {
    *this->failure.mutable_error() = reply.error();
  }
  this->unasked.mutable_warning()->MergeFrom(reply.warning());
  this->unasked.mutable_frame_event()->MergeFrom(reply.frame_event());
}

} // namespace dspace::session
