#define PY_SSIZE_T_CLEAN
#include <Python.h> // first, as Python asks

#include <dspace/widgets/console/PythonAttendant.h>

#include <chrono>
#include <utility>

#include <QCoreApplication>
#include <QEventLoop>

#include <dspace/widgets/viewport/QtContext.h>

namespace dspace::widgets {
namespace {

constexpr auto Patience = std::chrono::milliseconds(200);
constexpr auto Pause = std::chrono::milliseconds(30);
constexpr int Breath_ms = 20;

PythonAttendant* present = nullptr; // a breath that is due may come after its attendant has gone

} // namespace

PythonAttendant::PythonAttendant(std::function<void(bool)> busy)
    : Busy_(std::move(busy)), Thread_([this] { this->Watch(); }) {
  present = this;
}

PythonAttendant::~PythonAttendant() {
  present = nullptr;
  {
    const std::lock_guard lock(this->Mutex_);
    this->Ending_ = true;
  }
  this->Changed_.notify_all();
  this->Thread_.join();
}

void PythonAttendant::Begin() {
  if (this->Depth_++ == 0) {
    const std::lock_guard lock(this->Mutex_);
    this->Running_ = true;
    this->Changed_.notify_all();
  }
}

void PythonAttendant::End() {
  if (--this->Depth_ > 0) {
    return;
  }
  {
    const std::lock_guard lock(this->Mutex_);
    this->Running_ = false;
    this->Changed_.notify_all();
  }
  if (std::exchange(this->Told_, false)) {
    this->Busy_(false);
  }
}

void PythonAttendant::Watch() {
  std::unique_lock lock(this->Mutex_);
  while (!this->Ending_) {
    this->Changed_.wait(lock, [this] { return this->Running_ || this->Ending_; });
    bool waited = !this->Changed_.wait_for(lock, Patience,
                                           [this] { return !this->Running_ || this->Ending_; });
    while (waited && !this->Ending_ && this->Running_) {
      if (!this->Asked_) {
        // Python's queue may be full: then the next round asks.
        this->Asked_ = Py_AddPendingCall(&PythonAttendant::Breathe, nullptr) == 0;
        // Python 3.11 looks at calls of other threads only where one wants its lock.
        lock.unlock();
        PyGILState_Release(PyGILState_Ensure());
        lock.lock();
      }
      waited = !this->Changed_.wait_for(lock, Pause,
                                        [this] { return !this->Running_ || this->Ending_; });
    }
  }
}

int PythonAttendant::Breathe(void*) {
  if (!present) {
    return 0;
  }
  PythonAttendant& self = *present;
  {
    const std::lock_guard lock(self.Mutex_);
    self.Asked_ = false;
  }
  if (self.Breathing_ || self.Depth_ == 0) { // the call has ended, or this is one of its breaths
    return 0;
  }
  self.Breathing_ = true;
  if (!std::exchange(self.Told_, true)) {
    self.Busy_(true);
  }
  ReleaseOtherContexts();
  QCoreApplication::processEvents(QEventLoop::AllEvents, Breath_ms);
  self.Breathing_ = false;
  return 0;
}

} // namespace dspace::widgets
