#include <dspace/recording/RecordingReader.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <fcntl.h>
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/util/delimited_message_util.h>
#include <sqlite3.h>
#include <unistd.h>
#include <zlib.h>

#include <dspace/Error.h>
#include <dspace/recording/RecordingFile.h>
#include <dspace/recording/RecordingWriter.h>

namespace dspace::session {
namespace {

constexpr int BusyMilliseconds = 10000; // a writer that checkpoints

// SQLite takes the name as a URI, since only then it opens nothing for writing. It would make files
// beside one that was not closed well; where it cannot, and nothing is in its log, it is told that
// nobody writes.
std::string UriOf(const std::string& path) {
  std::string uri = "file:";
  for (const char c : path) {
    uri += c == '%' ? "%25" : c == '?' ? "%3f" : c == '#' ? "%23" : std::string(1, c);
  }
  std::error_code none;
  const auto log = std::filesystem::file_size(path + "-wal", none);
  const bool finished = none || log == 0;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return uri + (finished && faccessat(AT_FDCWD, folder.c_str(), W_OK, AT_EACCESS) != 0
                    ? "?immutable=1"
                    : "?mode=ro");
}

// A part as it was, of `size` bytes; of other size where it is not that.
std::string Decompress(const std::string& data, std::int64_t size) {
  std::string out(std::size_t(size), '\0');
  uLongf got = out.size(); // no more, whatever it would grow to
  if (uncompress(reinterpret_cast<Bytef*>(out.data()), &got,
                 reinterpret_cast<const Bytef*>(data.data()), data.size()) != Z_OK) {
    got = 0;
  }
  out.resize(got);
  return out;
}

} // namespace

struct RecordingReader::Impl {
  std::string path;
  sqlite3* database = nullptr;
  Sha256 sum;

  [[noreturn]] void Fail(const std::string& what) const {
    throw Error(Error::Kind::Corrupt, "recording '" + this->path + "'",
                what + "; `dspace log salvage` brings back what survives");
  }

  // A statement that ends with its scope.
  using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;
  Statement Ask(const char* sql) const {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(this->database, sql, -1, &statement, nullptr) != SQLITE_OK) {
      this->Fail(sqlite3_errmsg(this->database));
    }
    return {statement, sqlite3_finalize};
  }

  bool Step(const Statement& statement) const {
    const int result = sqlite3_step(statement.get());
    if (result != SQLITE_ROW && result != SQLITE_DONE) {
      this->Fail(sqlite3_errmsg(this->database));
    }
    return result == SQLITE_ROW;
  }

  std::uint64_t Number(const char* sql, std::uint64_t otherwise) const {
    const Statement found = this->Ask(sql);
    return this->Step(found) && sqlite3_column_type(found.get(), 0) != SQLITE_NULL
               ? std::uint64_t(sqlite3_column_int64(found.get(), 0))
               : otherwise;
  }

  static std::string Blob(const Statement& row, int column) {
    const void* data = sqlite3_column_blob(row.get(), column);
    const int size = sqlite3_column_bytes(row.get(), column);
    return data ? std::string(static_cast<const char*>(data), std::size_t(size)) : std::string();
  }

  // Columns seq, time, wall, kind, payload, checksum.
  RecordingRow Row(const Statement& from, bool snapshot) {
    RecordingRow row;
    row.snapshot = snapshot;
    row.seq = std::uint64_t(sqlite3_column_int64(from.get(), 0));
    row.time_s = sqlite3_column_double(from.get(), 1);
    row.wall_s = sqlite3_column_double(from.get(), 2);
    row.kind = std::int32_t(sqlite3_column_int64(from.get(), 3));
    row.payload = Blob(from, 4);
    if (Blob(from, 5) != RecordingChecksum(this->sum, row)) {
      this->Fail((snapshot ? "snapshot " : "command ") + std::to_string(row.seq) + " is damaged");
    }
    return row;
  }

  [[noreturn]] void Missing(std::uint64_t first, std::uint64_t last) const {
    this->Fail("commands " + std::to_string(first) + " to " + std::to_string(last) +
               " are missing");
  }
};

RecordingReader::RecordingReader(const std::string& path) : Impl_(std::make_unique<Impl>()) {
  Impl& impl = *this->Impl_;
  impl.path = std::filesystem::absolute(path).string();
  const std::string object = "recording '" + impl.path + "'";
  std::error_code error;
  if (!std::filesystem::is_regular_file(impl.path, error)) {
    throw Error(Error::Kind::NotFound, object, "there is no such file");
  }
  if (sqlite3_open_v2(UriOf(impl.path).c_str(), &impl.database,
                      SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr) != SQLITE_OK) {
    const std::string why = impl.database ? sqlite3_errmsg(impl.database) : "out of memory";
    sqlite3_close(impl.database);
    throw Error(Error::Kind::Io, object, why);
  }
  try {
    sqlite3_busy_timeout(impl.database, BusyMilliseconds);
    // Tables only: a view could be made to go on without end.
    sqlite3_db_config(impl.database, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    const std::uint64_t format = impl.Number("SELECT value FROM meta WHERE key = 'format'", 0);
    if (format != RecordingFormat) {
      throw Error(Error::Kind::Unsupported, object,
                  "its format is " + std::to_string(format) +
                      (format > RecordingFormat ? ", a newer Dspace wrote it" : "") +
                      "; accepted: " + std::to_string(RecordingFormat));
    }
  } catch (...) {
    sqlite3_close(impl.database);
    throw;
  }
}

RecordingReader::~RecordingReader() {
  sqlite3_close(this->Impl_->database);
}

const std::string& RecordingReader::Path() const {
  return this->Impl_->path;
}

std::uint64_t RecordingReader::First() {
  return this->Impl_->Number("SELECT min(seq) FROM command", 1);
}

std::uint64_t RecordingReader::Last() {
  return this->Impl_->Number("SELECT max(seq) FROM command", 0);
}

void RecordingReader::Read(std::uint64_t first, std::uint64_t last,
                           const std::function<bool(RecordedCommand&&)>& take) {
  Impl& impl = *this->Impl_;
  const Impl::Statement rows =
      impl.Ask("SELECT seq, time, wall, kind, payload, checksum FROM command "
               "WHERE seq BETWEEN ? AND ? ORDER BY seq");
  sqlite3_bind_int64(rows.get(), 1, sqlite3_int64(first));
  sqlite3_bind_int64(rows.get(), 2, sqlite3_int64(last));
  std::uint64_t expected = first;
  while (impl.Step(rows)) {
    const RecordingRow row = impl.Row(rows, false);
    if (row.seq != expected) {
      impl.Missing(expected, row.seq - 1);
    }
    ++expected;
    RecordedCommand command{row.seq, row.time_s, row.wall_s, {}};
    if (!command.command.ParseFromString(row.payload)) {
      impl.Fail("command " + std::to_string(row.seq) + " is no Command message");
    }
    if (!take(std::move(command))) {
      return;
    }
  }
  if (expected <= last) {
    impl.Missing(expected, last);
  }
}

RecordedSnapshot RecordingReader::SnapshotAt(std::uint64_t seq) {
  Impl& impl = *this->Impl_;
  const Impl::Statement found =
      impl.Ask("SELECT seq, time, wall, kind, payload, checksum FROM snapshot "
               "WHERE seq <= ? ORDER BY seq DESC LIMIT 1");
  sqlite3_bind_int64(found.get(), 1, sqlite3_int64(seq));
  if (!impl.Step(found)) {
    impl.Fail("the state before command " + std::to_string(seq) + " is not there");
  }
  const RecordingRow row = impl.Row(found, true);
  RecordedSnapshot snapshot{row.seq, row.time_s, row.wall_s, {}};
  google::protobuf::io::ArrayInputStream bytes(row.payload.data(), int(row.payload.size()));
  google::protobuf::io::CodedInputStream in(&bytes);
  bool end = false;
  for (;;) {
    v1::Command command;
    if (!google::protobuf::util::ParseDelimitedFromCodedStream(&command, &in, &end)) {
      break;
    }
    snapshot.commands.push_back(std::move(command));
  }
  if (!end || snapshot.commands.size() != std::size_t(row.kind)) {
    impl.Fail("snapshot " + std::to_string(row.seq) + " is no list of commands");
  }
  return snapshot;
}

std::vector<std::uint64_t> RecordingReader::Snapshots() {
  const Impl::Statement found = this->Impl_->Ask("SELECT seq FROM snapshot ORDER BY seq");
  std::vector<std::uint64_t> seqs;
  while (this->Impl_->Step(found)) {
    seqs.push_back(std::uint64_t(sqlite3_column_int64(found.get(), 0)));
  }
  return seqs;
}

std::vector<std::pair<std::uint64_t, double>> RecordingReader::Steps() {
  const Impl::Statement found =
      this->Impl_->Ask("SELECT seq, time FROM command INDEXED BY step WHERE kind = 13");
  std::vector<std::pair<std::uint64_t, double>> steps;
  while (this->Impl_->Step(found)) {
    steps.emplace_back(std::uint64_t(sqlite3_column_int64(found.get(), 0)),
                       sqlite3_column_double(found.get(), 1));
  }
  std::sort(steps.begin(), steps.end());
  return steps;
}

std::vector<std::pair<std::uint64_t, std::uint64_t>> RecordingReader::Lost() {
  const Impl::Statement found = this->Impl_->Ask("SELECT value FROM meta WHERE key = 'lost'");
  std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;
  std::istringstream words(this->Impl_->Step(found) ? Impl::Blob(found, 0) : std::string());
  for (std::string word; words >> word;) {
    char* end = nullptr;
    const std::uint64_t first = std::strtoull(word.c_str(), &end, 10);
    const std::uint64_t last = *end == '-' ? std::strtoull(end + 1, &end, 10) : 0;
    if (first == 0 || last < first || *end != '\0') {
      this->Impl_->Fail("what it says of lost commands is damaged");
    }
    ranges.emplace_back(first, last);
  }
  return ranges;
}

std::vector<RecordingAsset> RecordingReader::Assets(std::int64_t after) {
  const Impl::Statement rows =
      this->Impl_->Ask("SELECT id, path, state, size, sha256, packed, checksum FROM asset "
                       "WHERE id > ? ORDER BY id");
  sqlite3_bind_int64(rows.get(), 1, after);
  std::map<std::string, RecordingAsset> found;
  while (this->Impl_->Step(rows)) {
    RecordingAsset asset;
    asset.id = sqlite3_column_int64(rows.get(), 0);
    asset.path = Impl::Blob(rows, 1);
    asset.state = Impl::Blob(rows, 2);
    asset.size = sqlite3_column_int64(rows.get(), 3);
    asset.sha256 = Impl::Blob(rows, 4);
    asset.packed = sqlite3_column_int64(rows.get(), 5) != 0;
    if (Impl::Blob(rows, 6) != RecordingChecksum(asset)) {
      this->Impl_->Fail("asset " + std::to_string(asset.id) + " is damaged");
    }
    found[asset.path] = std::move(asset);
  }
  std::vector<RecordingAsset> assets;
  for (auto& entry : found) {
    assets.push_back(std::move(entry.second));
  }
  return assets;
}

RecordingReader::PartNumbers RecordingReader::Parts() {
  const Impl::Statement rows = this->Impl_->Ask("SELECT asset, id FROM content ORDER BY place");
  PartNumbers numbers;
  while (this->Impl_->Step(rows)) {
    numbers[sqlite3_column_int64(rows.get(), 0)].push_back(sqlite3_column_int64(rows.get(), 1));
  }
  return numbers;
}

void RecordingReader::ReadContent(const RecordingAsset& asset,
                                  const std::vector<std::int64_t>& parts,
                                  const std::function<void(const std::string&)>& take) {
  const std::string named = "the content of '" + asset.path + "'";
  std::int64_t place = 0;
  for (const std::int64_t number : parts) {
    const Impl::Statement row =
        this->Impl_->Ask("SELECT id, asset, place, size, data, checksum FROM content WHERE id = ?");
    sqlite3_bind_int64(row.get(), 1, number);
    RecordingContent part;
    bool good = this->Impl_->Step(row);
    if (good) {
      part.id = sqlite3_column_int64(row.get(), 0);
      part.asset = sqlite3_column_int64(row.get(), 1);
      part.place = sqlite3_column_int64(row.get(), 2);
      part.size = sqlite3_column_int64(row.get(), 3);
      part.data = Impl::Blob(row, 4);
      good = Impl::Blob(row, 5) == RecordingChecksum(part) && part.asset == asset.id &&
             part.place == place && part.size > 0 && part.size <= RecordingPartBytes &&
             part.size <= asset.size - place; // no more is made than is said
    }
    if (good && std::int64_t(part.data.size()) != part.size) {
      part.data = Decompress(part.data, part.size);
      good = std::int64_t(part.data.size()) == part.size;
    }
    if (!good) {
      this->Impl_->Fail(named + " is damaged at byte " + std::to_string(place));
    }
    take(part.data);
    place += part.size;
  }
  if (place != asset.size) {
    this->Impl_->Fail(named + " ends at byte " + std::to_string(place) + " of " +
                      std::to_string(asset.size));
  }
}

} // namespace dspace::session
