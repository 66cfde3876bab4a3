// The thread of vtkDspaceRecorder: follows a server and records what comes. Inside the module only.
#ifndef DSPACE_SESSION_RECORDER_THREAD_H
#define DSPACE_SESSION_RECORDER_THREAD_H

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <dspace/link/watching/Watcher.h>
#include <dspace/recording/RecordingWriter.h>

#include "vtkDspaceSession.h"
#include "vtkSmartPointer.h"

namespace dspace::session {

struct RecorderThread {
  WatcherOptions options;
  std::unique_ptr<Watcher> watcher; // the thread's, once that runs
  std::string path;
  double commitEvery_s = 0.1;
  bool pack = false;
  std::thread thread;

  // Of all below, which both sides use.
  std::mutex mutex;
  std::condition_variable changed;
  bool recording = false; // it has begun
  bool ending = false;    // it is to end
  bool over = false;      // the thread has done all that it will
  std::uint64_t sequence = 0;
  std::uint64_t flushesWanted = 0;
  std::uint64_t flushesDone = 0;
  RecordingCounts counts;
  std::deque<std::string> warnings; // for the simulation

  // What went wrong before the thread is told in `counts`, and so is everything later.
  void Start();
  void End(); // and waits for it
  // Until `test` holds or the thread is over; false where neither is so after that time.
  template<class Test> bool Wait(double seconds, Test test) {
    std::unique_lock lock(this->mutex);
    return this->changed.wait_for(lock,
                                  std::chrono::duration<double>(std::clamp(seconds, 0.0, 1e6)),
                                  [&] { return this->over || test(); });
  }

private:
  using Clock = std::chrono::steady_clock;
  void Run();
  void Follow();
  bool IsRunning();
  void Take(v1::WatchReply& message);
  void Begin(v1::WatchReply& message);
  void CarryOut(v1::Command& command);
  void CheckLink();
  void UpdateCounts();
  void Warn(const std::string& text);
  void Fail(const std::string& why);
  void SetFailure(const std::string& why); // with the mutex held; the first one stays
  std::string Name() const { return "recording '" + this->path + "': "; }

  vtkSmartPointer<vtkDspaceSession> session;
  double time_s = 0.0;   // of the last command that set one
  bool diverged = false; // a command could not be carried out here
  std::string rejection; // that was told last
  Clock::time_point lastContact;
};

} // namespace dspace::session

#endif
