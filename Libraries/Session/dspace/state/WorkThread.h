// A piece of work in a thread of its own.
#ifndef DSPACE_SESSION_WORK_THREAD_H
#define DSPACE_SESSION_WORK_THREAD_H

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>

namespace dspace::session {

class WorkThread {
public:
  struct Progress {
    double fraction = 0.0;                                 // 0 to 1
    double left = std::numeric_limits<double>::infinity(); // [s], estimated
  };
  using Work = std::function<void(WorkThread&)>;

  // Starts the work. What it throws, Check() throws.
  explicit WorkThread(Work work);
  WorkThread(const WorkThread&) = delete;
  WorkThread& operator=(const WorkThread&) = delete;
  ~WorkThread(); // cancels the work and waits for its end

  // For the work: any thread may call.
  bool IsCancelled() const { return this->Cancelled_; }
  void Tell(const Progress& progress);

  // For the owner. Waits for the end, at most so many seconds if given, and returns whether the
  // work has ended.
  bool Wait(const std::optional<double>& seconds);
  // Tells the work to end.
  void Stop() { this->Cancelled_ = true; }
  // Tells it, and waits until it has ended.
  void Cancel();
  Progress Told() const;
  void Check() const;

private:
  std::atomic<bool> Cancelled_{false};
  mutable std::mutex Mutex_; // of what follows
  std::condition_variable Changed_;
  bool Ended_ = false;
  Progress Progress_;
  std::exception_ptr Error_;
  std::thread Thread_; // last: it uses the others
};

} // namespace dspace::session

#endif
