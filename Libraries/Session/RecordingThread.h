// Work on a recording in a thread of its own, so that Python can handle signals meanwhile. Inside
// the module only.
#ifndef DSPACE_SESSION_RECORDING_THREAD_H
#define DSPACE_SESSION_RECORDING_THREAD_H

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include <dspace/proto/recordings.pb.h>
#include <dspace/recording/CancelCheck.h>

namespace dspace::session {

class RecordingThread {
public:
  using Work = std::function<void(v1::RecordingReply&, const CancelCheck&)>;

  ~RecordingThread() { this->End(); }

  // Begins the work, which answers by filling in the reply or by throwing. One at a time.
  void Begin(Work work);
  // Waits for the answer, at most this long [s]; whether it is there.
  bool Wait(double seconds);
  // The serialized RecordingReply; waits for it.
  std::string TakeReply();
  // Ends the work at its next check, and waits for that.
  void End();

private:
  std::thread Thread_;
  std::atomic<bool> Ending_{false};
  std::mutex Mutex_; // of all below
  std::condition_variable Changed_;
  bool Over_ = true;
  std::string Reply_;
};

} // namespace dspace::session

#endif
