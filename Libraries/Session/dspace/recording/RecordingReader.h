// What a recording holds: Documentation/Recording.md says how. Nothing is carried out here.
#ifndef DSPACE_SESSION_RECORDING_READER_H
#define DSPACE_SESSION_RECORDING_READER_H

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <dspace/proto/commands.pb.h>
#include <dspace/recording/RecordingAsset.h>

namespace dspace::session {

// A command as it was recorded.
struct RecordedCommand {
  std::uint64_t seq = 0; // from 1
  double time_s = 0.0;   // of the simulation
  double wall_s = 0.0;   // seconds past 1970 UTC
  v1::Command command;
};

// The commands that make the state after command `seq`.
struct RecordedSnapshot {
  std::uint64_t seq = 0; // 0: before any command
  double time_s = 0.0;
  double wall_s = 0.0;
  std::vector<v1::Command> commands;
};

// Reads a recording, also while it is written; from one thread at a time. Every row is checked
// against its checksum when it is read. Throws Error: NotFound (no file), Unsupported (another
// format), Corrupt (a damaged or missing row, named; not a recording).
class RecordingReader {
public:
  explicit RecordingReader(const std::string& path);
  ~RecordingReader();
  RecordingReader(const RecordingReader&) = delete;
  RecordingReader& operator=(const RecordingReader&) = delete;

  const std::string& Path() const;
  // The first and the last command's number; 1 and 0 without any.
  std::uint64_t First();
  std::uint64_t Last();

  // The commands first..last in their order, none missing; an empty range is no error. Until
  // `take` returns false.
  void Read(std::uint64_t first, std::uint64_t last,
            const std::function<bool(RecordedCommand&&)>& take);

  // The last one at or before a command; Corrupt where there is none.
  RecordedSnapshot SnapshotAt(std::uint64_t seq);
  std::vector<std::uint64_t> Snapshots();

  // Number and time [s] of every command that set the time, in whatever scene, in their order.
  std::vector<std::pair<std::uint64_t, double>> Steps();

  // Ranges of commands that are not there, each with its first and last.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> Lost();

  // The files that its commands need, of the rows after that of id `after`: each path's last row,
  // by path.
  std::vector<RecordingAsset> Assets(std::int64_t after = 0);

  // The rows of packed content in their order, by the file's id.
  using PartNumbers = std::map<std::int64_t, std::vector<std::int64_t>>;
  PartNumbers Parts();
  // A packed file's content part by part, RecordingPartBytes at most each. `parts`: its numbers.
  // Corrupt, naming the file and the byte, at the first part that is damaged or not there; whether
  // all of it has the file's SHA-256 is the caller's to see.
  void ReadContent(const RecordingAsset& asset, const std::vector<std::int64_t>& parts,
                   const std::function<void(const std::string&)>& take);

private:
  struct Impl;
  std::unique_ptr<Impl> Impl_;
};

} // namespace dspace::session

#endif
