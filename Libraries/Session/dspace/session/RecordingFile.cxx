#include <dspace/session/RecordingFile.h>

#include <array>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include <openssl/evp.h>
#include <sqlite3.h>

#include <dspace/Error.h>
#include <dspace/session/RecordingWriter.h>

namespace dspace::session {
namespace {

constexpr std::size_t ChecksumBytes = 16;
constexpr const char* Schema = R"(
CREATE TABLE meta(key TEXT PRIMARY KEY, value) WITHOUT ROWID;
CREATE TABLE command(seq INTEGER PRIMARY KEY, time REAL NOT NULL, wall REAL NOT NULL,
  kind INTEGER NOT NULL, payload BLOB NOT NULL, checksum BLOB NOT NULL);
CREATE TABLE snapshot(seq INTEGER PRIMARY KEY, time REAL NOT NULL, wall REAL NOT NULL,
  kind INTEGER NOT NULL, payload BLOB NOT NULL, checksum BLOB NOT NULL);
-- The steps of the simulation: SetTime is command 13.
CREATE INDEX step ON command(time) WHERE kind = 13;
CREATE TABLE asset(path TEXT PRIMARY KEY, sha256 BLOB, size INTEGER, content BLOB);
)";

class Sha256 {
public:
  Sha256() : Context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    if (!this->Context_ || EVP_DigestInit_ex(this->Context_.get(), EVP_sha256(), nullptr) != 1) {
      throw Error(Error::Kind::Internal, "recording", "SHA-256 is not available");
    }
  }
  void Add(const void* data, std::size_t size) {
    EVP_DigestUpdate(this->Context_.get(), data, size);
  }
  std::string Finish() {
    std::string digest(32, '\0');
    EVP_DigestFinal_ex(this->Context_.get(), reinterpret_cast<unsigned char*>(digest.data()),
                       nullptr);
    return digest;
  }

private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> Context_;
};

} // namespace

std::string RecordingChecksum(const RecordingRow& row) {
  std::array<char, 29> head; // little-endian, as are the machines that Dspace runs on
  head[0] = row.snapshot ? 'S' : 'C';
  std::memcpy(head.data() + 1, &row.seq, 8);
  std::memcpy(head.data() + 9, &row.time_s, 8);
  std::memcpy(head.data() + 17, &row.wall_s, 8);
  std::memcpy(head.data() + 25, &row.kind, 4);
  Sha256 sum;
  sum.Add(head.data(), head.size());
  sum.Add(row.payload.data(), row.payload.size());
  return sum.Finish().substr(0, ChecksumBytes);
}

RecordingFile::RecordingFile(const std::string& path, std::int64_t maximumPages) : Path_(path) {
  if (std::ifstream(path).good()) {
    throw Error(Error::Kind::AlreadyExists, "recording '" + path + "'",
                "there is a file of this name; accepted: a new one");
  }
  if (sqlite3_open_v2(path.c_str(), &this->Database_, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE,
                      nullptr) != SQLITE_OK) {
    const std::string why = this->Database_ ? sqlite3_errmsg(this->Database_) : "out of memory";
    this->Close();
    throw Error(Error::Kind::Io, "recording '" + path + "'", why);
  }
  try {
    sqlite3_busy_timeout(this->Database_, 10000); // a reader that checkpoints
    this->Run("PRAGMA page_size=65536");          // a step of a thousand poses in few pages
    this->Run("PRAGMA journal_mode=WAL");
    this->Run("PRAGMA synchronous=NORMAL");
    this->Run("PRAGMA wal_autocheckpoint=2048"); // 128 MiB: the disk is waited for seldom
    if (maximumPages > 0) {
      this->Run(("PRAGMA max_page_count=" + std::to_string(maximumPages)).c_str());
    }
    this->Begin();
    this->Run(Schema);
    this->Run(
        ("INSERT INTO meta VALUES('format', " + std::to_string(RecordingFormat) + ")").c_str());
    this->Commit();
    this->Command_ = this->Prepare("INSERT INTO command VALUES(?,?,?,?,?,?)");
    this->Snapshot_ = this->Prepare("INSERT INTO snapshot VALUES(?,?,?,?,?,?)");
    this->Asset_ = this->Prepare("INSERT OR IGNORE INTO asset VALUES(?,?,?,NULL)");
  } catch (...) {
    this->Close();
    throw;
  }
}

RecordingFile::~RecordingFile() {
  this->Close();
}

void RecordingFile::Close() noexcept {
  for (sqlite3_stmt* statement : {this->Command_, this->Snapshot_, this->Asset_}) {
    sqlite3_finalize(statement);
  }
  sqlite3_close(this->Database_);
}

void RecordingFile::Fail(const char* what) {
  throw Error(Error::Kind::Io, "recording '" + this->Path_ + "'",
              std::string(what) + ": " + sqlite3_errmsg(this->Database_));
}

void RecordingFile::Run(const char* sql) {
  if (sqlite3_exec(this->Database_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) {
    this->Fail("it cannot be written");
  }
}

sqlite3_stmt* RecordingFile::Prepare(const char* sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(this->Database_, sql, -1, &statement, nullptr) != SQLITE_OK) {
    this->Fail("it cannot be written");
  }
  return statement;
}

void RecordingFile::Step(sqlite3_stmt* statement) {
  const int result = sqlite3_step(statement);
  sqlite3_reset(statement);
  if (result != SQLITE_DONE) {
    this->Fail("it cannot be written");
  }
}

void RecordingFile::Begin() {
  this->Run("BEGIN IMMEDIATE");
}

void RecordingFile::Commit() {
  this->Run("COMMIT");
}

void RecordingFile::Rollback() noexcept {
  sqlite3_exec(this->Database_, "ROLLBACK", nullptr, nullptr, nullptr);
}

void RecordingFile::Put(const RecordingRow& row) {
  sqlite3_stmt* statement = row.snapshot ? this->Snapshot_ : this->Command_;
  const std::string checksum = RecordingChecksum(row);
  sqlite3_bind_int64(statement, 1, sqlite3_int64(row.seq));
  sqlite3_bind_double(statement, 2, row.time_s);
  sqlite3_bind_double(statement, 3, row.wall_s);
  sqlite3_bind_int(statement, 4, row.kind);
  sqlite3_bind_blob64(statement, 5, row.payload.data(), row.payload.size(), SQLITE_STATIC);
  sqlite3_bind_blob64(statement, 6, checksum.data(), checksum.size(), SQLITE_STATIC);
  this->Step(statement);
}

void RecordingFile::PutAsset(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> block(1u << 20);
  Sha256 sum;
  std::int64_t size = 0;
  while (file.read(block.data(), std::streamsize(block.size())), file.gcount() > 0) {
    sum.Add(block.data(), std::size_t(file.gcount()));
    size += file.gcount();
  }
  const bool read = file.eof() && !file.bad();
  const std::string digest = sum.Finish();
  sqlite3_bind_text(this->Asset_, 1, path.data(), int(path.size()), SQLITE_STATIC);
  if (read) {
    sqlite3_bind_blob64(this->Asset_, 2, digest.data(), digest.size(), SQLITE_STATIC);
    sqlite3_bind_int64(this->Asset_, 3, size);
  } else {
    sqlite3_bind_null(this->Asset_, 2);
    sqlite3_bind_null(this->Asset_, 3);
  }
  this->Step(this->Asset_);
}

} // namespace dspace::session
