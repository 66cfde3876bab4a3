// Writes a session's commands into a file that can be read meanwhile.
#ifndef DSPACE_SESSION_RECORDING_WRITER_H
#define DSPACE_SESSION_RECORDING_WRITER_H

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <dspace/ledger/Ledger.h>
#include <dspace/messages/CommandFiles.h>

namespace dspace::session {

// The version of the schema that Documentation/Recording.md describes.
constexpr int RecordingFormat = 1;

struct RecordingOptions {
  double commitEvery_s = 0.1;           // seconds, 0.001 to 60: what a dead process loses at most,
                                        // besides what waits in the queue
  std::size_t queueBytes = 64u << 20;   // then the simulation waits for the disk; 1 MiB and more
  std::size_t snapshotBytes = 8u << 20; // of commands from one snapshot to the next, at least,
  std::uint64_t snapshotCommands = 20000; // or so many commands
  // Bytes; SQLite holds 1e9 in a row. A recording that would begin with a larger state is refused;
  // of one that has grown beyond it no more snapshots are taken: seeking takes longer.
  std::size_t largestSnapshot = 900000000;
  std::int64_t maximumPages = 0; // of 64 KiB, for the file; 0: as the disk has
  int checkpointPages = 2048;    // of the log, which are then moved into the file: 128 MiB
  bool pack = false;             // the files that the commands need become part of the recording
  // Wall time, seconds past 1970 UTC; empty: the system's. It is noted as it grows: one that goes
  // back stands still in the recording until it has caught up.
  std::function<double()> clock;
};

// What a recording holds; `written` and `bytes` are safe on disk up to a crash of the process.
struct RecordingCounts {
  std::uint64_t accepted = 0; // commands that were handed over
  std::uint64_t written = 0;
  std::uint64_t bytes = 0; // of their payload
  std::uint64_t snapshots = 0;
  std::string failure;              // empty: none; nothing more is written after one
  std::vector<std::string> missing; // files that were to be packed and could not be read
};

// By name: "accepted", "written", "bytes", "snapshots"; 0 for any other.
inline std::uint64_t CountOf(const RecordingCounts& counts, const std::string& name) {
  return name == "accepted"    ? counts.accepted
         : name == "written"   ? counts.written
         : name == "bytes"     ? counts.bytes
         : name == "snapshots" ? counts.snapshots
                               : 0;
}

// A thread of its own writes, in transactions. It ends with what is queued when it is destroyed.
// Add, Snapshot and the destructor belong to one thread.
class RecordingWriter {
public:
  // Makes the file; one that is there already is refused with Error(AlreadyExists). `initial` is
  // the present state, at simulation time `time_s`. `files` says what commands have read; null:
  // only the files that they name are noted. It must outlive this, and is the caller's thread's.
  // Throws Error(Io) where it cannot be written, Error(InvalidArgument) for the options, and
  // Error(Resource) where the state is larger than the largest snapshot.
  RecordingWriter(const std::string& path, const Ledger& initial, double time_s,
                  const RecordingOptions& options = {}, const CommandFiles* files = nullptr);
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  // An accepted command, after `ledger` has it. After a failure nothing is kept; the first call
  // then returns what failed, all others an empty string. Never throws. While the ledger has no
  // snapshot to give (Ledger::Commands throws), none is taken: seeking takes longer.
  std::string Add(const v1::Command& accepted, const v1::Reply& reply, const Ledger& ledger);
  // Waits until all that was handed over is written; what failed, or an empty string.
  std::string Flush();
  // What comes next is not what came after the last command: the state is now that of `ledger`, at
  // `time_s`, and `files` has what was read for it. The recording says that a command is lost here.
  void Resync(const Ledger& ledger, double time_s, const CommandFiles* files);
  RecordingCounts Counts() const;
  const std::string& Path() const;

private:
  struct Impl;
  std::unique_ptr<Impl> Impl_;
};

} // namespace dspace::session

#endif
