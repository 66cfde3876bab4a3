// Reads the content of a recording without executing it. Documentation/Recording.md describes the
// file.
#ifndef DSPACE_SESSION_RECORDING_READER_H
#define DSPACE_SESSION_RECORDING_READER_H

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
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
  bool foreignText = false; // it had text of another encoding, which is UTF-8 here (ForeignRows)
};

// The commands that create the state after command `seq`.
struct RecordedSnapshot {
  std::uint64_t seq = 0; // 0: before any command
  double time_s = 0.0;
  double wall_s = 0.0;
  std::vector<v1::Command> commands;
  bool foreignText = false;
};

// The rows whose text is not UTF-8: earlier versions recorded names from files as the files had
// them. Such text is read as ToUtf8 (Utf8.h) takes it, which gives the names that a file is read
// with now.
inline constexpr const char* ForeignTextNote =
    " holds text that is not UTF-8; it is read as Windows-1252 (Latin-1)";
struct ForeignRows {
  std::set<std::pair<std::uint64_t, bool>> rows; // seq, and whether it is a snapshot

  // Adds the row if it is one.
  void Look(const RecordingRow& row);
  // "command 17", "snapshot 0": of the first ten.
  std::vector<std::string> Names() const;
};

// Reads a recording, also while it is being written. Use it from one thread at a time. Every read
// verifies the checksum of the row. Throws Error:
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

  // The numbers of the first and the last command; 1 and 0 if there are none.
  std::uint64_t First();
  std::uint64_t Last();
  // The number of the first snapshot: 0, unless the recording was cut.
  std::uint64_t Begin();
  // Whether a newer Dspace wrote the file; false if this cannot be read.
  static bool IsNewer(const std::string& path);

  // Reads the commands first..last in order, without gaps, until `take` returns false. An empty
  // range is no error. The payloads are not parsed, and their text may not be UTF-8.
  void ReadRows(std::uint64_t first, std::uint64_t last,
                const std::function<bool(RecordingRow&&)>& take);
  // Reads the commands as ReadRows does, and parses them.
  void Read(std::uint64_t first, std::uint64_t last,
            const std::function<bool(RecordedCommand&&)>& take);
  // Reads only commands of these kinds (field numbers in Command) and does not check others.
  void ReadOnly(const std::vector<int>& kinds, std::uint64_t first, std::uint64_t last,
                const std::function<bool(RecordingRow&&)>& take);

  // The last snapshot at or before a command; Corrupt if there is none.
  RecordingRow SnapshotRow(std::uint64_t seq);
  RecordedSnapshot SnapshotAt(std::uint64_t seq);
  // Reads the snapshots first..last until `take` returns false.
  void ReadSnapshots(std::uint64_t first, std::uint64_t last,
                     const std::function<bool(RecordingRow&&)>& take);
  std::vector<std::uint64_t> Snapshots();

  // Number and time [s] of every command that set the time, in order; of one scene, or of all
  // scenes without a name.
  std::vector<std::pair<std::uint64_t, double>>
  Steps(const std::optional<std::string>& scene = std::nullopt);

  // Ranges of missing commands, each with its first and last number.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> Lost();

  // The sizes of a recording. Reads only columns of its commands and does not verify checksums.
  struct Kind {
    int kind = 0;
    std::uint64_t count = 0;
    std::uint64_t bytes = 0; // of their payload
  };
  struct Counts {
    std::uint64_t snapshots = 0;
    double firstTime_s = 0.0; // lowest and highest time; 0 without commands
    double lastTime_s = 0.0;
    double firstWall_s = 0.0;
    double lastWall_s = 0.0;
    std::vector<Kind> kinds; // the most frequent first
  };
  Counts Count();

  // The files that its commands need, from rows with an id above `after`: the last row of each
  // path, sorted by path.
  std::vector<RecordingAsset> Assets(std::int64_t after = 0);
  // Reads every row of a file, and every stored part of packed content.
  void ReadAssets(std::int64_t after, const std::function<void(RecordingAsset&&)>& take);
  void ReadParts(const std::function<void(RecordingContent&&)>& take);

  // The row numbers of packed content in order, by the file's id.
  using PartNumbers = std::map<std::int64_t, std::vector<std::int64_t>>;
  PartNumbers Parts();
  // Reads a packed file's content in parts of at most RecordingPartBytes. `parts`: its row numbers.
  // Corrupt, naming the file and the byte, for a damaged or missing part. The caller verifies the
  // file's SHA-256.
  void ReadContent(const RecordingAsset& asset, const std::vector<std::int64_t>& parts,
                   const std::function<void(const std::string&)>& take);

  // How many bytes the packed content may have unpacked, all together; 0: 1 GiB and 20 times the
  // size of the recording, which is also the default. A small file may be zlib's of a large one.
  void SetUnpackLimit(std::uint64_t bytes) { this->UnpackLimit_ = bytes; }
  // Throws Error(Resource), naming the limit, if `bytes` are more.
  void RequireUnpackable(std::uint64_t bytes) const;

  // Inside the library only.
  const RecordingDatabase& Database() const { return *this->Database_; }

private:
  void RequireFormat();

  std::unique_ptr<RecordingDatabase> Database_;
  std::uint64_t UnpackLimit_ = 0;
};

} // namespace dspace::session

#endif
