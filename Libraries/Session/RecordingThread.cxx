#include "RecordingThread.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "RecordingReplies.h"

namespace dspace::session {

void RecordingThread::Begin(Work work) {
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    if (!this->Over_) {
      return;
    }
  }
  this->End(); // of the work before, which is over
  this->Ending_ = false;
  const auto run = [this, work = std::move(work)] {
    std::string answer = RecordingAnswer([&](v1::RecordingReply& filled) {
      work(filled, [this] {
        if (this->Ending_) {
          throw Error(Error::Kind::Io, "recording", "the work was cancelled");
        }
      });
    });
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    this->Reply_ = std::move(answer);
    this->Over_ = true;
    this->Changed_.notify_all();
  };
  const std::lock_guard<std::mutex> lock(this->Mutex_); // the thread's answer comes after this
  this->Reply_ = RecordingAnswer([&](v1::RecordingReply&) { this->Thread_ = std::thread(run); });
  this->Over_ = !this->Thread_.joinable(); // the system has no thread left, as the reply says
}

void RecordingThread::End() {
  this->Ending_ = true;
  if (this->Thread_.joinable()) {
    this->Thread_.join();
  }
}

bool RecordingThread::Wait(double seconds) {
  std::unique_lock<std::mutex> lock(this->Mutex_);
  return this->Changed_.wait_for(lock, std::chrono::duration<double>(std::clamp(seconds, 0.0, 1e6)),
                                 [this] { return this->Over_; });
}

std::string RecordingThread::TakeReply() {
  this->Wait(1e6);
  if (this->Thread_.joinable()) {
    this->Thread_.join(); // so that a child of this process has no thread to wait for
  }
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return std::exchange(this->Reply_, std::string());
}

} // namespace dspace::session
