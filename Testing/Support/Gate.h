// What a test holds back until it has looked.
#ifndef DSPACE_TEST_GATE_H
#define DSPACE_TEST_GATE_H

#include <condition_variable>
#include <mutex>

namespace dspace::testing {

// Opened once; whoever waits goes on then.
class Gate {
public:
  void Wait() {
    std::unique_lock<std::mutex> lock(this->Mutex_);
    this->Opened_.wait(lock, [&] { return this->Open_; });
  }
  void Open() {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    this->Open_ = true;
    this->Opened_.notify_all();
  }

private:
  std::mutex Mutex_;
  std::condition_variable Opened_;
  bool Open_ = false;
};

} // namespace dspace::testing

#endif
