// Moves what a recording's log holds into the file itself, beside the writing.
#ifndef DSPACE_SESSION_RECORDING_CHECKPOINTS_H
#define DSPACE_SESSION_RECORDING_CHECKPOINTS_H

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

struct sqlite3;

namespace dspace::session {

// SQLite does this within a commit, which then waits for the disk twice. Here a thread with a
// connection of its own does it; what was written meanwhile, which is less, the writer moves itself
// (After), so that the log begins anew. It never grows beyond four times `pages` and a transaction:
// then the writer waits. A failure loses nothing: all is in the log.
class RecordingCheckpoints {
public:
  // pages: of the log, from which on it is worth it.
  RecordingCheckpoints(std::string path, int pages);
  ~RecordingCheckpoints();
  RecordingCheckpoints(const RecordingCheckpoints&) = delete;
  RecordingCheckpoints& operator=(const RecordingCheckpoints&) = delete;

  // After a commit, in the writer's thread and with its connection.
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
