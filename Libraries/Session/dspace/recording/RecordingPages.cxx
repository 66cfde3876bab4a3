// SQLite's file format (sqlite.org/fileformat2.html): pages of one size. A leaf page of a table
// begins with byte 13, the number of its cells at 3, their places from 8 on. A cell is the length
// of its payload, the row's number (both varints), the payload, and where that does not fit, the
// number of the first page of a chain that holds the rest. The payload is a record: types of its
// columns, then their values. The write-ahead log has a head of 32 bytes, then pages, each after a
// head of 24 that states the page's number and a salt, which changes when the log restarts.
#include <dspace/recording/RecordingPages.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <dspace/Error.h>
#include <dspace/recording/RecordingDatabase.h>

namespace dspace::session {
namespace {

constexpr unsigned char Leaf = 13;
constexpr std::size_t LogHead = 32;
constexpr std::size_t FrameHead = 24;
constexpr std::size_t Generations = 8; // of a log, whose pages are tried
constexpr std::size_t MaximumColumns = 7;

// A file's bytes; none where there is no such file.
class Source {
public:
  explicit Source(const std::string& path) : Path_(path) {
    this->File_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat state = {};
    if (this->File_ < 0 && errno != ENOENT) {
      this->Fail();
    }
    if (this->File_ >= 0 && ::fstat(this->File_, &state) == 0 && state.st_size > 0) {
      this->Size_ = std::size_t(state.st_size);
    }
  }
  ~Source() {
    if (this->File_ >= 0) {
      ::close(this->File_);
    }
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  std::size_t Size() const { return this->Size_; }

  // As many bytes as there are.
  std::string Read(std::size_t place, std::size_t size) const {
    size = place < this->Size_ ? std::min(size, this->Size_ - place) : 0;
    std::string bytes(size, '\0');
    std::size_t got = 0;
    while (got < size) {
      const ssize_t n = ::pread(this->File_, bytes.data() + got, size - got, off_t(place + got));
      if (n < 0 && errno != EINTR) {
        this->Fail();
      }
      if (n == 0) { // it has become shorter
        break;
      }
      got += n > 0 ? std::size_t(n) : 0;
    }
    bytes.resize(got);
    return bytes;
  }

private:
  [[noreturn]] void Fail() const {
    throw Error(Error::Kind::Io, RecordingName(this->Path_),
                std::string("it cannot be read: ") + std::strerror(errno) +
                    "; accepted: a file that can be read");
  }

  const std::string Path_;
  int File_ = -1;
  std::size_t Size_ = 0;
};

// A big-endian number of some bytes, of which there must be as many.
std::uint64_t Unsigned(const std::string& data, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    value = value << 8 | static_cast<unsigned char>(data[at + i]);
  }
  return value;
}

// Moves `at` on; none where the bytes end before it.
std::optional<std::uint64_t> Varint(const std::string& data, std::size_t& at) {
  std::uint64_t value = 0;
  for (int n = 0; n < 9 && at < data.size(); ++n) {
    const auto byte = static_cast<unsigned char>(data[at++]);
    if (n == 8) {
      return value << 8 | byte;
    }
    value = value << 7 | (byte & 127u);
    if (byte < 128) {
      return value;
    }
  }
  return std::nullopt;
}

using Column = std::variant<std::monostate, std::int64_t, double, std::string>;

// By SQLite's serial types; moves `at` on. None where the bytes end before it.
std::optional<Column> ColumnAt(const std::string& record, std::uint64_t type, std::size_t& at) {
  constexpr std::size_t sizes[] = {0, 1, 2, 3, 4, 6, 8, 8, 0, 0};
  if (type == 10 || type == 11) {
    return std::nullopt;
  }
  const std::uint64_t size = type < 10 ? sizes[type] : (type - 12) / 2;
  if (at > record.size() || size > record.size() - at) {
    return std::nullopt;
  }
  const std::size_t begin = at;
  at += size;
  if (type == 0) {
    return Column();
  }
  if (type == 7) {
    const std::uint64_t bits = Unsigned(record, begin, 8);
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    return Column(value);
  }
  if (type < 7) {
    const std::uint64_t bits = Unsigned(record, begin, size);
    const unsigned shift = unsigned(64 - 8 * size); // keeps the sign
    return Column(std::int64_t(bits << shift) >> shift);
  }
  if (type < 10) {
    return Column(std::int64_t(type - 8));
  }
  return Column(record.substr(begin, size));
}

bool IsNumber(const Column& column) {
  return std::holds_alternative<std::int64_t>(column) || std::holds_alternative<double>(column);
}

// SQLite keeps whole doubles as integers.
double ToReal(const Column& column) {
  const auto* whole = std::get_if<std::int64_t>(&column);
  return whole ? double(*whole) : std::get<double>(column);
}

// Converts records with a valid checksum to rows.
class RowValidator {
public:
  std::optional<FoundRow> Validate(std::int64_t key, std::vector<Column>& columns) {
    return columns.size() == 7 ? Asset(key, columns)
           : columns.size() == 6 && std::holds_alternative<std::monostate>(columns[0]) &&
                   std::holds_alternative<std::string>(columns[4]) &&
                   std::holds_alternative<std::string>(columns[5])
               ? this->Row(key, columns)
               : std::nullopt;
  }

private:
  static std::optional<FoundRow> Asset(std::int64_t key, std::vector<Column>& columns) {
    auto* path = std::get_if<std::string>(&columns[1]);
    auto* state = std::get_if<std::string>(&columns[2]);
    auto* size = std::get_if<std::int64_t>(&columns[3]);
    auto* sha256 = std::get_if<std::string>(&columns[4]);
    auto* packed = std::get_if<std::int64_t>(&columns[5]);
    auto* checksum = std::get_if<std::string>(&columns[6]);
    if (!path || !state || !size || !sha256 || !packed || !checksum) {
      return std::nullopt;
    }
    RecordingAsset asset;
    asset.id = key;
    asset.path = std::move(*path);
    asset.state = std::move(*state);
    asset.size = *size;
    asset.sha256 = std::move(*sha256);
    asset.packed = *packed != 0;
    if (RecordingChecksum(asset) != *checksum) {
      return std::nullopt;
    }
    return FoundRow(std::move(asset));
  }

  std::optional<FoundRow> Row(std::int64_t key, std::vector<Column>& columns) {
    const auto& checksum = std::get<std::string>(columns[5]);
    auto& bytes = std::get<std::string>(columns[4]);
    const auto* whole1 = std::get_if<std::int64_t>(&columns[1]);
    const auto* whole2 = std::get_if<std::int64_t>(&columns[2]);
    const auto* kind = std::get_if<std::int64_t>(&columns[3]);
    if (!kind) {
      return std::nullopt;
    }
    if (whole1 && whole2) {
      RecordingContent content;
      content.id = key;
      content.asset = *whole1;
      content.place = *whole2;
      content.size = *kind;
      content.data.swap(bytes);
      if (RecordingChecksum(content) == checksum) {
        return FoundRow(std::move(content));
      }
      content.data.swap(bytes);
    }
    if (!IsNumber(columns[1]) || !IsNumber(columns[2]) || std::int32_t(*kind) != *kind || key < 0) {
      return std::nullopt;
    }
    RecordingRow row;
    row.seq = std::uint64_t(key);
    row.time_s = ToReal(columns[1]);
    row.wall_s = ToReal(columns[2]);
    row.kind = std::int32_t(*kind);
    row.payload = std::move(bytes);
    for (const bool snapshot : {false, true}) {
      row.snapshot = snapshot;
      if (RecordingChecksum(this->Sum_, row) == checksum) {
        return FoundRow(std::move(row));
      }
    }
    return std::nullopt;
  }

  Sha256 Sum_;
};

// The pages of a recording and of its log, of one size.
class Pages {
public:
  Pages(const Source& data, const Source& log, std::size_t size)
      : Data_(data), Log_(log), Size_(size) {
    this->FindGenerations();
  }

  bool Find(const std::function<void(FoundRow&&)>& take, const CancelCheck& checkCancel) {
    bool any = false;
    const auto look = [&](const std::string& page) {
      for (const std::size_t start : {0, 100}) { // the first page begins with the file's head
        any = this->FindInPage(page, start, take, checkCancel) || any;
      }
    };
    for (std::size_t place = 0; place < this->Data_.Size(); place += this->Size_) {
      look(this->Data_.Read(place, this->Size_));
    }
    for (std::size_t place = LogHead; place + FrameHead < this->Log_.Size();
         place += FrameHead + this->Size_) {
      look(this->Log_.Read(place + FrameHead, this->Size_));
    }
    return any;
  }

private:
  // Places in the log of a page's newest version, in one of the log's turns.
  using Generation = std::map<std::uint64_t, std::size_t>;

  // The log's own generation first, then the others (its head may be damaged), then none, which
  // leaves the file itself.
  void FindGenerations() {
    std::map<std::string, Generation> turns;
    for (std::size_t place = LogHead; place + FrameHead < this->Log_.Size();
         place += FrameHead + this->Size_) {
      const std::string head = this->Log_.Read(place, FrameHead);
      if (head.size() == FrameHead) {
        turns[head.substr(8, 8)][Unsigned(head, 0, 4)] = place + FrameHead;
      }
    }
    const std::string own = this->Log_.Read(16, 8);
    std::vector<std::pair<std::string, Generation>> order(turns.begin(), turns.end());
    std::stable_sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
      return std::make_pair(a.first != own, -std::ptrdiff_t(a.second.size())) <
             std::make_pair(b.first != own, -std::ptrdiff_t(b.second.size()));
    });
    for (std::size_t i = 0; i < order.size() && i < Generations; ++i) {
      this->Generations_.push_back(std::move(order[i].second));
    }
    this->Generations_.emplace_back();
  }

  std::string Page(std::uint64_t number, const Generation& generation) const {
    const auto logged = generation.find(number);
    if (logged != generation.end()) {
      return this->Log_.Read(logged->second, this->Size_);
    }
    return number > 0 ? this->Data_.Read((number - 1) * this->Size_, this->Size_) : std::string();
  }

  bool FindInPage(const std::string& page, std::size_t start,
                  const std::function<void(FoundRow&&)>& take, const CancelCheck& checkCancel) {
    checkCancel();
    if (page.size() < start + 8 || static_cast<unsigned char>(page[start]) != Leaf) {
      return false;
    }
    // Cells of a sound page share no bytes; in a forged one they may, which must not take long.
    std::set<std::uint64_t> seen;
    this->Left_ = (this->Data_.Size() + this->Log_.Size()) * this->Generations_.size();
    bool any = false;
    const std::uint64_t count = Unsigned(page, start + 3, 2);
    for (std::size_t n = 0; n < count && start + 10 + 2 * n <= page.size(); ++n) {
      const std::uint64_t place = Unsigned(page, start + 8 + 2 * n, 2);
      if (!seen.insert(place).second) {
        continue;
      }
      checkCancel();
      for (const Generation& generation : this->Generations_) {
        bool chained = false;
        std::optional<FoundRow> row = this->RowAt(page, std::size_t(place), generation, chained);
        if (row) {
          any = true;
          take(std::move(*row));
        }
        if (row || !chained) { // all of it is on this page, whatever the log holds
          break;
        }
      }
    }
    return any;
  }

  std::optional<FoundRow> RowAt(const std::string& page, std::size_t at,
                                const Generation& generation, bool& chained) {
    const auto size = Varint(page, at);
    const auto key = size ? Varint(page, at) : std::nullopt;
    if (!key || *size > this->Data_.Size() + this->Log_.Size()) {
      return std::nullopt;
    }
    const std::optional<std::string> record =
        this->PayloadAt(page, at, std::size_t(*size), generation, chained);
    std::size_t place = 0;
    const auto head = record ? Varint(*record, place) : std::nullopt;
    if (!head || *head > record->size()) {
      return std::nullopt;
    }
    auto values = std::size_t(*head);
    std::vector<Column> columns;
    while (place < *head) {
      const auto type = Varint(*record, place);
      std::optional<Column> column;
      if (!type || columns.size() == MaximumColumns ||
          !(column = ColumnAt(*record, *type, values))) {
        return std::nullopt;
      }
      columns.push_back(std::move(*column));
    }
    return this->Validator_.Validate(std::int64_t(*key), columns);
  }

  // With its overflow pages; how much of it is on the leaf itself is SQLite's rule.
  std::optional<std::string> PayloadAt(const std::string& page, std::size_t at, std::size_t size,
                                       const Generation& generation, bool& chained) {
    const std::size_t most = this->Size_ - 35;
    if (size <= most) {
      return at + size <= page.size() ? std::optional<std::string>(page.substr(at, size))
                                      : std::nullopt;
    }
    chained = true;
    const std::size_t least = (this->Size_ - 12) * 32 / 255 - 23;
    const std::size_t fitting = least + (size - least) % (this->Size_ - 4);
    const std::size_t local = fitting <= most ? fitting : least;
    if (at + local + 4 > page.size()) {
      return std::nullopt;
    }
    std::string payload = page.substr(at, local);
    std::uint64_t following = Unsigned(page, at + local, 4);
    while (payload.size() < size) {
      if (this->Left_ < this->Size_) {
        return std::nullopt;
      }
      this->Left_ -= this->Size_;
      const std::string next = this->Page(following, generation);
      const std::size_t wanted = std::min(size - payload.size(), this->Size_ - 4);
      if (next.size() < 4 + wanted) {
        return std::nullopt;
      }
      payload.append(next, 4, wanted);
      following = Unsigned(next, 0, 4);
    }
    return payload;
  }

  const Source& Data_;
  const Source& Log_;
  const std::size_t Size_;
  std::vector<Generation> Generations_;
  std::size_t Left_ = 0; // bytes of chains that cells of the present page may still have
  RowValidator Validator_;
};

// Of pages: what the file's head says, which may be damaged, ours, and a common one.
std::vector<std::size_t> SizesOf(const Source& data) {
  std::vector<std::size_t> sizes;
  const std::string head = data.Read(16, 2);
  const std::size_t said = head.size() == 2 ? std::size_t(Unsigned(head, 0, 2)) : 0;
  for (const std::size_t size :
       {said == 1 ? std::size_t(65536) : said, std::size_t(65536), std::size_t(4096)}) {
    if (size >= 512 && (size & (size - 1)) == 0 &&
        std::find(sizes.begin(), sizes.end(), size) == sizes.end()) {
      sizes.push_back(size);
    }
  }
  return sizes;
}

} // namespace

void FindRows(const std::string& path, const std::function<void(FoundRow&&)>& take,
              const CancelCheck& checkCancel) {
  const Source data(path);
  const Source log(path + "-wal");
  for (const std::size_t size : SizesOf(data)) {
    if (Pages(data, log, size).Find(take, checkCancel)) {
      return;
    }
  }
}

} // namespace dspace::session
