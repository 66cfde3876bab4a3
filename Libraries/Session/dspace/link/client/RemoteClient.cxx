#include <dspace/link/client/RemoteClient.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include <dspace/Error.h>
#include <dspace/link/LinkChannel.h>
#include <dspace/link/LinkDiagnosis.h>
#include <dspace/link/client/ClientLink.h>
#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/Confinement.h>
#include <dspace/state/State.h>

namespace dspace::session {
namespace {

constexpr double LongWait = 1e6; // [s]: longer than any timeout

} // namespace

RemoteClient::RemoteClient(const RemoteClientOptions& options)
    : RemoteClient(options, NonBlocking()) {
  while (!this->WaitForConnect(options.timeout_s)) {
  }
}

RemoteClient::RemoteClient(const RemoteClientOptions& options, NonBlocking)
    : Link_(new Link(options)) {
  this->Link_->deadline = After(options.timeout_s);
  this->Link_->thread = std::thread([this] { this->Link_->RunConnection(); });
}

RemoteClient::~RemoteClient() {
  if (this->Link_->Forked()) {
    (void)this->Link_.release(); // its threads and connections belong to the parent
    return;
  }
  this->Link_->End();
}

bool RemoteClient::WaitForConnect(double seconds) {
  Link& link = *this->Link_;
  if (link.Forked()) {
    Raise(link.ForkedError().error());
  }
  std::unique_lock lock(link.mutex);
  if (link.changed.wait_until(lock, std::min(link.deadline, After(seconds)),
                              [&] { return link.opened || link.broken; })) {
    if (!link.broken) {
      return true;
    }
  } else if (LinkClock::now() < link.deadline) {
    return false;
  } else {
    lock.unlock(); // the diagnosis takes a moment
    const std::string why =
        DiagnoseConnection(link.options.address, link.options.security.HasCertificates());
    lock.lock();
    if (link.opened && !link.broken) {
      return true;
    }
    if (!link.broken) {
      std::ostringstream text;
      text << "no response within " << link.options.timeout_s << " s: " << why;
      link.Break(v1::Error::DEADLINE_EXCEEDED, text.str());
    }
  }
  const v1::Error error = link.error;
  lock.unlock();
  link.End();
  Raise(error);
}

v1::Reply RemoteClient::Execute(v1::Command command) {
  this->Begin(std::move(command));
  while (!this->Wait(LongWait)) {
  }
  return this->Take();
}

v1::Reply RemoteClient::Send(v1::Command command) {
  this->Begin(std::move(command), false);
  while (!this->Wait(LongWait)) {
  }
  return this->Take();
}

v1::Reply RemoteClient::Flush() {
  this->BeginFlush();
  while (!this->Wait(LongWait)) {
  }
  return this->Take();
}

void RemoteClient::Begin(v1::Command command, bool reply) {
  Link& link = *this->Link_;
  if (link.Forked()) {
    link.Finish(link.ForkedError());
    return;
  }
  MakePathsAbsolute(command);
  this->Abandon();
  link.noReply = !reply;
  link.command = std::move(command);
  link.activity = Link::Activity::Pace;
  const double ahead =
      link.command.has_set_time()
          ? link.pacer.Ahead(
                SceneName(link.command), link.command.set_time().time_s(),
                std::chrono::duration<double>(LinkClock::now().time_since_epoch()).count())
          : 0;
  link.due = ahead > 0 ? After(ahead) : LinkClock::time_point();
}

void RemoteClient::BeginFlush() {
  if (this->Link_->Forked()) {
    this->Link_->Finish(this->Link_->ForkedError());
    return;
  }
  this->Abandon();
  this->Link_->activity = Link::Activity::Flush;
  this->Link_->deadline = After(this->Link_->options.timeout_s);
}

bool RemoteClient::Wait(double seconds) {
  Link& link = *this->Link_;
  if (link.Forked()) {
    return true;
  }
  const auto until = After(std::clamp(seconds, 0.0, LongWait));
  std::unique_lock lock(link.mutex);
  if (link.activity == Link::Activity::Pace) {
    const auto wake = std::min(link.due, until);
    if (link.due > LinkClock::time_point()) { // a failed link does not shorten the wait
      while (LinkClock::now() < wake) {
        link.changed.wait_until(lock, wake);
      }
      if (LinkClock::now() < link.due) {
        return false;
      }
    }
    link.BeginWaitForEarlier();
  }
  if (link.activity == Link::Activity::Earlier && !link.WaitForEarlier(lock, until)) {
    return false;
  }
  if (link.activity == Link::Activity::Window && !link.WaitForWindow(lock, until)) {
    return false;
  }
  if (link.activity == Link::Activity::Reply) {
    return link.WaitForReply(lock, until);
  }
  return link.activity != Link::Activity::Flush || link.WaitForFlush(lock, until);
}

v1::Reply RemoteClient::Take() {
  Link& link = *this->Link_;
  if (link.Forked()) {
    return link.ForkedError();
  }
  if (link.activity != Link::Activity::Done) {
    return link.Fault(v1::Error::INTERNAL,
                      "there is no reply to take; accepted: Begin and Wait first");
  }
  const std::lock_guard lock(link.mutex);
  link.activity = Link::Activity::Nothing;
  v1::Reply reply = std::exchange(link.reply, {});
  link.MoveUnawaitedReplies(reply);
  return reply;
}

void RemoteClient::Abandon() {
  Link& link = *this->Link_;
  if (link.activity == Link::Activity::Nothing || link.Forked()) {
    return;
  }
  const std::lock_guard lock(link.mutex);
  if (link.activity == Link::Activity::Reply) {
    if (link.awaited != 0) { // its reply was not received
      link.abandoned.insert(std::exchange(link.awaited, 0));
    }
    link.filter.Clear(); // it is unknown whether it was executed
  }
  link.reply.Clear();
  link.activity = Link::Activity::Nothing;
}

void RemoteClient::SetPace(double rate) {
  this->Link_->pacer.SetRate(rate);
}

std::size_t RemoteClient::TakeEvents(const std::function<void(const v1::ViewerEvent&)>& handle,
                                     double wait_s) {
  Link& link = *this->Link_;
  if (link.Forked()) {
    return 0;
  }
  std::unique_lock lock(link.mutex);
  link.changed.wait_until(lock, After(std::clamp(wait_s, 0.0, 1e6)),
                          [&] { return link.broken || !link.events.empty(); });
  const auto events = std::exchange(link.events, {});
  link.eventBytes = 0;
  lock.unlock(); // the callback may execute commands
  for (const v1::ViewerEvent& event : events) {
    handle(event);
  }
  return events.size();
}

v1::Reply RemoteClient::Broken() const {
  if (this->Link_->Forked()) {
    return this->Link_->ForkedError();
  }
  const std::lock_guard lock(this->Link_->mutex);
  v1::Reply reply;
  if (this->Link_->broken) {
    *reply.mutable_error() = this->Link_->error;
  }
  return reply;
}

RemoteClient::Counts RemoteClient::GetCounts() const {
  if (this->Link_->Forked()) {
    return {};
  }
  const std::lock_guard lock(this->Link_->mutex);
  Counts counts = this->Link_->counts;
  counts.posesLeftOut = this->Link_->filter.LeftOut();
  return counts;
}

RemoteClient::ServerInfo RemoteClient::GetServer() const {
  if (this->Link_->Forked()) {
    return {};
  }
  const std::lock_guard lock(this->Link_->mutex);
  return this->Link_->server;
}

} // namespace dspace::session
