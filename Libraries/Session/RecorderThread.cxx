#include "RecorderThread.h"

#include <cstdio>
#include <utility>
#include <vector>

#include "vtkDspaceRenderContext.h"

namespace dspace::session {
namespace {

constexpr double Slice = 0.1;             // [s] between checks of requests
constexpr std::size_t MostWarnings = 100; // pending warnings

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.15g", value);
  return text;
}

} // namespace

void RecorderThread::Start() {
  try {
    this->thread = std::thread([this] { this->Run(); });
  } catch (const std::exception& error) {
    this->Fail(this->Name() + error.what());
    this->over = true;
  }
}

void RecorderThread::End() {
  {
    const std::lock_guard lock(this->mutex);
    this->ending = true;
  }
  if (this->thread.joinable()) {
    this->thread.join();
  }
}

void RecorderThread::Warn(const std::string& text) {
  const std::lock_guard lock(this->mutex);
  if (this->warnings.size() < MostWarnings) {
    this->warnings.push_back(text);
  }
}

void RecorderThread::Fail(const std::string& why) {
  const std::lock_guard lock(this->mutex);
  this->SetFailure(why);
}

void RecorderThread::SetFailure(const std::string& why) {
  if (!this->counts.failure.empty() || why.empty()) {
    return;
  }
  this->counts.failure = why;
  if (this->recording) {
    this->warnings.push_back(why + "; recording has stopped, what was written stays");
  }
}

void RecorderThread::Run() {
  try {
    this->Follow();
  } catch (const std::exception& error) {
    this->Fail(this->Name() + error.what());
  }
  if (this->session) {
    const std::string failure = this->session->StopRecording();
    this->UpdateCounts();
    if (!failure.empty()) {
      this->Fail(failure);
    }
    this->session = nullptr; // its graphics context belongs to this thread
  }
  this->watcher.reset(); // frees its connection
  const std::lock_guard lock(this->mutex);
  this->over = true;
  this->changed.notify_all();
}

void RecorderThread::Follow() {
  std::vector<v1::WatchReply> messages;
  this->lastContact = Clock::now();
  while (this->IsRunning()) {
    if (this->watcher->TakeAll(messages, Slice)) {
      for (v1::WatchReply& message : messages) {
        if (!this->IsRunning()) {
          return;
        }
        this->Take(message);
      }
      this->lastContact = Clock::now(); // regardless of the time that this took
    }
    this->CheckLink();
    this->UpdateCounts();
  }
}

bool RecorderThread::IsRunning() {
  const std::lock_guard lock(this->mutex);
  return !this->ending && this->counts.failure.empty();
}

void RecorderThread::Take(v1::WatchReply& message) {
  if (message.has_snapshot()) {
    this->Begin(message);
  } else if (message.has_command()) {
    this->Execute(*message.mutable_command());
  }
  const std::lock_guard lock(this->mutex);
  this->sequence = message.sequence();
}

void RecorderThread::Execute(v1::Command& command) {
  if (command.has_set_time()) {
    this->time_s = command.set_time().time_s();
  }
  const v1::Reply reply = this->session->GetInterpreter().Execute(command);
  if (reply.has_error()) {
    this->session->AddFailed(command, reply.error().message());
    if (!std::exchange(this->diverged, true)) {
      this->Warn(this->Name() + "a command of the server failed here (" + reply.error().message() +
                 "); it is recorded, but the recording has no snapshots from here on");
    }
  }
}

void RecorderThread::Begin(v1::WatchReply& message) {
  std::uint64_t before = 0;
  bool first = false;
  {
    const std::lock_guard lock(this->mutex);
    before = this->sequence;
    first = !this->recording;
  }
  if (!first && message.sequence() < before) {
    this->Fail(this->Name() + "the server at '" + this->options.address +
               "' was restarted and has other scenes");
    return;
  }
  const vtkSmartPointer<vtkDspaceSession> old = this->session;
  this->session = vtkSmartPointer<vtkDspaceSession>::New();
  if (old) { // keeps the render context with its GPU resources
    this->session->SetRenderContext(old->GetRenderContext());
  }
  this->diverged = false;
  for (v1::Command& command : *message.mutable_snapshot()->mutable_command()) {
    this->Execute(command);
  }
  if (!first) {
    this->session->TakeRecording(old);
    this->Warn(this->Name() +
               "the connection to the server was lost, or this process was too slow: " +
               std::to_string(message.sequence() - before) +
               " commands are missing before simulation time " + Number(this->time_s) +
               " s; the recording has a gap there");
    return;
  }
  const std::string failure = this->session->Record(this->path, this->commitEvery_s, this->pack);
  const std::lock_guard lock(this->mutex);
  this->counts.failure = failure;
  this->recording = failure.empty();
  this->sequence = message.sequence();
  this->changed.notify_all();
}

// Checks the connection to the server.
void RecorderThread::CheckLink() {
  std::string why;
  if (this->watcher->Connected(&why)) {
    this->lastContact = Clock::now();
    this->rejection.clear();
    return;
  }
  const std::string said = this->watcher->Rejection();
  if (!said.empty()) { // the server may accept it later
    this->lastContact = Clock::now();
    if (said != this->rejection) {
      this->rejection = said;
      this->Warn(this->Name() +
                 "nothing is recorded while the server rejects the connection: " + said);
    }
  } else if (Clock::now() - this->lastContact >
             std::chrono::duration<double>(this->options.timeout_s)) {
    this->Fail(this->Name() + "the server at '" + this->options.address +
               "' has not responded for " + Number(this->options.timeout_s) + " s");
  }
}

// Executes requests and updates the counters.
void RecorderThread::UpdateCounts() {
  if (!this->session) {
    return;
  }
  std::uint64_t wanted = 0;
  bool flush = false;
  {
    const std::lock_guard lock(this->mutex);
    wanted = this->flushesWanted;
    flush = wanted > this->flushesDone;
  }
  if (flush) {
    this->session->FlushRecording();
  }
  RecordingCounts now = this->session->GetRecordingCounts();
  const std::lock_guard lock(this->mutex);
  this->flushesDone = wanted;
  this->SetFailure(now.failure);
  now.failure = this->counts.failure;
  this->counts = std::move(now);
  this->changed.notify_all();
}

} // namespace dspace::session
