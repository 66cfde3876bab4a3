#include <dspace/state/WorkThread.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace dspace::session {
namespace {

constexpr double LongestWait = 1e6; // [s]

} // namespace

WorkThread::WorkThread(Work work) {
  this->Thread_ = std::thread([this, work = std::move(work)] {
    std::exception_ptr error;
    try {
      work(*this);
    } catch (...) {
      error = std::current_exception();
    }
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    this->Error_ = error;
    this->Ended_ = true;
    this->Changed_.notify_all();
  });
}

WorkThread::~WorkThread() {
  this->Cancel();
}

void WorkThread::Tell(const Progress& progress) {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Progress_ = progress;
}

bool WorkThread::Wait(const std::optional<double>& seconds) {
  std::unique_lock<std::mutex> lock(this->Mutex_);
  const auto over = [this] { return this->Ended_; };
  if (seconds) {
    this->Changed_.wait_for(lock, std::chrono::duration<double>(std::min(*seconds, LongestWait)),
                            over);
  } else {
    this->Changed_.wait(lock, over);
  }
  return this->Ended_;
}

void WorkThread::Cancel() {
  this->Stop();
  if (this->Thread_.joinable()) {
    this->Thread_.join();
  }
}

WorkThread::Progress WorkThread::Told() const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return this->Progress_;
}

void WorkThread::Check() const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (this->Error_) {
    std::rethrow_exception(this->Error_);
  }
}

} // namespace dspace::session
