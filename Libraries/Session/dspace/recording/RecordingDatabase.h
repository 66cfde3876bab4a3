// SQLite as recordings use it. Not a public header.
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

// A recording's tables, open for reading. Throws Error: Io where the operating system or another
// process stands in the way, Corrupt for anything else that SQLite reports.
class RecordingDatabase {
public:
  // A statement that is reset when this goes. Columns and parameters count from 0 and from 1.
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

  // All that is read while this lives is the file as it was at the first read, though another
  // process writes. One within another has no effect.
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

  // How long a read waits for a process that has locked the file [s], up to 1e6; 10 at first.
  void SetTimeout(double seconds);

  // The first column of the first row; `otherwise` where there is none.
  std::int64_t Number(const char* sql, std::int64_t otherwise) const;
  // Throws Corrupt.
  [[noreturn]] void Damaged(const std::string& what) const;

  // Whether the last error was that the file is not one of SQLite's.
  bool IsNoDatabase() const;

  const std::string& Path() const { return this->Path_; }
  sqlite3* Handle() const { return this->Handle_; }

  // The name by which SQLite opens a file for reading only.
  static std::string UriOf(const std::string& path);

private:
  [[noreturn]] void Fail(int result) const;

  const std::string Path_; // absolute
  sqlite3* Handle_ = nullptr;
};

} // namespace dspace::session

#endif
