// Writes a session's commands to a file that other processes may read at the same time.
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
  double commitEvery_s = 0.1; // 0.001 to 60: the most that a killed process loses,
                              // in addition to the queue
  std::size_t queueBytes =
      64u << 20; // the simulation waits for the disk if it is full; 1 MiB or more
  std::size_t snapshotBytes = 8u << 20;   // minimum distance between snapshots: bytes of commands,
  std::uint64_t snapshotCommands = 20000; // or number of commands
  // Bytes; SQLite limits a row to 1e9. A larger initial state is rejected. If the state grows
  // beyond it, no more snapshots are taken, and seeking takes longer.
  std::size_t largestSnapshot = 900000000;
  std::int64_t maximumPages = 0; // of 64 KiB, for the file; 0: no limit
  int checkpointPages = 2048;    // of the log that start a checkpoint: 128 MiB
  bool pack = false;             // stores the files that the commands need in the recording
  // Wall time, seconds past 1970 UTC; empty: the system's. Recorded times never decrease: if the
  // clock is set back, they stay constant until it catches up.
  std::function<double()> clock;
};

// The content of a recording; `written` and `bytes` survive a crash of the process.
struct RecordingCounts {
  std::uint64_t accepted = 0; // commands that were passed to it
  std::uint64_t written = 0;
  std::uint64_t bytes = 0; // of their payload
  std::uint64_t snapshots = 0;
  std::string failure;              // empty: none; nothing is written after a failure
  std::vector<std::string> missing; // files that should be packed and could not be read
};

// By name: "accepted", "written", "bytes", "snapshots"; 0 for any other.
inline std::uint64_t CountOf(const RecordingCounts& counts, const std::string& name) {
  return name == "accepted"    ? counts.accepted
         : name == "written"   ? counts.written
         : name == "bytes"     ? counts.bytes
         : name == "snapshots" ? counts.snapshots
                               : 0;
}

// Its own thread writes in transactions. The destructor writes what is queued. Call Add and the
// destructor from one thread.
class RecordingWriter {
public:
  // Creates the file. Throws Error(AlreadyExists) if it exists. `initial` is the present state at
  // simulation time `time_s`. `files` has the files that commands have read; null: only the files
  // that commands name are recorded. It must outlive the writer and belongs to the caller's thread.
  // Throws Error(Io) if the file cannot be written, Error(InvalidArgument) for the options, and
  // Error(Resource) if the state exceeds the largest snapshot.
  RecordingWriter(const std::string& path, const Ledger& initial, double time_s,
                  const RecordingOptions& options = {}, const CommandFiles* files = nullptr);
  ~RecordingWriter();
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  // Records an accepted command, after `ledger` has it. After a failure nothing is recorded; the
  // first call then returns the failure, later calls an empty string. Never throws. While the
  // ledger cannot give a snapshot (Ledger::Commands throws), none is taken, and seeking takes
  // longer.
  std::string Add(const v1::Command& accepted, const v1::Reply& reply, const Ledger& ledger);
  // Waits until all commands are written. Returns the failure, or an empty string.
  std::string Flush();
  // Continues with another state: that of `ledger` at `time_s`; `files` has the files that were
  // read for it. The recording reports a lost command here.
  void Resync(const Ledger& ledger, double time_s, const CommandFiles* files);
  RecordingCounts Counts() const;
  const std::string& Path() const;

private:
  struct Impl;
  std::unique_ptr<Impl> Impl_;
};

} // namespace dspace::session

#endif
