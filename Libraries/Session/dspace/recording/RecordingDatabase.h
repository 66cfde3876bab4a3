// SQLite access for recordings. Not a public header.
#ifndef DSPACE_SESSION_RECORDING_DATABASE_H
#define DSPACE_SESSION_RECORDING_DATABASE_H

#include <cstdint>
#include <memory>
#include <string>

struct sqlite3;
struct sqlite3_stmt;

namespace dspace::session {

// The name of a recording in messages, of an absolute path.
std::string RecordingName(const std::string& path);

// A recording's tables, open for reading, with SQLite's defences against files from anywhere
// (RecordingSchema.h). Throws Error: Io for errors of the operating system and locks of other
// processes, Corrupt for all other errors of SQLite, and for a statement that takes more steps than
// the size of the file explains.
class RecordingDatabase {
public:
  // A statement that the destructor resets. Columns are numbered from 0, parameters from 1.
  class Statement {
  public:
    Statement(const RecordingDatabase& database, const char* sql);
    // False after the last row.
    bool Step();
    bool IsNull(int column) const;
    bool IsInteger(int column) const;
    std::int64_t Integer(int column) const;
    double Real(int column) const;
    std::string Bytes(int column) const; // of a BLOB or a text
    Statement& Bind(int parameter, std::int64_t value);

  private:
    const RecordingDatabase& Database_;
    std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> Statement_;
  };

  // A consistent view: all reads during its lifetime see the file as of the first read, even if
  // another process writes. A nested view has no effect.
  class View {
  public:
    explicit View(const RecordingDatabase& database);
    ~View();
    View(const View&) = delete;
    View& operator=(const View&) = delete;

  private:
    const RecordingDatabase& Database_;
    const bool Own_; // not within another one
  };

  explicit RecordingDatabase(const std::string& path);
  ~RecordingDatabase();
  RecordingDatabase(const RecordingDatabase&) = delete;
  RecordingDatabase& operator=(const RecordingDatabase&) = delete;

  // How long a read waits for a process that has locked the file [s], up to 1e6; default 10.
  void SetTimeout(double seconds);

  // The first column of the first row; `otherwise` if there is no row.
  std::int64_t Number(const char* sql, std::int64_t otherwise) const;
  // Throws Corrupt.
  [[noreturn]] void Damaged(const std::string& what) const;

  // Whether the last error was that the file is not an SQLite file.
  bool IsNoDatabase() const;

  const std::string& Path() const { return this->Path_; }
  sqlite3* Handle() const { return this->Handle_; }

  // The URI with which SQLite opens a file read-only.
  static std::string UriOf(const std::string& path);

private:
  [[noreturn]] void Fail(int result) const;
  bool IsEndless() const;

  const std::string Path_; // absolute
  sqlite3* Handle_ = nullptr;
  mutable std::uint64_t Operations_ = 0; // of the present statement, about
  mutable bool Endless_ = false;         // it was broken off for their number
};

} // namespace dspace::session

#endif
