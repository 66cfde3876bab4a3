#include <dspace/recording/RecordingFile.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include <sqlite3.h>

#include <dspace/Error.h>
#include <dspace/recording/NewRecording.h>
#include <dspace/recording/RecordingDatabase.h>
#include <dspace/recording/RecordingSchema.h>
#include <dspace/recording/RecordingWriter.h>

namespace dspace::session {
namespace {

constexpr std::size_t ChecksumBytes = 16;
constexpr int CheckpointPages = 2048; // of the log, of a recording that is made from another one
constexpr std::size_t CommitBytes = 64u << 20;
constexpr const char* Accepted =
    "; accepted: a file in a folder that may be written and has room, that no process has locked";

template<class Number> void Add(Sha256& sum, Number value) {
  sum.Add(&value, sizeof value); // little-endian, as are the machines that Dspace runs on
}

} // namespace

std::string RecordingChecksum(Sha256& sum, const RecordingRow& row) {
  std::array<char, 29> head;
  head[0] = row.snapshot ? 'S' : 'C';
  std::memcpy(head.data() + 1, &row.seq, 8);
  std::memcpy(head.data() + 9, &row.time_s, 8);
  std::memcpy(head.data() + 17, &row.wall_s, 8);
  std::memcpy(head.data() + 25, &row.kind, 4);
  sum.Add(head.data(), head.size());
  sum.Add(row.payload.data(), row.payload.size());
  return sum.Finish().substr(0, ChecksumBytes);
}

std::string RecordingChecksum(const RecordingRow& row) {
  Sha256 sum;
  return RecordingChecksum(sum, row);
}

std::string RecordingChecksum(const RecordingAsset& asset) {
  Sha256 sum;
  sum.Add("A", 1);
  Add(sum, asset.id);
  Add(sum, asset.size);
  Add(sum, char(asset.packed));
  for (const std::string* text : {&asset.state, &asset.path, &asset.sha256}) {
    Add(sum, std::uint64_t(text->size()));
  }
  for (const std::string* text : {&asset.state, &asset.path, &asset.sha256}) {
    sum.Add(text->data(), text->size());
  }
  return sum.Finish().substr(0, ChecksumBytes);
}

std::string RecordingChecksum(const RecordingContent& content) {
  Sha256 sum;
  sum.Add("P", 1);
  for (const std::int64_t number : {content.id, content.asset, content.place, content.size}) {
    Add(sum, number);
  }
  sum.Add(content.data.data(), content.data.size());
  return sum.Finish().substr(0, ChecksumBytes);
}

std::uint64_t UnpackedBytes(const std::vector<RecordingAsset>& assets) {
  std::uint64_t bytes = 0;
  for (const RecordingAsset& asset : assets) {
    if (asset.packed) {
      const auto size = std::uint64_t(std::max<std::int64_t>(asset.size, 0));
      bytes += std::min(size, std::numeric_limits<std::uint64_t>::max() - bytes);
    }
  }
  return bytes;
}

std::string Hexadecimal(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

RecordingFile::RecordingFile(const std::string& path, std::int64_t maximumPages,
                             int checkpointPages)
    : Path_(path), Name_(RecordingName(path)) {
  if (std::ifstream(path).good()) {
    throw Error(Error::Kind::AlreadyExists, this->Name_,
                "there is a file of this name; accepted: a new one");
  }
  this->Open(SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
  try {
    this->Make(maximumPages, checkpointPages, false);
  } catch (...) { // on a full disk, say: nothing of it is left
    this->Close();
    for (const char* end : {"", "-wal", "-shm", "-journal"}) {
      std::error_code ignored;
      std::filesystem::remove(path + end, ignored);
    }
    throw;
  }
}

RecordingFile::RecordingFile(const NewRecording& made) : Path_(made.Path()), Name_(made.Name()) {
  this->Open(SQLITE_OPEN_READWRITE);
  try {
    this->Make(0, CheckpointPages, true);
  } catch (...) {
    this->Close();
    throw;
  }
}

RecordingFile::RecordingFile(const std::string& path, const std::string& name, Existing)
    : Path_(path), Name_(name) {
  this->Open(SQLITE_OPEN_READWRITE);
  try {
    DefendDatabase(this->Database_);
    sqlite3_busy_timeout(this->Database_, 1000);
    this->Run("PRAGMA locking_mode=EXCLUSIVE"); // a writer would number its own rows alike
    if (sqlite3_exec(this->Database_, "BEGIN IMMEDIATE; COMMIT", nullptr, nullptr, nullptr) !=
        SQLITE_OK) {
      throw Error(Error::Kind::Io, this->Name_,
                  std::string("it is in use: ") + sqlite3_errmsg(this->Database_) +
                      "; accepted: a recording that may be written and that no process is writing "
                      "or reading, or a new file for a copy");
    }
    this->PrepareAll(false);
  } catch (...) {
    this->Close();
    throw;
  }
}

void RecordingFile::Open(int flags) {
  if (sqlite3_open_v2(this->Path_.c_str(), &this->Database_, flags, nullptr) != SQLITE_OK) {
    const std::string why = this->Database_ ? sqlite3_errmsg(this->Database_) : "out of memory";
    this->Close();
    throw Error(Error::Kind::Io, this->Name_, why + Accepted);
  }
}

void RecordingFile::Make(std::int64_t maximumPages, int checkpointPages, bool repeated) {
  sqlite3_busy_timeout(this->Database_, 10000); // a reader that checkpoints
  this->Run("PRAGMA page_size=65536");          // a step of a thousand poses in few pages
  // A process that is killed during the change to WAL leaves no journal, which readers could not
  // roll back.
  this->Run("PRAGMA journal_mode=MEMORY");
  this->Run("PRAGMA journal_mode=WAL");
  this->Run("PRAGMA synchronous=NORMAL");
  this->Run("PRAGMA cache_size=-16384");    // KiB: a transaction is written once, at its end
  this->Run("PRAGMA wal_autocheckpoint=0"); // RecordingCheckpoints does it
  if (maximumPages > 0) {
    this->Run(("PRAGMA max_page_count=" + std::to_string(maximumPages)).c_str());
  }
  this->Begin();
  this->Run(RecordingSchema);
  this->Run(("INSERT INTO meta VALUES('format', " + std::to_string(RecordingFormat) + ")").c_str());
  this->Commit();
  this->PrepareAll(repeated);
  sqlite3_wal_hook(
      this->Database_,
      [](void* self, sqlite3*, const char*, int pages) {
        static_cast<RecordingFile*>(self)->PagesInLog_ = pages;
        return SQLITE_OK;
      },
      this);
  this->Checkpoints_ = std::make_unique<RecordingCheckpoints>(this->Path_, checkpointPages);
}

void RecordingFile::PrepareAll(bool repeated) {
  const std::string insert = repeated ? "INSERT OR IGNORE INTO " : "INSERT INTO ";
  this->Command_ = this->Prepare((insert + "command VALUES(?,?,?,?,?,?)").c_str());
  this->Snapshot_ = this->Prepare((insert + "snapshot VALUES(?,?,?,?,?,?)").c_str());
  this->Content_ = this->Prepare((insert + "content VALUES(?,?,?,?,?,?)").c_str());
  // Packing changes a row that is there; its page from before may be found, too.
  const std::string newer =
      repeated ? " ON CONFLICT(id) DO UPDATE SET path = excluded.path, state = excluded.state, "
                 "size = excluded.size, sha256 = excluded.sha256, packed = excluded.packed, "
                 "checksum = excluded.checksum WHERE excluded.packed"
               : "";
  this->Asset_ = this->Prepare(("INSERT INTO asset VALUES(?,?,?,?,?,?,?)" + newer).c_str());
  this->NewAsset_ = this->Prepare("INSERT OR REPLACE INTO asset VALUES(?,?,?,?,?,?,?)");
  this->Meta_ = this->Prepare("INSERT OR REPLACE INTO meta VALUES(?,?)");
}

RecordingFile::~RecordingFile() {
  this->Close();
}

void RecordingFile::FinalizeAll() noexcept {
  for (sqlite3_stmt** statement : {&this->Command_, &this->Snapshot_, &this->Asset_,
                                   &this->NewAsset_, &this->Content_, &this->Meta_}) {
    sqlite3_finalize(*statement);
    *statement = nullptr;
  }
}

void RecordingFile::Finish() {
  this->Checkpoints_.reset(); // which may be at work on the log
  this->FinalizeAll();
  sqlite3_busy_timeout(this->Database_, 2000);
  int inLog = 0, moved = 0;
  if (sqlite3_wal_checkpoint_v2(this->Database_, nullptr, SQLITE_CHECKPOINT_TRUNCATE, &inLog,
                                &moved) != SQLITE_OK ||
      inLog > moved) {
    this->Fail("it cannot be written");
  }
}

void RecordingFile::Close() noexcept {
  this->Checkpoints_.reset();
  this->FinalizeAll();
  if (this->Database_) {
    // Moves the log into the file even if another process has it open, as far as no read is in
    // progress. Otherwise the last process that closes the file would need write access.
    sqlite3_busy_timeout(this->Database_, 2000);
    sqlite3_wal_checkpoint_v2(this->Database_, nullptr, SQLITE_CHECKPOINT_TRUNCATE, nullptr,
                              nullptr);
    // If no other process has the file open, it needs no log, and can be read from read-only media.
    sqlite3_busy_timeout(this->Database_, 0);
    sqlite3_exec(this->Database_, "PRAGMA journal_mode=DELETE", nullptr, nullptr, nullptr);
  }
  sqlite3_close(this->Database_);
}

void RecordingFile::Fail(const char* what) {
  throw Error(Error::Kind::Io, this->Name_,
              std::string(what) + ": " + sqlite3_errmsg(this->Database_) + Accepted);
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
  if (this->Checkpoints_) {
    this->Checkpoints_->After(this->Database_, this->PagesInLog_);
  }
}

void RecordingFile::CommitEach(std::size_t bytes) {
  this->Uncommitted_ += bytes;
  if (this->Uncommitted_ >= CommitBytes) {
    this->Uncommitted_ = 0;
    this->Commit();
    this->Begin();
  }
}

void RecordingFile::Rollback() noexcept {
  sqlite3_exec(this->Database_, "ROLLBACK", nullptr, nullptr, nullptr);
}

void RecordingFile::Put(const RecordingRow& row, const std::string& checksum) {
  sqlite3_stmt* statement = row.snapshot ? this->Snapshot_ : this->Command_;
  sqlite3_bind_int64(statement, 1, sqlite3_int64(row.seq));
  sqlite3_bind_double(statement, 2, row.time_s);
  sqlite3_bind_double(statement, 3, row.wall_s);
  sqlite3_bind_int(statement, 4, row.kind);
  sqlite3_bind_blob64(statement, 5, row.payload.data(), row.payload.size(), SQLITE_STATIC);
  sqlite3_bind_blob64(statement, 6, checksum.data(), checksum.size(), SQLITE_STATIC);
  this->Step(statement);
}

void RecordingFile::PutLost(const std::string& ranges) {
  sqlite3_bind_text(this->Meta_, 1, "lost", -1, SQLITE_STATIC);
  sqlite3_bind_text(this->Meta_, 2, ranges.data(), int(ranges.size()), SQLITE_STATIC);
  this->Step(this->Meta_);
}

void RecordingFile::PutBegin(std::uint64_t seq) {
  sqlite3_bind_text(this->Meta_, 1, "begin", -1, SQLITE_STATIC);
  sqlite3_bind_int64(this->Meta_, 2, sqlite3_int64(seq));
  this->Step(this->Meta_);
}

void RecordingFile::Put(const RecordingAsset& asset) {
  this->Put(this->Asset_, asset);
}

void RecordingFile::Replace(const RecordingAsset& asset) {
  this->Put(this->NewAsset_, asset);
}

void RecordingFile::Put(sqlite3_stmt* statement, const RecordingAsset& asset) {
  const std::string checksum = RecordingChecksum(asset);
  sqlite3_bind_int64(statement, 1, asset.id);
  sqlite3_bind_text(statement, 2, asset.path.data(), int(asset.path.size()), SQLITE_STATIC);
  sqlite3_bind_text(statement, 3, asset.state.data(), int(asset.state.size()), SQLITE_STATIC);
  sqlite3_bind_int64(statement, 4, asset.size);
  sqlite3_bind_blob64(statement, 5, asset.sha256.data(), asset.sha256.size(), SQLITE_STATIC);
  sqlite3_bind_int(statement, 6, asset.packed ? 1 : 0);
  sqlite3_bind_blob64(statement, 7, checksum.data(), checksum.size(), SQLITE_STATIC);
  this->Step(statement);
}

void RecordingFile::RemoveContent(std::int64_t asset) {
  this->Run(("DELETE FROM content WHERE asset = " + std::to_string(asset)).c_str());
}

std::int64_t RecordingFile::LastContent() {
  const std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> found(
      this->Prepare("SELECT max(id) FROM content"), sqlite3_finalize);
  if (sqlite3_step(found.get()) != SQLITE_ROW) {
    this->Fail("it cannot be read");
  }
  return sqlite3_column_int64(found.get(), 0); // 0 for none
}

void RecordingFile::Put(const RecordingContent& content) {
  const std::string checksum = RecordingChecksum(content);
  sqlite3_stmt* statement = this->Content_;
  sqlite3_bind_int64(statement, 1, content.id);
  sqlite3_bind_int64(statement, 2, content.asset);
  sqlite3_bind_int64(statement, 3, content.place);
  sqlite3_bind_int64(statement, 4, content.size);
  sqlite3_bind_blob64(statement, 5, content.data.data(), content.data.size(), SQLITE_STATIC);
  sqlite3_bind_blob64(statement, 6, checksum.data(), checksum.size(), SQLITE_STATIC);
  this->Step(statement);
}

} // namespace dspace::session
