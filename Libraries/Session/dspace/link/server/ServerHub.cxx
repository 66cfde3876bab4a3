#include <dspace/link/server/ServerHub.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include <dspace/link/ProcessName.h>
#include <dspace/messages/ErrorReply.h>

namespace dspace::session {
namespace {

constexpr std::size_t KeptReplies = 1024;
constexpr std::size_t RecycledCommands = 16;
constexpr std::size_t RecycledBytes = 1 << 20;                // of each at most
constexpr std::chrono::milliseconds SnapshotPause{100};       // between two of them, at least
constexpr std::uint64_t DoneEvery = 32;                       // commands without replies, at least
constexpr std::size_t LargestReply = std::size_t(2000) << 20; // protobuf's own limit is 2 GiB

} // namespace

void Server::Hub::Acknowledge(std::uint64_t number) {
  Writer& to = this->writer;
  while (!to.kept.empty() && to.kept.begin()->first <= number) {
    to.keptBytes -= to.kept.begin()->second.second;
    to.kept.erase(to.kept.begin());
  }
}

void Server::Hub::Recycle(v1::Command&& command, std::size_t bytes) {
  if (this->recycled.size() < RecycledCommands && bytes <= RecycledBytes) {
    this->recycled.push_back(std::move(command));
  }
}

void Server::Hub::Answer(std::uint64_t number, bool noReply, v1::Reply reply) {
  const bool silent =
      noReply && !reply.has_error() && reply.warning().empty() && reply.frame_event().empty();
  if (silent) {
    this->writer.unacknowledgedDone = number; // the next message covers this one too
    if (number % DoneEvery == 0) {
      this->SendDone();
    }
    return;
  }
  this->writer.unacknowledgedDone = 0;
  auto message = std::make_shared<v1::DriveReply>();
  message->mutable_done()->set_number(number);
  std::size_t size = reply.ByteSizeLong() + 64;
  if (size > LargestReply) {
    PutError(message->mutable_done()->mutable_reply()->mutable_error(), v1::Error::RESOURCE,
             "reply",
             "reply: it has " + std::to_string(size) + " bytes; accepted: up to 2000 MiB in one");
    size = 256;
  } else {
    message->mutable_done()->mutable_reply()->Swap(&reply);
  }
  Writer& to = this->writer;
  to.kept[number] = {message, size};
  to.keptBytes += size;
  while (to.kept.size() > 1 &&
         (to.kept.size() > KeptReplies || to.keptBytes > this->options.unreadBytes)) {
    this->Acknowledge(to.kept.begin()->first);
  }
  this->PutToWriter(std::move(message), size);
}

void Server::Hub::SendDone() {
  auto message = std::make_shared<v1::DriveReply>();
  message->mutable_done()->set_number(std::exchange(this->writer.unacknowledgedDone, 0));
  this->PutToWriter(std::move(message), 64);
}

void Server::Hub::PutToWriter(std::shared_ptr<const v1::DriveReply> reply, std::size_t size) {
  const std::shared_ptr<DriveStream>& stream = this->writer.stream;
  if (!stream) {
    return; // the client gets it when it resumes
  }
  auto& out = stream->out;
  const auto silent = [](const v1::DriveReply& m) { return m.has_done() && !m.done().has_reply(); };
  if (!out.messages.empty() && silent(*reply) && silent(*out.messages.back().first)) {
    out.messages.back().first = std::move(reply); // the newer number covers both
    return;
  }
  if (!out.messages.empty() && out.bytes - stream->eventBytes + size > this->options.unreadBytes) {
    out.Clear();
    stream->eventBytes = 0;
    out.ended = true;
    out.ready.notify_one();
    stream->context->TryCancel(); // it does not read; its replies are stored, and it may resume
    return;
  }
  out.Put(std::move(reply), size);
}

void Server::Hub::SendWriterName() {
  auto message = std::make_shared<v1::WatchReply>();
  message->set_sequence(this->sequence);
  message->mutable_writer()->set_name(this->writer.name);
  message->mutable_writer()->set_connected(this->writer.stream != nullptr);
  for (ViewerStream* viewer : this->viewers) {
    const std::size_t size = message->ByteSizeLong() + 64;
    if (viewer->behind) {
      continue;
    }
    if (viewer->out.bytes - viewer->partBytes + size > this->options.unreadBytes) {
      viewer->FallBehind();
    } else {
      viewer->out.Put(message, size);
    }
  }
}

std::string Server::Hub::DriverConflict() const {
  const Writer& who = this->writer;
  if (who.stream && !who.left) {
    return "'" + who.name + "' is the driver; accepted: watch, or take over explicitly";
  }
  const double gone = std::chrono::duration<double>(LinkClock::now() - who.lost).count();
  if (who.key.empty() || who.left || gone >= this->options.reservation_s || HasDied(who.process)) {
    return {};
  }
  return "'" + who.name + "' is the driver and has lost its connection; its reservation ends in " +
         std::to_string(long(std::ceil(this->options.reservation_s - gone))) +
         " s; accepted: watch, wait, or take over explicitly";
}

LinkClock::time_point Server::Hub::SnapshotDue(LinkClock::time_point otherwise) const {
  for (const ViewerStream* viewer : this->viewers) {
    if (viewer->wantsSnapshot) {
      return std::min(otherwise, this->nextSnapshot);
    }
  }
  return otherwise;
}

void Server::Hub::PutSnapshots(const SessionWork& work, std::unique_lock<std::mutex>& lock) {
  const auto began = LinkClock::now();
  if (this->SnapshotDue(LinkClock::time_point::max()) > began) {
    return; // none is requested, or the last one is too recent
  }
  grpc::Status failed;
  if (!this->snapshot) {
    // Only this thread publishes, so that the state does not change.
    lock.unlock();
    SnapshotLimits limits;
    limits.part = std::min(limits.part, this->options.maximumMessage);
    std::shared_ptr<SnapshotMessages> made;
    try {
      made = std::make_shared<SnapshotMessages>(work.snapshot(), this->sequence, limits);
    } catch (const std::exception& error) {
      failed = {grpc::StatusCode::INTERNAL, std::string("the snapshot failed: ") + error.what()};
    }
    lock.lock();
    this->snapshot = made;
    ++this->counts.snapshots;
    // Frequent new viewers must not stop the driver.
    const auto now = LinkClock::now();
    this->nextSnapshot = now + std::max<LinkClock::duration>(SnapshotPause, 10 * (now - began));
  }
  for (ViewerStream* viewer : this->viewers) {
    if (!viewer->wantsSnapshot) {
      continue;
    }
    viewer->wantsSnapshot = false;
    viewer->failed = failed;
    if (failed.ok()) {
      try {
        for (const SnapshotMessages::Message& each : this->snapshot->For(viewer->takesParts)) {
          viewer->PutPart(each.reply, each.bytes);
        }
        viewer->behind = false;
      } catch (const std::exception& error) { // too large for one message
        viewer->failed = {grpc::StatusCode::RESOURCE_EXHAUSTED, error.what()};
      }
    }
    if (!viewer->failed.ok()) {
      viewer->out.ended = true;
      viewer->out.ready.notify_one();
    }
  }
  this->SendWriterName();
}

void Server::Hub::DisconnectLate() {
  if (this->deadlines.empty()) {
    return;
  }
  const auto now = LinkClock::now();
  for (auto it = this->deadlines.begin(); it != this->deadlines.end();) {
    if (it->second <= now) {
      it->first->TryCancel();
      it = this->deadlines.erase(it);
    } else {
      ++it;
    }
  }
}

} // namespace dspace::session
