// The files of one command, read in a thread of their own.
#ifndef DSPACE_SESSION_FILES_AHEAD_H
#define DSPACE_SESSION_FILES_AHEAD_H

#include <memory>

#include <dspace/FilesRead.h>
#include <dspace/proto/commands.pb.h>
#include <dspace/state/ReadBeforehand.h>
#include <dspace/state/State.h>

namespace dspace::session {

// Call Begin(), ask IsRead() until it is true, then execute ToExecute() within a
// ReadBeforehand::Scope(Files()), all in the session's thread. The reading thread owns what it
// uses, so that this object may be destroyed at any time.
class FilesAhead {
public:
  // Null: the command reads no files, or the session has them already. `look`: of a FilesGuard
  // around reading; empty: none.
  static std::unique_ptr<FilesAhead> Begin(State& state, const v1::Command& command,
                                           FilesGuard::Check look = {});
  ~FilesAhead();
  FilesAhead(const FilesAhead&) = delete;
  FilesAhead& operator=(const FilesAhead&) = delete;

  // Waits for it up to this time [s].
  bool IsRead(double seconds = 0.0) const;

  // The next three once IsRead(). A reply with the error of reading, or without one.
  const v1::Reply& Failed() const;
  // The command with the names that the files were read for, or as it was given if these names are
  // taken by now.
  const v1::Command& ToExecute(const State& state) const;
  ReadBeforehand* Files() const;

private:
  struct Job;
  explicit FilesAhead(std::unique_ptr<Job> job);
  std::unique_ptr<Job> Job_;
};

} // namespace dspace::session

#endif
