#include <dspace/recording/RecordingDatabase.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <dspace/Error.h>
#include <dspace/recording/RecordingSchema.h>

namespace dspace::session {
namespace {

constexpr double BusySeconds = 10.0; // for a writer that moves its log into the file

// Operations of SQLite's machine that one statement may take: a row of a few bytes takes about
// twenty, a sorted one more. A damaged tree may lead to the same pages again and again, for ever.
constexpr int OperationsACheck = 100000;
constexpr std::uint64_t OperationsOfAny = 2000000;
constexpr std::uint64_t OperationsAByte = 16;

// Result codes (sqlite.org/rescode.html) that say nothing about the file's content: locks, rights,
// memory and disks.
bool IsOfTheSystem(int result) {
  switch (result & 255) {
  case SQLITE_PERM:
  case SQLITE_BUSY:
  case SQLITE_LOCKED:
  case SQLITE_NOMEM:
  case SQLITE_READONLY:
  case SQLITE_INTERRUPT:
  case SQLITE_IOERR:
  case SQLITE_FULL:
  case SQLITE_CANTOPEN:
  case SQLITE_PROTOCOL:
  case SQLITE_NOLFS:
  case SQLITE_AUTH:
    return true;
  default:
    return false;
  }
}

// Not only by its rights: the system may confine this process further.
bool MayMakeFiles(const std::string& folder) {
  if (faccessat(AT_FDCWD, folder.c_str(), W_OK, AT_EACCESS) != 0) {
    return false;
  }
  const int file = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600); // without a name
  const bool rejected = file < 0 && (errno == EACCES || errno == EPERM);
  if (file >= 0) {
    close(file);
  }
  return !rejected;
}

} // namespace

std::string RecordingName(const std::string& path) {
  return "recording '" + path + "'";
}

// SQLite would make files beside a recording that was not closed. Where it cannot, and the log has
// nothing, `immutable` says that nobody writes.
std::string RecordingDatabase::UriOf(const std::string& path) {
  std::string uri = "file:";
  for (const char c : path) {
    uri += c == '%' ? "%25" : c == '?' ? "%3f" : c == '#' ? "%23" : std::string(1, c);
  }
  std::error_code none;
  const auto log = std::filesystem::file_size(path + "-wal", none);
  const bool finished = none || log == 0;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return uri + (finished && !MayMakeFiles(folder) ? "?immutable=1" : "?mode=ro");
}

RecordingDatabase::RecordingDatabase(const std::string& path)
    : Path_(std::filesystem::absolute(path).string()) {
  const int result = sqlite3_open_v2(UriOf(this->Path_).c_str(), &this->Handle_,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  if (result != SQLITE_OK) {
    const std::string why = this->Handle_ ? sqlite3_errmsg(this->Handle_) : "out of memory";
    sqlite3_close(this->Handle_);
    throw Error(Error::Kind::Io, RecordingName(this->Path_), why);
  }
  this->SetTimeout(BusySeconds);
  DefendDatabase(this->Handle_);
  sqlite3_progress_handler(
      this->Handle_, OperationsACheck,
      [](void* self) { return static_cast<const RecordingDatabase*>(self)->IsEndless() ? 1 : 0; },
      this);
}

RecordingDatabase::~RecordingDatabase() {
  sqlite3_close(this->Handle_);
}

void RecordingDatabase::SetTimeout(double seconds) {
  sqlite3_busy_timeout(this->Handle_, int(1e3 * std::clamp(seconds, 0.0, 1e6)));
}

void RecordingDatabase::Damaged(const std::string& what) const {
  throw Error(Error::Kind::Corrupt, RecordingName(this->Path_),
              what + "; `dspace log salvage` recovers what survives");
}

// The file's size is that of now, because another process may be writing it.
bool RecordingDatabase::IsEndless() const {
  this->Operations_ += OperationsACheck;
  if (this->Operations_ <= OperationsOfAny) {
    return false;
  }
  std::uint64_t bytes = 0;
  for (const char* end : {"", "-wal"}) {
    std::error_code none;
    const auto size = std::filesystem::file_size(this->Path_ + end, none);
    bytes += none ? 0 : size;
  }
  this->Endless_ = this->Operations_ > OperationsOfAny + OperationsAByte * bytes;
  return this->Endless_;
}

void RecordingDatabase::Fail(int result) const {
  if (std::exchange(this->Endless_, false)) {
    this->Damaged("reading it takes more steps than a file of its size can hold");
  }
  const std::string said = sqlite3_errmsg(this->Handle_);
  if (IsOfTheSystem(result)) {
    throw Error(Error::Kind::Io, RecordingName(this->Path_),
                said + "; accepted: a file that can be opened and read, in a folder with room, and "
                       "that no process has locked");
  }
  this->Damaged(said);
}

bool RecordingDatabase::IsNoDatabase() const {
  return (sqlite3_errcode(this->Handle_) & 255) == SQLITE_NOTADB;
}

std::int64_t RecordingDatabase::Number(const char* sql, std::int64_t otherwise) const {
  Statement found(*this, sql);
  return found.Step() && !found.IsNull(0) ? found.Integer(0) : otherwise;
}

RecordingDatabase::Statement::Statement(const RecordingDatabase& database, const char* sql)
    : Database_(database), Statement_(nullptr, sqlite3_finalize) {
  sqlite3_stmt* statement = nullptr;
  const int result = sqlite3_prepare_v2(database.Handle(), sql, -1, &statement, nullptr);
  if (result != SQLITE_OK) {
    database.Fail(result);
  }
  database.Operations_ = 0;
  this->Statement_.reset(statement);
}

bool RecordingDatabase::Statement::Step() {
  const int result = sqlite3_step(this->Statement_.get());
  if (result != SQLITE_ROW && result != SQLITE_DONE) {
    this->Database_.Fail(result);
  }
  return result == SQLITE_ROW;
}

bool RecordingDatabase::Statement::IsNull(int column) const {
  return sqlite3_column_type(this->Statement_.get(), column) == SQLITE_NULL;
}

bool RecordingDatabase::Statement::IsInteger(int column) const {
  return sqlite3_column_type(this->Statement_.get(), column) == SQLITE_INTEGER;
}

std::int64_t RecordingDatabase::Statement::Integer(int column) const {
  return sqlite3_column_int64(this->Statement_.get(), column);
}

double RecordingDatabase::Statement::Real(int column) const {
  return sqlite3_column_double(this->Statement_.get(), column);
}

std::string RecordingDatabase::Statement::Bytes(int column) const {
  const void* data = sqlite3_column_blob(this->Statement_.get(), column);
  const int size = sqlite3_column_bytes(this->Statement_.get(), column);
  return data ? std::string(static_cast<const char*>(data), std::size_t(size)) : std::string();
}

RecordingDatabase::Statement& RecordingDatabase::Statement::Bind(int parameter,
                                                                 std::int64_t value) {
  sqlite3_bind_int64(this->Statement_.get(), parameter, value);
  return *this;
}

RecordingDatabase::View::View(const RecordingDatabase& database)
    : Database_(database), Own_(sqlite3_get_autocommit(database.Handle()) != 0) {
  if (this->Own_) {
    Statement(database, "BEGIN").Step();
  }
}

RecordingDatabase::View::~View() {
  if (this->Own_) {
    sqlite3_exec(this->Database_.Handle(), "END", nullptr, nullptr, nullptr);
  }
}

} // namespace dspace::session
