// The tables of a recording: made and filled. Used from one thread at a time.
#ifndef DSPACE_SESSION_RECORDING_FILE_H
#define DSPACE_SESSION_RECORDING_FILE_H

#include <cstdint>
#include <string>

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
};

// The first 16 bytes of the SHA-256 of the letter C (a command) or S (a snapshot), seq (8 bytes),
// time_s, wall_s (doubles) and kind (4 bytes), all little-endian, and the payload.
std::string RecordingChecksum(const RecordingRow& row);

// Throws Error(Io) with SQLite's words.
class RecordingFile {
public:
  RecordingFile(const std::string& path, std::int64_t maximumPages);
  ~RecordingFile();
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;

  void Begin();
  void Put(const RecordingRow& row);
  // A file that commands name: its size and SHA-256, once a path. One that cannot be read is noted
  // without them.
  void PutAsset(const std::string& path);
  void Commit();
  void Rollback() noexcept;

private:
  void Run(const char* sql);
  sqlite3_stmt* Prepare(const char* sql);
  void Step(sqlite3_stmt* statement);
  [[noreturn]] void Fail(const char* what);
  void Close() noexcept;

  std::string Path_;
  sqlite3* Database_ = nullptr;
  sqlite3_stmt* Command_ = nullptr;
  sqlite3_stmt* Snapshot_ = nullptr;
  sqlite3_stmt* Asset_ = nullptr;
};

} // namespace dspace::session

#endif
