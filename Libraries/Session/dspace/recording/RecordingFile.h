// Creates and fills the tables of a recording. Use it from one thread at a time.
#ifndef DSPACE_SESSION_RECORDING_FILE_H
#define DSPACE_SESSION_RECORDING_FILE_H

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <dspace/messages/Sha256.h>
#include <dspace/recording/RecordingAsset.h>
#include <dspace/recording/RecordingCheckpoints.h>

struct sqlite3;
struct sqlite3_stmt;

namespace dspace::session {

// A row before its checksum.
struct RecordingRow {
  bool snapshot = false;
  std::uint64_t seq = 0; // of a snapshot: the command after which it was taken; 0: before any
  double time_s = 0.0;   // of the simulation
  double wall_s = 0.0;   // seconds past 1970 UTC
  std::int32_t kind = 0; // field number of the command; of a snapshot: the number of its commands
  std::string payload;
  // Arrays of meshes that the recording does not have yet: their digest and bytes
  // (MeshMessages.h). They are not part of the row.
  std::vector<std::pair<std::string, std::string>> arrays = {};
};

// The first 16 bytes of the SHA-256 of the letter C (a command) or S (a snapshot), seq (8 bytes),
// time_s, wall_s (doubles) and kind (4 bytes), all little-endian, and the payload.
std::string RecordingChecksum(const RecordingRow& row);
// As above; reuses `sum`, because its creation takes longer than a small row.
std::string RecordingChecksum(Sha256& sum, const RecordingRow& row);

// A part of a packed file's content.
struct RecordingContent {
  std::int64_t id = 0;
  std::int64_t asset = 0;
  std::int64_t place = 0; // byte of the file that it begins with
  std::int64_t size = 0;  // bytes of the file; where `data` has fewer, it is zlib's
  std::string data;
};

// As above, each number after its letter: A, id, size, packed (1 byte), the lengths of state, path
// and hash, these. P, id, asset, place, size, data. Numbers have 8 bytes.
std::string RecordingChecksum(const RecordingAsset& asset);
std::string RecordingChecksum(const RecordingContent& content);

class NewRecording;

// The tables of a recording. Throws Error(Io) with SQLite's message.
class RecordingFile {
public:
  // Creates a recording for a session. Throws Error(AlreadyExists) if the file exists.
  // maximumPages: 0: no limit.
  RecordingFile(const std::string& path, std::int64_t maximumPages, int checkpointPages);
  // Creates a recording from the rows of another one. If a number occurs more than once, the first
  // row is stored; for a file, the packed row.
  explicit RecordingFile(const NewRecording& made);
  // Opens a recording to change the rows of its files. Throws Error(Io) if any process has it open.
  // `name`: its name in messages.
  struct Existing {};
  RecordingFile(const std::string& path, const std::string& name, Existing);
  ~RecordingFile();
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;

  void Begin();
  // `checksum`: RecordingChecksum(row).
  void Put(const RecordingRow& row, const std::string& checksum);
  // Records ranges of lost commands: "3-5 9-9".
  void PutLost(const std::string& ranges);
  // Records the number of the first snapshot, if it is not the one before any command.
  void PutBegin(std::uint64_t seq);
  void Put(const RecordingAsset& asset);
  // Replaces the row of this id.
  void Replace(const RecordingAsset& asset);
  void Put(const RecordingContent& content);
  void RemoveContent(std::int64_t asset);
  std::int64_t LastContent(); // the highest id; 0 without any
  void Commit();
  // Counts the written bytes, and commits and restarts the transaction after each 64 MiB.
  void CommitEach(std::size_t bytes);
  void Rollback() noexcept;
  // Moves the log into the file, which is then complete by itself. Throws Error(Io) where that is
  // not possible, on a full disk for example; the destructor would not say so. Nothing may follow.
  void Finish();

private:
  void Open(int flags);
  void Make(std::int64_t maximumPages, int checkpointPages, bool repeated);
  void PrepareAll(bool repeated);
  void Put(sqlite3_stmt* statement, const RecordingAsset& asset);
  void Run(const char* sql);
  sqlite3_stmt* Prepare(const char* sql);
  void Step(sqlite3_stmt* statement);
  [[noreturn]] void Fail(const char* what);
  void Close() noexcept;
  void FinalizeAll() noexcept;

  std::string Path_;
  std::string Name_; // in messages
  sqlite3* Database_ = nullptr;
  sqlite3_stmt* Command_ = nullptr;
  sqlite3_stmt* Snapshot_ = nullptr;
  sqlite3_stmt* Asset_ = nullptr;
  sqlite3_stmt* NewAsset_ = nullptr; // in the place of another row
  sqlite3_stmt* Content_ = nullptr;
  sqlite3_stmt* Meta_ = nullptr;
  std::size_t Uncommitted_ = 0; // bytes
  int PagesInLog_ = 0;
  std::unique_ptr<RecordingCheckpoints> Checkpoints_;
};

} // namespace dspace::session

#endif
