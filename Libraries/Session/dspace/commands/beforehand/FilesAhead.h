// The files of one command, read in a thread of their own.
#ifndef DSPACE_SESSION_FILES_AHEAD_H
#define DSPACE_SESSION_FILES_AHEAD_H

#include <memory>

#include <dspace/FilesRead.h>
#include <dspace/proto/commands.pb.h>
#include <dspace/state/ReadBeforehand.h>
#include <dspace/state/State.h>

namespace dspace::session {

// Begin(), ask IsRead() until it is true, then execute ToExecute() within a
// ReadBeforehand::Scope(Files()). All of it in the session's thread. The thread that reads keeps
// what it uses: whoever loses interest may drop this at any time.
class FilesAhead {
public:
  // Null: the command reads no files, or the session has them already. `look`: of a FilesGuard
  // around reading; empty: none.
  static std::unique_ptr<FilesAhead> Begin(State& state, const v1::Command& command,
                                           FilesGuard::Check look = {});

  // Waits for it up to this time [s].
  bool IsRead(double seconds = 0.0) const;

  // Once IsRead(). The reply with the error of reading; without an error: there was none.
  const v1::Reply& Failed() const;
  // With the names that what is read has; as it was given, if they are taken by now.
  const v1::Command& ToExecute(const State& state) const;
  ReadBeforehand* Files() const;

private:
  struct Job;
  explicit FilesAhead(std::shared_ptr<Job> job) : Job_(std::move(job)) {}
  std::shared_ptr<Job> Job_;
};

} // namespace dspace::session

#endif
