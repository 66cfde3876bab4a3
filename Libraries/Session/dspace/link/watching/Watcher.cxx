#include <dspace/link/watching/Watcher.h>

#include <algorithm>
#include <sstream>

#include <unistd.h>

#include <dspace/Checks.h>
#include <dspace/Error.h>
#include <dspace/link/LinkChannel.h>
#include <dspace/link/LinkDiagnosis.h>
#include <dspace/link/SnapshotMessages.h>
#include <dspace/link/client/ClientLink.h>
#include <dspace/link/watching/ViewerEventCall.h>
#include <dspace/messages/ErrorReply.h>
#include <dspace/messages/TextFields.h>

namespace dspace::session {
namespace {

using std::chrono::milliseconds;

LinkClock::duration Seconds(double seconds) {
  return std::chrono::duration_cast<LinkClock::duration>(std::chrono::duration<double>(seconds));
}

} // namespace

struct Watcher::Link {
  WatcherOptions options;
  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::Dspace::Stub> stub;
  std::thread thread;
  LinkClock::time_point deadline;             // of the first connection
  const pid_t process = getpid();             // that watches: a child has no such thread
  std::unique_ptr<ViewerEventCall> eventCall; // the user's thread's

  mutable std::mutex mutex; // of all below
  std::condition_variable changed;
  std::deque<std::pair<v1::WatchReply, std::size_t>> messages;
  std::size_t bytes = 0;
  grpc::ClientContext* context = nullptr;
  bool connected = false;
  bool once = false;  // connected
  bool final = false; // never will be
  bool ending = false;
  v1::Error error;       // why it is not connected
  std::string rejection; // the same, if it is what the server says

  bool Forked() const { return getpid() != this->process; }
  v1::Error ForkedError() const {
    v1::Error told;
    const std::string object = "server '" + this->options.address + "'";
    PutError(
        &told, v1::Error::UNSUPPORTED, object,
        object + ": process " + std::to_string(this->process) +
            " opened the connection, and this one is its child; accepted: a connection of its own");
    return told;
  }

  // One stream, until it is lost.
  void Watch() {
    const auto soon = std::chrono::system_clock::now() + milliseconds(200);
    grpc::Status status(grpc::StatusCode::UNAVAILABLE,
                        "it does not respond, or rejects the connection");
    grpc::ClientContext watch; // outlives `context`, through which End cancels
    if (this->channel->WaitForConnected(soon)) {
      {
        const std::lock_guard lock(this->mutex);
        this->context = &watch;
        if (this->ending) {
          watch.TryCancel();
        }
      }
      v1::WatchRequest request;
      request.set_protocol(LinkProtocol);
      request.set_viewer(ToUtf8(this->options.name));
      request.set_parts(true);
      const auto stream = this->stub->Watch(&watch, request);
      v1::WatchReply message;
      SnapshotJoin snapshots;
      std::string broken;
      while (stream->Read(&message)) {
        {
          const std::lock_guard lock(this->mutex);
          this->connected = this->once = true;
          this->rejection.clear();
          this->changed.notify_all();
        }
        try {
          if (!snapshots.Take(message)) {
            continue;
          }
        } catch (const Error& wrong) {
          broken = wrong.what();
          watch.TryCancel();
          break;
        }
        const std::size_t size = message.ByteSizeLong() + 64;
        std::unique_lock lock(this->mutex);
        this->changed.wait(lock, [&] {
          return this->ending || this->messages.empty() ||
                 this->bytes + size <= this->options.waitingBytes;
        });
        if (this->ending) {
          break;
        }
        this->messages.emplace_back(std::move(message), size);
        this->bytes += size;
        message.Clear();
        this->changed.notify_all();
      }
      status = stream->Finish();
      if (!broken.empty()) {
        status = grpc::Status(grpc::StatusCode::DATA_LOSS, broken);
      }
    }
    const std::lock_guard lock(this->mutex);
    this->context = nullptr;
    this->connected = false;
    bool useless = false;
    this->error = ToError(this->options.address, status, useless);
    this->final = useless && !this->once;
    this->rejection = useless ? this->error.message() : std::string();
    this->changed.notify_all();
  }

  void RunConnection() {
    std::unique_lock lock(this->mutex);
    while (!this->ending && !this->final) {
      lock.unlock();
      this->Watch();
      lock.lock();
      const milliseconds pause(this->rejection.empty() ? 100 : 1000);
      this->changed.wait_for(lock, pause, [this] { return this->ending; });
    }
  }

  // Waits for messages and has `take` take some, with the mutex held; false when there are none
  // yet.
  template<class Work> bool TakeWith(double wait_s, Work take) {
    if (this->Forked()) {
      return false;
    }
    std::unique_lock lock(this->mutex);
    this->changed.wait_for(lock, Seconds(std::clamp(wait_s, 0.0, 1e6)),
                           [this] { return !this->messages.empty(); });
    if (this->messages.empty()) {
      return false;
    }
    take(*this);
    this->changed.notify_all();
    return true;
  }

  void End() {
    {
      const std::lock_guard lock(this->mutex);
      this->ending = true;
      if (this->context) {
        this->context->TryCancel();
      }
      this->changed.notify_all();
    }
    if (this->thread.joinable()) {
      this->thread.join();
    }
  }
};

Watcher::Watcher(const WatcherOptions& options) : Watcher(options, NonBlocking()) {
  while (!this->WaitForConnect(options.timeout_s)) {
  }
}

Watcher::Watcher(const WatcherOptions& options, NonBlocking) : Link_(new Link) {
  Link& link = *this->Link_;
  if (!(options.timeout_s > 0 && options.timeout_s <= 1e6)) {
    throw Error(Error::Kind::InvalidArgument, "server '" + options.address + "'",
                "the timeout is " + NumberText(options.timeout_s) +
                    " s; accepted: above 0, up to 1e6");
  }
  link.options = options;
  if (!(options.keepalive_s > 0 && options.keepalive_s <= 1e6)) {
    throw Error(Error::Kind::InvalidArgument, "server '" + options.address + "'",
                "the keepalive time is " + NumberText(options.keepalive_s) +
                    " s; accepted: above 0, up to 1e6");
  }
  link.channel = MakeChannel(options.address, options.security, options.keepalive_s);
  link.stub = v1::Dspace::NewStub(link.channel);
  link.deadline = After(options.timeout_s);
  link.thread = std::thread([&link] { link.RunConnection(); });
}

bool Watcher::WaitForConnect(double seconds) {
  Link& link = *this->Link_;
  if (link.Forked()) {
    Raise(link.ForkedError());
  }
  std::unique_lock lock(link.mutex);
  link.changed.wait_until(lock, std::min(link.deadline, After(std::clamp(seconds, 0.0, 1e6))),
                          [&] { return link.once || link.final; });
  if (link.once) {
    return true;
  }
  if (!link.final && LinkClock::now() < link.deadline) {
    return false;
  }
  const bool late = !link.final;
  std::string why;
  if (late) {
    lock.unlock(); // the diagnosis takes a moment
    why = DiagnoseConnection(link.options.address, link.options.security.HasCertificates());
    lock.lock();
    if (link.once) {
      return true;
    }
  }
  v1::Error error = link.error;
  if (late) {
    const std::string object = "server '" + link.options.address + "'";
    std::ostringstream text;
    text << object << ": no response within " << link.options.timeout_s << " s: " << why;
    PutError(&error, v1::Error::DEADLINE_EXCEEDED, object, text.str());
  }
  lock.unlock();
  link.End();
  Raise(error);
}

Watcher::~Watcher() {
  if (this->Link_->Forked()) {
    (void)this->Link_.release(); // its thread and connection belong to the parent
    return;
  }
  this->Link_->End();
}

bool Watcher::Take(v1::WatchReply& message, double wait_s) {
  return this->Link_->TakeWith(wait_s, [&](Link& link) {
    message = std::move(link.messages.front().first);
    link.bytes -= link.messages.front().second;
    link.messages.pop_front();
  });
}

bool Watcher::TakeAll(std::vector<v1::WatchReply>& messages, double wait_s) {
  messages.clear();
  return this->Link_->TakeWith(wait_s, [&](Link& link) {
    messages.reserve(link.messages.size());
    for (auto& [message, size] : link.messages) {
      messages.push_back(std::move(message));
    }
    link.messages.clear();
    link.bytes = 0;
  });
}

bool Watcher::Connected(std::string* why) const {
  if (this->Link_->Forked()) {
    if (why) {
      *why = this->Link_->ForkedError().message();
    }
    return false;
  }
  const std::lock_guard lock(this->Link_->mutex);
  if (why) {
    *why = this->Link_->connected ? "" : this->Link_->error.message();
  }
  return this->Link_->connected;
}

std::string Watcher::Rejection() const {
  if (this->Link_->Forked()) {
    return {};
  }
  const std::lock_guard lock(this->Link_->mutex);
  return this->Link_->rejection;
}

bool Watcher::SendEvent(const v1::ViewerEvent& event) {
  return this->SendEvent(event, this->Link_->options.timeout_s);
}

bool Watcher::SendEvent(const v1::ViewerEvent& event, double timeout_s) {
  this->BeginSendEvent(event, timeout_s);
  while (!this->WaitForSendEvent(1e6)) {
  }
  return this->TakeSendEventResult();
}

void Watcher::BeginSendEvent(const v1::ViewerEvent& event, double timeout_s) {
  Link& link = *this->Link_;
  if (link.Forked()) {
    Raise(link.ForkedError());
  }
  this->CancelSendEvent();
  v1::TellRequest request;
  request.set_protocol(LinkProtocol);
  *request.mutable_event() = event;
  request.mutable_event()->set_from(ToUtf8(link.options.name));
  RequireUtf8(request, "event");
  link.eventCall = std::make_unique<ViewerEventCall>(
      *link.stub, request, std::clamp(timeout_s, 0.0, link.options.timeout_s));
}

bool Watcher::WaitForSendEvent(double seconds) {
  Link& link = *this->Link_;
  if (link.Forked() || !link.eventCall) {
    return true;
  }
  return link.eventCall->Wait(seconds);
}

bool Watcher::TakeSendEventResult() {
  Link& link = *this->Link_;
  if (link.Forked()) {
    Raise(link.ForkedError());
  }
  if (!link.eventCall || !link.eventCall->Done()) {
    throw Error(Error::Kind::Internal, "event",
                "there is no result to take; accepted: BeginSendEvent and WaitForSendEvent first");
  }
  const std::unique_ptr<ViewerEventCall> told = std::move(link.eventCall);
  if (!told->Status().ok()) {
    bool final = false;
    v1::Error error = ToError(link.options.address, told->Status(), final);
    if (told->Status().error_code() == grpc::StatusCode::DEADLINE_EXCEEDED) {
      error.set_kind(v1::Error::DEADLINE_EXCEEDED);
    }
    Raise(error);
  }
  return told->Delivered();
}

void Watcher::CancelSendEvent() {
  if (!this->Link_->Forked()) { // else it belongs to the parent
    this->Link_->eventCall.reset();
  }
}

} // namespace dspace::session
