// Moves the content of a recording's write-ahead log into the file in the background.
#ifndef DSPACE_SESSION_RECORDING_CHECKPOINTS_H
#define DSPACE_SESSION_RECORDING_CHECKPOINTS_H

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

struct sqlite3;

namespace dspace::session {

// SQLite does this within a commit, which then waits for the disk twice. Here a thread with its own
// connection does it. The writer itself moves the smaller rest that was written during this time
// (After), so that the log restarts. The log never exceeds four times `pages` plus one transaction:
// the writer waits then. A failure loses nothing, because the log still contains everything.
class RecordingCheckpoints {
public:
  // pages: number of pages in the log that starts a checkpoint.
  RecordingCheckpoints(std::string path, int pages);
  ~RecordingCheckpoints();
  RecordingCheckpoints(const RecordingCheckpoints&) = delete;
  RecordingCheckpoints& operator=(const RecordingCheckpoints&) = delete;

  // Call it after a commit, in the writer's thread and with its connection.
  void After(sqlite3* writer, int pagesInLog);

private:
  void Run();
  const std::string Path_;
  const int Pages_;
  std::mutex Mutex_;
  std::condition_variable Changed_;
  enum class Step { Idle, Asked, Done } Step_ = Step::Idle;
  bool Stop_ = false;
  std::thread Thread_;
};

} // namespace dspace::session

#endif
