#include <dspace/recording/RecordingReader.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <zlib.h>

#include <dspace/Error.h>
#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/MessageElements.h>
#include <dspace/messages/WireText.h>
#include <dspace/recording/RecordingDatabase.h>
#include <dspace/recording/RecordingFile.h>
#include <dspace/recording/RecordingSchema.h>
#include <dspace/recording/RecordingWriter.h>

namespace dspace::session {
namespace {

using Statement = RecordingDatabase::Statement;

constexpr char Magic[] = "SQLite format 3"; // with its zero byte what SQLite's files begin with
constexpr int SetTime = v1::Command::kSetTime;
constexpr const char* Begun =
    ", as a process leaves it that is killed in the first moments of its recording";

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

// Columns seq, time, wall, kind, payload, checksum.
RecordingRow RowOf(const RecordingDatabase& database, const Statement& from, bool snapshot,
                   Sha256& sum) {
  RecordingRow row;
  row.snapshot = snapshot;
  row.seq = std::uint64_t(from.Integer(0));
  row.time_s = from.Real(1);
  row.wall_s = from.Real(2);
  const std::int64_t kind = from.Integer(3);
  row.kind = std::int32_t(kind);
  row.payload = from.Bytes(4);
  if (row.kind != kind || from.Bytes(5) != RecordingChecksum(sum, row)) {
    database.Damaged((snapshot ? "snapshot " : "command ") + std::to_string(row.seq) +
                     " is damaged");
  }
  return row;
}

// Columns id, asset, place, size, data.
RecordingContent PartOf(const Statement& row) {
  RecordingContent part;
  part.id = row.Integer(0);
  part.asset = row.Integer(1);
  part.place = row.Integer(2);
  part.size = row.Integer(3);
  part.data = row.Bytes(4);
  return part;
}

// protobuf parses no text of another encoding, and writes to the error stream where it finds some.
bool ParseCommand(const std::string& payload, v1::Command& command, bool& foreign) {
  const std::optional<std::string> readable = WithTextUtf8(payload, *v1::Command::descriptor());
  foreign = readable.has_value();
  return command.ParseFromString(readable ? *readable : payload);
}

// Throws Error(Resource) before a message is parsed that would be far larger than its bytes.
void RequireElements(const RecordingDatabase& database, const std::string& bytes,
                     const std::string& what) {
  const std::string why = TooManyElements(bytes, *v1::Command::descriptor());
  if (!why.empty()) {
    throw Error(Error::Kind::Resource, "recording '" + database.Path() + "'", what + ": " + why);
  }
}

[[noreturn]] void Missing(const RecordingDatabase& database, std::uint64_t first,
                          std::uint64_t last) {
  database.Damaged("commands " + std::to_string(first) + " to " + std::to_string(last) +
                   " are missing");
}

// A row's number as SQLite compares it.
std::int64_t Bound(std::uint64_t seq) {
  return std::int64_t(std::min<std::uint64_t>(seq, std::numeric_limits<std::int64_t>::max()));
}

[[noreturn]] void NotARecording(const std::string& path, const std::string& why) {
  throw Error(Error::Kind::Unsupported, RecordingName(path),
              "it is not a recording: " + why +
                  "; accepted: a .dspace file (`dspace log salvage` recovers what survives of a "
                  "damaged one)");
}

// A file's first bytes, those that are not printable as "\x.." .
std::string FirstBytes(const std::string& path) {
  // SQLite must not have taken the file for one of its own: closing it here would release this
  // process's locks on it.
  std::ifstream file(path, std::ios::binary);
  std::string begin(sizeof Magic, '\0');
  file.read(begin.data(), std::streamsize(begin.size()));
  begin.resize(std::size_t(file.gcount()));
  return begin;
}

std::string Printable(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      text += c;
    } else {
      text += std::string("\\x") + "0123456789abcdef"[byte >> 4] + "0123456789abcdef"[byte & 15];
    }
  }
  return text;
}

} // namespace

void ForeignRows::Look(const RecordingRow& row) {
  const auto& type = *v1::Command::descriptor();
  if (row.snapshot ? WithTextUtf8OfAll(row.payload, type) : WithTextUtf8(row.payload, type)) {
    this->rows.emplace(row.seq, row.snapshot);
  }
}

std::vector<std::string> ForeignRows::Names() const {
  constexpr std::size_t Most = 10;
  std::vector<std::string> names;
  for (const auto& [seq, snapshot] : this->rows) {
    if (names.size() < Most) {
      names.push_back((snapshot ? "snapshot " : "command ") + std::to_string(seq));
    }
  }
  return names;
}

RecordingReader::RecordingReader(const std::string& path) {
  const std::string whole = std::filesystem::absolute(path).string();
  std::error_code error;
  if (!std::filesystem::is_regular_file(whole, error)) {
    throw Error(Error::Kind::NotFound, RecordingName(whole),
                "there is no such file; accepted: a recording, a .dspace file");
  }
  if (std::filesystem::file_size(whole, error) == 0) {
    NotARecording(whole, std::string("it is empty") + Begun);
  }
  this->Database_ = std::make_unique<RecordingDatabase>(whole);
  this->RequireFormat();
}

RecordingReader::~RecordingReader() = default;

void RecordingReader::RequireFormat() {
  const RecordingDatabase& database = *this->Database_;
  bool ours = false;
  try {
    ours = database.Number("SELECT count(*) FROM sqlite_master WHERE name IN ('meta', 'command')",
                           0) > 0;
  } catch (const Error& failure) {
    if (failure.GetKind() != Error::Kind::Corrupt) {
      throw;
    }
    const std::string begin = database.IsNoDatabase() ? FirstBytes(database.Path()) : "";
    if (!begin.empty() && begin != std::string(Magic, sizeof Magic)) {
      NotARecording(database.Path(), "its first bytes are '" + Printable(begin) + "'");
    }
    throw;
  }
  if (!ours) {
    NotARecording(database.Path(),
                  std::string("it is an SQLite file without a recording's tables") + Begun);
  }
  RequireSchema(database, "meta");
  Statement found(database, "SELECT value FROM meta WHERE key = 'format'");
  const bool any = found.Step();
  const bool number = any && found.IsInteger(0);
  if (!number || found.Integer(0) != RecordingFormat) {
    throw Error(
        Error::Kind::Unsupported, RecordingName(database.Path()),
        "its format is " +
            (number ? std::to_string(found.Integer(0))
             : any  ? "'" + Printable(found.Bytes(0)) + "'"
                    : std::string("not stated")) +
            (number && found.Integer(0) > RecordingFormat ? ", a newer Dspace wrote it" : "") +
            "; accepted: " + std::to_string(RecordingFormat));
  }
  RequireSchema(database);
}

bool RecordingReader::IsNewer(const std::string& path) {
  try {
    const RecordingDatabase database(path);
    Statement found(database, "SELECT value FROM meta WHERE key = 'format'");
    return found.Step() && found.IsInteger(0) && found.Integer(0) > RecordingFormat;
  } catch (const Error&) { // damaged, or no recording
    return false;
  }
}

const std::string& RecordingReader::Path() const {
  return this->Database_->Path();
}

void RecordingReader::SetTimeout(double seconds) {
  this->Database_->SetTimeout(seconds);
}

void RecordingReader::RequireUnpackable(std::uint64_t bytes) const {
  constexpr std::uint64_t Any = std::uint64_t(1) << 30;
  constexpr std::uint64_t AByte = 20; // zlib's makes of blank rasters up to a thousand
  std::uint64_t most = this->UnpackLimit_;
  if (most == 0) {
    std::error_code none;
    const auto size = std::filesystem::file_size(this->Path(), none);
    most = Any + (none ? 0 : AByte * size);
  }
  if (bytes > most) {
    throw Error(Error::Kind::Resource, RecordingName(this->Path()),
                "its packed content has " + std::to_string(bytes) +
                    " bytes unpacked; accepted: up to " + std::to_string(most) +
                    ", the unpack limit" +
                    (this->UnpackLimit_ == 0 ? " (1 GiB and 20 times the recording's size)" : "") +
                    ", which unpack_limit in Python and --unpack-limit of the commands set");
  }
}

std::uint64_t RecordingReader::First() {
  return std::uint64_t(this->Database_->Number("SELECT min(seq) FROM command", 1));
}

std::uint64_t RecordingReader::Last() {
  return std::uint64_t(this->Database_->Number("SELECT max(seq) FROM command", 0));
}

std::uint64_t RecordingReader::Begin() {
  Statement found(*this->Database_, "SELECT value FROM meta WHERE key = 'begin'");
  if (!found.Step()) {
    return 0;
  }
  if (!found.IsInteger(0) || found.Integer(0) < 0) {
    this->Database_->Damaged("the number of the snapshot that it begins with is damaged");
  }
  return std::uint64_t(found.Integer(0));
}

void RecordingReader::ReadRows(std::uint64_t first, std::uint64_t last,
                               const std::function<bool(RecordingRow&&)>& take) {
  Statement rows(*this->Database_, "SELECT seq, time, wall, kind, payload, checksum FROM command "
                                   "WHERE seq BETWEEN ? AND ? ORDER BY seq");
  rows.Bind(1, Bound(first)).Bind(2, Bound(last));
  Sha256 sum;
  std::uint64_t expected = first;
  while (rows.Step()) {
    RecordingRow row = RowOf(*this->Database_, rows, false, sum);
    if (row.seq != expected) {
      Missing(*this->Database_, expected, row.seq - 1);
    }
    ++expected;
    if (!take(std::move(row))) {
      return;
    }
  }
  if (expected <= last) {
    Missing(*this->Database_, expected, last);
  }
}

void RecordingReader::Read(std::uint64_t first, std::uint64_t last,
                           const std::function<bool(RecordedCommand&&)>& take) {
  this->ReadRows(first, last, [&](RecordingRow&& row) {
    RecordedCommand command{row.seq, row.time_s, row.wall_s, {}, false};
    RequireElements(*this->Database_, row.payload, "command " + std::to_string(row.seq));
    if (!ParseCommand(row.payload, command.command, command.foreignText)) {
      this->Database_->Damaged("command " + std::to_string(row.seq) + " is not a Command message");
    }
    return take(std::move(command));
  });
}

void RecordingReader::ReadOnly(const std::vector<int>& kinds, std::uint64_t first,
                               std::uint64_t last,
                               const std::function<bool(RecordingRow&&)>& take) {
  std::string sql = "SELECT seq, time, wall, kind, payload, checksum FROM command "
                    "WHERE seq BETWEEN ? AND ? AND kind IN (";
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    sql += (i ? "," : "") + std::to_string(kinds[i]);
  }
  Statement rows(*this->Database_, (sql + ") ORDER BY seq").c_str());
  rows.Bind(1, Bound(first)).Bind(2, Bound(last));
  Sha256 sum;
  while (rows.Step()) {
    if (!take(RowOf(*this->Database_, rows, false, sum))) {
      return;
    }
  }
}

RecordingRow RecordingReader::SnapshotRow(std::uint64_t seq) {
  Statement found(*this->Database_, "SELECT seq, time, wall, kind, payload, checksum FROM snapshot "
                                    "WHERE seq <= ? ORDER BY seq DESC LIMIT 1");
  if (!found.Bind(1, Bound(seq)).Step()) {
    this->Database_->Damaged("the state before command " + std::to_string(seq) + " is missing");
  }
  Sha256 sum;
  return RowOf(*this->Database_, found, true, sum);
}

RecordedSnapshot RecordingReader::SnapshotAt(std::uint64_t seq) {
  RecordingRow row = this->SnapshotRow(seq);
  RecordedSnapshot snapshot{row.seq, row.time_s, row.wall_s, {}, false};
  if (auto readable = WithTextUtf8OfAll(row.payload, *v1::Command::descriptor())) {
    row.payload = std::move(*readable);
    snapshot.foreignText = true;
  }
  google::protobuf::io::ArrayInputStream bytes(row.payload.data(), int(row.payload.size()));
  google::protobuf::io::CodedInputStream in(&bytes);
  bool end = false;
  for (std::string each; !end;) {
    std::uint32_t size = 0;
    end = in.CurrentPosition() == int(row.payload.size());
    if (end || !in.ReadVarint32(&size) || !in.ReadString(&each, int(size))) {
      break;
    }
    RequireElements(*this->Database_, each, "snapshot " + std::to_string(row.seq));
    v1::Command command;
    if (!command.ParseFromString(each)) {
      break;
    }
    snapshot.commands.push_back(std::move(command));
  }
  if (!end || snapshot.commands.size() != std::size_t(row.kind)) {
    this->Database_->Damaged("snapshot " + std::to_string(row.seq) + " is not a list of commands");
  }
  return snapshot;
}

void RecordingReader::ReadSnapshots(std::uint64_t first, std::uint64_t last,
                                    const std::function<bool(RecordingRow&&)>& take) {
  Statement rows(*this->Database_, "SELECT seq, time, wall, kind, payload, checksum FROM snapshot "
                                   "WHERE seq BETWEEN ? AND ? ORDER BY seq");
  rows.Bind(1, Bound(first)).Bind(2, Bound(last));
  Sha256 sum;
  while (rows.Step() && take(RowOf(*this->Database_, rows, true, sum))) {
  }
}

std::vector<std::uint64_t> RecordingReader::Snapshots() {
  Statement found(*this->Database_, "SELECT seq FROM snapshot ORDER BY seq");
  std::vector<std::uint64_t> seqs;
  while (found.Step()) {
    seqs.push_back(std::uint64_t(found.Integer(0)));
  }
  return seqs;
}

std::vector<std::pair<std::uint64_t, double>>
RecordingReader::Steps(const std::optional<std::string>& scene) {
  static_assert(SetTime == 13, "the index `step` is of commands of this kind");
  Statement found(*this->Database_,
                  scene ? "SELECT seq, time, payload FROM command INDEXED BY step WHERE kind = 13"
                        : "SELECT seq, time FROM command INDEXED BY step WHERE kind = 13");
  std::vector<std::pair<std::uint64_t, double>> steps;
  v1::Command command;
  while (found.Step()) {
    const auto seq = std::uint64_t(found.Integer(0));
    if (scene) {
      bool foreign = false;
      const std::string bytes = found.Bytes(2);
      RequireElements(*this->Database_, bytes, "command " + std::to_string(seq));
      if (!ParseCommand(bytes, command, foreign)) {
        this->Database_->Damaged("command " + std::to_string(seq) + " is not a Command message");
      }
      if (SceneName(command) != *scene) {
        continue;
      }
    }
    steps.emplace_back(seq, found.Real(1));
  }
  std::sort(steps.begin(), steps.end());
  return steps;
}

std::vector<std::pair<std::uint64_t, std::uint64_t>> RecordingReader::Lost() {
  Statement found(*this->Database_, "SELECT value FROM meta WHERE key = 'lost'");
  std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;
  if (!found.Step()) {
    return ranges;
  }
  const auto damaged = [this](const std::string& why) {
    this->Database_->Damaged("the list of its lost commands is damaged: " + why);
  };
  constexpr std::size_t Many = 1000; // counted only then, since it takes time
  std::uint64_t most = Many;
  const std::string text = found.Bytes(0);
  const char* at = text.c_str();
  for (;;) {
    at += std::strspn(at, " ");
    if (*at == '\0') {
      break;
    }
    char* end = nullptr;
    const std::uint64_t first = std::strtoull(at, &end, 10);
    const bool two = *end == '-' && end != at;
    const std::uint64_t last = two ? std::strtoull(end + 1, &end, 10) : 0;
    if (first == 0 || last < first || (*end != ' ' && *end != '\0')) {
      damaged("'" + Printable(std::string(at, std::strcspn(at, " ")).substr(0, 40)) +
              "' is no range of commands");
    }
    if (!ranges.empty() && first <= ranges.back().second) {
      damaged("its ranges do not ascend");
    }
    if (ranges.size() == Many) { // between two of them is a command, or a snapshot after the first
      most = 1 +
             std::uint64_t(this->Database_->Number(
                 "SELECT (SELECT count(seq) FROM command) + (SELECT count(seq) FROM snapshot)", 0));
    }
    if (ranges.size() >= Many && ranges.size() >= most) {
      damaged("it has more ranges than there are commands and snapshots");
    }
    ranges.emplace_back(first, last);
    at = end;
  }
  return ranges;
}

RecordingReader::Counts RecordingReader::Count() {
  Counts counts;
  counts.snapshots = std::uint64_t(this->Database_->Number("SELECT count(seq) FROM snapshot", 0));
  Statement ends(*this->Database_,
                 "SELECT min(time), max(time), min(wall), max(wall) FROM command");
  if (ends.Step()) {
    counts.firstTime_s = ends.Real(0);
    counts.lastTime_s = ends.Real(1);
    counts.firstWall_s = ends.Real(2);
    counts.lastWall_s = ends.Real(3);
  }
  Statement kinds(*this->Database_, "SELECT kind, count(*), sum(length(payload)) FROM command "
                                    "GROUP BY kind ORDER BY 2 DESC");
  while (kinds.Step()) {
    counts.kinds.push_back(
        {int(kinds.Integer(0)), std::uint64_t(kinds.Integer(1)), std::uint64_t(kinds.Integer(2))});
  }
  return counts;
}

void RecordingReader::ReadAssets(std::int64_t after,
                                 const std::function<void(RecordingAsset&&)>& take) {
  Statement rows(*this->Database_, "SELECT id, path, state, size, sha256, packed, checksum "
                                   "FROM asset WHERE id > ? ORDER BY id");
  rows.Bind(1, after);
  while (rows.Step()) {
    RecordingAsset asset;
    asset.id = rows.Integer(0);
    asset.path = rows.Bytes(1);
    asset.state = rows.Bytes(2);
    asset.size = rows.Integer(3);
    asset.sha256 = rows.Bytes(4);
    asset.packed = rows.Integer(5) != 0;
    if (rows.Bytes(6) != RecordingChecksum(asset)) {
      this->Database_->Damaged("asset " + std::to_string(asset.id) + " is damaged");
    }
    take(std::move(asset));
  }
}

std::vector<RecordingAsset> RecordingReader::Assets(std::int64_t after) {
  std::map<std::string, RecordingAsset> found;
  this->ReadAssets(after, [&](RecordingAsset&& asset) { found[asset.path] = std::move(asset); });
  std::vector<RecordingAsset> assets;
  for (auto& entry : found) {
    assets.push_back(std::move(entry.second));
  }
  return assets;
}

void RecordingReader::ReadParts(const std::function<void(RecordingContent&&)>& take) {
  Statement rows(*this->Database_,
                 "SELECT id, asset, place, size, data, checksum FROM content ORDER BY id");
  while (rows.Step()) {
    RecordingContent part = PartOf(rows);
    if (rows.Bytes(5) != RecordingChecksum(part)) {
      this->Database_->Damaged("content " + std::to_string(part.id) + " is damaged");
    }
    take(std::move(part));
  }
}

RecordingReader::PartNumbers RecordingReader::Parts() {
  Statement rows(*this->Database_, "SELECT asset, id FROM content ORDER BY place");
  PartNumbers numbers;
  while (rows.Step()) {
    numbers[rows.Integer(0)].push_back(rows.Integer(1));
  }
  return numbers;
}

void RecordingReader::ReadContent(const RecordingAsset& asset,
                                  const std::vector<std::int64_t>& parts,
                                  const std::function<void(const std::string&)>& take) {
  const std::string named = "the content of '" + asset.path + "'";
  std::int64_t place = 0;
  for (const std::int64_t number : parts) {
    Statement row(*this->Database_,
                  "SELECT id, asset, place, size, data, checksum FROM content WHERE id = ?");
    RecordingContent part;
    bool good = row.Bind(1, number).Step();
    if (good) {
      part = PartOf(row);
      good = row.Bytes(5) == RecordingChecksum(part) && part.asset == asset.id &&
             part.place == place && part.size > 0 && part.size <= RecordingPartBytes &&
             part.size <= asset.size - place; // no more is made than is said
    }
    if (good && std::int64_t(part.data.size()) != part.size) {
      part.data = Decompress(part.data, part.size);
      good = std::int64_t(part.data.size()) == part.size;
    }
    if (!good) {
      this->Database_->Damaged(named + " is damaged at byte " + std::to_string(place));
    }
    take(part.data);
    place += part.size;
  }
  if (place != asset.size) {
    this->Database_->Damaged(named + " ends at byte " + std::to_string(place) + " of " +
                             std::to_string(asset.size));
  }
}

} // namespace dspace::session
