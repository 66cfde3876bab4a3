#include <dspace/session/RemoteClient.h>

#include <algorithm>
#include <utility>

#include <dspace/Error.h>
#include <dspace/session/ClientLink.h>
#include <dspace/session/Confinement.h>

namespace dspace::session {
namespace {

constexpr std::size_t MostEvents = 10000;

LinkClock::time_point After(double seconds) {
  return LinkClock::now() +
         std::chrono::duration_cast<LinkClock::duration>(std::chrono::duration<double>(seconds));
}

} // namespace

RemoteClient::RemoteClient(const RemoteClientOptions& options) : Link_(new Link(options)) {
  std::unique_lock lock(this->Link_->mutex);
  Link& link = *this->Link_;
  link.thread = std::thread([this] { this->Link_->Keep(); });
  const bool done = link.changed.wait_until(lock, After(options.timeout_s),
                                            [&] { return link.opened || link.broken; });
  if (done && !link.broken) {
    return;
  }
  if (!done) {
    link.Break(v1::Error::DEADLINE_EXCEEDED,
               "no answer within " + std::to_string(options.timeout_s) + " s");
  }
  const v1::Error error = link.error;
  lock.unlock();
  link.End();
  Raise(error);
}

RemoteClient::~RemoteClient() {
  this->Link_->End();
}

v1::Reply RemoteClient::Execute(v1::Command command) {
  Link& link = *this->Link_;
  MakePathsAbsolute(command);
  std::unique_lock lock(link.mutex);
  std::uint64_t number = 0;
  v1::Reply reply = link.Put(lock, std::move(command), false, &number);
  if (reply.has_error() || number == 0) {
    link.MoveUnasked(reply);
    return reply;
  }
  link.awaited = number;
  const bool come = link.changed.wait_until(lock, After(link.options.timeout_s),
                                            [&] { return link.broken || link.awaited == 0; });
  if (link.awaited == 0) {
    reply = std::move(link.reply);
    link.MoveUnasked(reply);
    return reply;
  }
  link.awaited = 0;
  link.filter.Forget();
  if (!come) {
    return link.Fault(v1::Error::DEADLINE_EXCEEDED,
                      "no reply within " + std::to_string(link.options.timeout_s) +
                          " s; whether the command was carried out is not known");
  }
  *reply.mutable_error() = link.error;
  return reply;
}

v1::Reply RemoteClient::Send(v1::Command command) {
  Link& link = *this->Link_;
  MakePathsAbsolute(command);
  std::unique_lock lock(link.mutex);
  v1::Reply reply = link.Put(lock, std::move(command), true, nullptr);
  link.MoveUnasked(reply);
  return reply;
}

v1::Reply RemoteClient::Flush() {
  Link& link = *this->Link_;
  std::unique_lock lock(link.mutex);
  const bool done = link.changed.wait_until(lock, After(link.options.timeout_s),
                                            [&] { return link.broken || link.done >= link.last; });
  v1::Reply reply;
  if (link.broken) {
    *reply.mutable_error() = link.error;
  } else if (!done) {
    return link.Fault(v1::Error::DEADLINE_EXCEEDED,
                      std::to_string(link.last - link.done) + " commands are not done within " +
                          std::to_string(link.options.timeout_s) + " s");
  }
  if (link.failure.has_error()) { // the first thing that went wrong
    reply = std::exchange(link.failure, {});
  }
  link.MoveUnasked(reply);
  return reply;
}

std::size_t RemoteClient::TakeEvents(const std::function<void(const v1::ViewerEvent&)>& hear,
                                     double wait_s) {
  Link& link = *this->Link_;
  std::unique_lock lock(link.mutex);
  link.changed.wait_until(lock, After(std::clamp(wait_s, 0.0, 1e6)),
                          [&] { return link.broken || !link.events.empty(); });
  const auto events = std::exchange(link.events, {});
  lock.unlock(); // whoever hears may give commands
  for (const v1::ViewerEvent& event : events) {
    hear(event);
  }
  return events.size();
}

RemoteClient::Counts RemoteClient::GetCounts() const {
  const std::lock_guard lock(this->Link_->mutex);
  Counts counts = this->Link_->counts;
  counts.posesLeftOut = this->Link_->filter.LeftOut();
  return counts;
}

// --- What the user's thread does with the link's mutex held ------------------------------------

v1::Reply RemoteClient::Link::Fault(v1::Error::Kind kind, const std::string& message) {
  v1::Reply reply;
  reply.mutable_error()->set_kind(kind);
  reply.mutable_error()->set_object("server '" + this->options.address + "'");
  reply.mutable_error()->set_message("server '" + this->options.address + "': " + message);
  return reply;
}

v1::Reply RemoteClient::Link::Put(std::unique_lock<std::mutex>& lock, v1::Command&& command,
                                  bool noReply, std::uint64_t* number) {
  v1::Reply reply;
  if (this->failure.has_error()) {
    return std::exchange(this->failure, {});
  }
  if (this->options.onlyChanges && !this->filter.Pass(command) && !this->broken) {
    return reply;
  }
  const std::size_t bytes = command.ByteSizeLong() + 64;
  if (this->opened && bytes - 64 > this->maximumMessage) {
    this->filter.Forget();
    return this->Fault(v1::Error::RESOURCE, "the command has " + std::to_string(bytes - 64) +
                                                " bytes; accepted: up to " +
                                                std::to_string(this->maximumMessage));
  }
  const auto room = [&] {
    return this->broken || this->pending.empty() ||
           (this->pending.size() < this->options.windowCommands &&
            this->pendingBytes + bytes <= this->options.windowBytes);
  };
  if (!this->changed.wait_until(lock, After(this->options.timeout_s), room)) {
    this->filter.Forget();
    return this->Fault(v1::Error::DEADLINE_EXCEEDED, "no room to send within " +
                                                         std::to_string(this->options.timeout_s) +
                                                         " s; the command was not sent");
  }
  if (this->broken) {
    *reply.mutable_error() = this->error;
    return reply;
  }
  ++this->last;
  if (this->options.onlyChanges) {
    this->filter.Sent(command, this->last);
  }
  auto request = std::make_shared<v1::DriveRequest>();
  request->mutable_send()->set_number(this->last);
  request->mutable_send()->set_no_reply(noReply);
  request->mutable_send()->set_acknowledged(this->acknowledged);
  request->mutable_send()->mutable_command()->Swap(&command);
  this->pending.push_back({this->last, bytes, std::move(request)});
  this->pendingBytes += bytes;
  ++this->counts.sent;
  this->counts.bytes += bytes - 64;
  this->toSend.notify_one();
  if (number) {
    *number = this->last;
  }
  return reply;
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

// --- What the link's thread does with answers --------------------------------------------------

void RemoteClient::Link::Hear(v1::DriveReply& message) {
  if (message.has_event()) {
    if (this->events.size() >= MostEvents) {
      this->events.pop_front();
    }
    this->events.push_back(std::move(*message.mutable_event()));
  } else if (message.has_closed()) {
    this->broken = true;
    this->error = message.closed().error();
  } else if (message.has_done()) {
    const std::uint64_t number = message.done().number();
    this->done = std::max(this->done, number);
    while (!this->pending.empty() && this->pending.front().number <= number) {
      this->pendingBytes -= this->pending.front().bytes;
      this->pending.pop_front();
      this->next -= this->next > 0 ? 1 : 0;
    }
    if (message.done().has_reply() && number > this->acknowledged) {
      this->acknowledged = number;
      this->TakeReply(number, *message.mutable_done()->mutable_reply());
    }
    this->filter.Accepted(this->done);
  }
  this->changed.notify_all();
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
  if (reply.has_error() && !this->failure.has_error()) {
    *this->failure.mutable_error() = reply.error();
  }
  this->unasked.mutable_warning()->MergeFrom(reply.warning());
  this->unasked.mutable_frame_event()->MergeFrom(reply.frame_event());
}

} // namespace dspace::session
