// What a recording holds: Documentation/Recording.md describes the file. Nothing is executed here.
#ifndef DSPACE_SESSION_RECORDING_READER_H
#define DSPACE_SESSION_RECORDING_READER_H

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <dspace/proto/commands.pb.h>
#include <dspace/recording/RecordingAsset.h>

namespace dspace::session {

class RecordingDatabase;
struct RecordingContent;
struct RecordingRow;

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
// against its checksum when it is read. Throws Error:
//   NotFound     there is no such file
//   Unsupported  the file is not a recording, or its format is another one
//   Corrupt      a row is damaged or missing; the message names it
//   Io           the operating system rejects the file, or a process has locked it
class RecordingReader {
public:
  explicit RecordingReader(const std::string& path);
  ~RecordingReader();
  RecordingReader(const RecordingReader&) = delete;
  RecordingReader& operator=(const RecordingReader&) = delete;

  const std::string& Path() const; // absolute
  // How long a read waits for a process that has locked the file [s]; default 10.
  void SetTimeout(double seconds);

  // The first and the last command's number; 1 and 0 without any.
  std::uint64_t First();
  std::uint64_t Last();
  // The number of the snapshot that the recording begins with: 0, unless it was cut.
  std::uint64_t Begin();
  // Whether a newer Dspace wrote the file; false where that cannot be read.
  static bool IsNewer(const std::string& path);

  // The commands first..last in their order, none missing; an empty range is no error. Until
  // `take` returns false. The rows' payloads are not parsed.
  void ReadRows(std::uint64_t first, std::uint64_t last,
                const std::function<bool(RecordingRow&&)>& take);
  // The same, parsed.
  void Read(std::uint64_t first, std::uint64_t last,
            const std::function<bool(RecordedCommand&&)>& take);
  // Only commands of these kinds (field numbers in Command), without a look at any other.
  void ReadOnly(const std::vector<int>& kinds, std::uint64_t first, std::uint64_t last,
                const std::function<bool(RecordingRow&&)>& take);

  // The last snapshot at or before a command; Corrupt where there is none.
  RecordingRow SnapshotRow(std::uint64_t seq);
  RecordedSnapshot SnapshotAt(std::uint64_t seq);
  // The snapshots first..last. Until `take` returns false.
  void ReadSnapshots(std::uint64_t first, std::uint64_t last,
                     const std::function<bool(RecordingRow&&)>& take);
  std::vector<std::uint64_t> Snapshots();

  // Number and time [s] of every command that set the time, in their order; in one scene, or in
  // any where there is no name.
  std::vector<std::pair<std::uint64_t, double>>
  Steps(const std::optional<std::string>& scene = std::nullopt);

  // Ranges of commands that are not there, each with its first and last.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> Lost();

  // Sizes of a recording; of its commands only the columns are read, not the checksums.
  struct Kind {
    int kind = 0;
    std::uint64_t count = 0;
    std::uint64_t bytes = 0; // of their payload
  };
  struct Counts {
    std::uint64_t snapshots = 0;
    double firstTime_s = 0.0; // the lowest and the highest time; 0 without commands
    double lastTime_s = 0.0;
    double firstWall_s = 0.0;
    double lastWall_s = 0.0;
    std::vector<Kind> kinds; // the most frequent first
  };
  Counts Count();

  // The files that its commands need, of the rows after that of id `after`: each path's last row,
  // by path.
  std::vector<RecordingAsset> Assets(std::int64_t after = 0);
  // Every row of a file, and every part of packed content as it is stored.
  void ReadAssets(std::int64_t after, const std::function<void(RecordingAsset&&)>& take);
  void ReadParts(const std::function<void(RecordingContent&&)>& take);

  // The rows of packed content in their order, by the file's id.
  using PartNumbers = std::map<std::int64_t, std::vector<std::int64_t>>;
  PartNumbers Parts();
  // A packed file's content part by part, RecordingPartBytes at most each. `parts`: its numbers.
  // Corrupt, naming the file and the byte, at the first part that is damaged or not there. The
  // caller compares the file's SHA-256.
  void ReadContent(const RecordingAsset& asset, const std::vector<std::int64_t>& parts,
                   const std::function<void(const std::string&)>& take);

  // Inside the library only.
  const RecordingDatabase& Database() const { return *this->Database_; }

private:
  void RequireFormat();

  std::unique_ptr<RecordingDatabase> Database_;
};

} // namespace dspace::session

#endif
