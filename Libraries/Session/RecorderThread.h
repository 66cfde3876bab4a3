// The thread of vtkDspaceRecorder: follows a server and records its commands. Inside the module
// only.
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
  std::unique_ptr<Watcher> watcher; // belongs to the thread while it runs
  std::string path;
  double commitEvery_s = 0.1;
  bool pack = false;
  std::thread thread;

  // Protects all members below, which both threads use.
  std::mutex mutex;
  std::condition_variable changed;
  bool recording = false; // it has started
  bool ending = false;    // the thread must end
  bool over = false;      // the thread has ended
  std::uint64_t sequence = 0;
  std::uint64_t flushesWanted = 0;
  std::uint64_t flushesDone = 0;
  RecordingCounts counts;
  std::deque<std::string> warnings; // for the simulation

  // Starts the thread. All errors are reported in `counts`.
  void Start();
  void End(); // ends the thread and waits for it
  // Waits until `test` is true or the thread has ended; false after a timeout.
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
  void Execute(v1::Command& command);
  void CheckLink();
  void UpdateCounts();
  void Warn(const std::string& text);
  void Fail(const std::string& why);
  void SetFailure(const std::string& why); // with the mutex held; the first one stays
  std::string Name() const { return "recording '" + this->path + "': "; }

  vtkSmartPointer<vtkDspaceSession> session;
  double time_s = 0.0;   // of the last command that set one
  bool diverged = false; // a command has failed here
  std::string rejection; // the last one that was reported
  Clock::time_point lastContact;
};

} // namespace dspace::session

#endif
