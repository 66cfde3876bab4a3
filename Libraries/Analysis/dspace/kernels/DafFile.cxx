#include <dspace/kernels/DafFile.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <mutex>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <dspace/Error.h>
#include <dspace/FilesRead.h>

namespace dspace {
namespace {

constexpr std::int64_t RecordSize = 1024; // bytes
constexpr std::size_t KeptLimit = std::size_t(256) << 20;

const bool HostIsBigEndian = [] {
  const std::uint16_t one = 1;
  return *reinterpret_cast<const unsigned char*>(&one) == 0;
}();

template<typename T> T Value(const char* bytes, bool swap) {
  char copy[sizeof(T)];
  std::memcpy(copy, bytes, sizeof(T));
  if (swap) {
    std::reverse(copy, copy + sizeof(T));
  }
  T value;
  std::memcpy(&value, copy, sizeof(T));
  return value;
}

std::string Trimmed(const char* bytes, std::size_t count) {
  std::string text(bytes, count);
  text.erase(std::find(text.begin(), text.end(), '\0'), text.end());
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

} // namespace

// The file, and blocks of it that were read.
struct DafFile::Blocks {
  ~Blocks() {
    for (std::size_t i = 0; i < this->count; ++i) {
      delete[] this->words[i].load();
    }
    if (this->file >= 0) {
      ::close(this->file);
    }
  }

  int file = -1;
  bool swap = false;
  std::int64_t blockWords = 1024;
  std::size_t count = 0;
  std::unique_ptr<std::atomic<const double*>[]> words;
  std::mutex reading;
  std::size_t kept = 0; // bytes
  std::atomic<std::uint64_t> bytesRead{0};
};

std::string DafFile::Label() const {
  return "kernel '" + std::filesystem::path(this->Path_).filename().string() + "'";
}

void DafFile::Damaged(const std::string& what) const {
  throw Error(Error::Kind::Corrupt, this->Label(), what);
}

DafFile::DafFile(const std::string& path) : Path_(path), Blocks_(std::make_unique<Blocks>()) {
  NoteFileRead(path);
  Blocks& blocks = *this->Blocks_;
  blocks.file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (blocks.file < 0 || ::fstat(blocks.file, &status) != 0 || !S_ISREG(status.st_mode)) {
    const bool absent = blocks.file < 0 && errno == ENOENT;
    throw Error(absent ? Error::Kind::NotFound : Error::Kind::Io, this->Label(),
                blocks.file < 0 ? "the file cannot be opened: " + std::string(std::strerror(errno))
                                : "it is not a regular file");
  }
  this->Size_ = status.st_size;
  char record[RecordSize];
  if (this->Size_ < RecordSize) {
    this->Damaged("the file has " + std::to_string(this->Size_) +
                  " bytes, and is neither text that begins with KPL/ nor a binary kernel of SPICE, "
                  "which begins with 1024");
  }
  this->ReadBytes(0, record, sizeof(record));
  const std::string word = Trimmed(record, 8);
  if (word == "DAF/SPK" || word == "DAF/CK" || word == "DAF/PCK") {
    this->Kind_ = word.substr(4);
  } else if (word != "NAIF/DAF") {
    this->Damaged("the file does not begin with the id word of a binary kernel; accepted: "
                  "DAF/SPK, DAF/CK, DAF/PCK and NAIF/DAF");
  }
  const std::string format = Trimmed(record + 88, 8);
  if (this->Kind_.empty()) { // the format is not stated: the only order in which ND makes sense
    const auto little = Value<std::int32_t>(record + 8, HostIsBigEndian);
    this->BigEndian_ = little < 0 || little > 124;
  } else if (format == "BIG-IEEE" || format == "LTL-IEEE") {
    this->BigEndian_ = format == "BIG-IEEE";
  } else {
    this->Damaged("its format is '" + format + "'; accepted: BIG-IEEE, LTL-IEEE");
  }
  const bool swap = this->BigEndian_ != HostIsBigEndian;
  blocks.swap = swap;
  this->DoubleCount_ = Value<std::int32_t>(record + 8, swap);
  this->IntegerCount_ = Value<std::int32_t>(record + 12, swap);
  this->InternalName_ = Trimmed(record + 16, 60);
  this->FirstSummaryRecord_ = Value<std::int32_t>(record + 76, swap);
  const int summaryWords = this->DoubleCount_ + (this->IntegerCount_ + 1) / 2;
  if (this->DoubleCount_ < 0 || this->DoubleCount_ > 124 || this->IntegerCount_ < 2 ||
      this->IntegerCount_ > 250 || summaryWords > 125) {
    this->Damaged("its summaries have " + std::to_string(this->DoubleCount_) + " doubles and " +
                  std::to_string(this->IntegerCount_) +
                  " integers; accepted: up to 124 and 2 to 250, within 125 words");
  }
  // Damage by a transfer as text shows in these bytes.
  static const char ftp[] = "FTPSTR:\r:\n:\r\n:\r\0:\x81:\x10\xce:ENDFTP";
  if (!this->Kind_.empty()) {
    const auto* found = std::search(record + 600, record + RecordSize, ftp, ftp + 6);
    if (found != record + RecordSize && (found + sizeof(ftp) - 1 > record + RecordSize ||
                                         std::memcmp(found, ftp, sizeof(ftp) - 1) != 0)) {
      this->Damaged("the file was transferred as text, which changed its bytes; accepted: a copy "
                    "that was transferred as binary");
    }
  }

  const std::int64_t words = this->Size_ / 8;
  blocks.blockWords = 1024;
  while (words / blocks.blockWords > (1 << 20)) {
    blocks.blockWords *= 2;
  }
  blocks.count = std::size_t(words / blocks.blockWords + 1);
  blocks.words = std::make_unique<std::atomic<const double*>[]>(blocks.count);
  for (std::size_t i = 0; i < blocks.count; ++i) {
    blocks.words[i].store(nullptr, std::memory_order_relaxed);
  }

  const std::int64_t records = (this->Size_ + RecordSize - 1) / RecordSize;
  std::int64_t next = this->FirstSummaryRecord_;
  std::int64_t visited = 0;
  while (next != 0) {
    if (next < 2 || next > records || ++visited > records) {
      this->Damaged("its summary record " + std::to_string(next) + " is outside its " +
                    std::to_string(records) + " records: it is truncated or damaged");
    }
    char summaries[RecordSize];
    char names[RecordSize];
    if (next * RecordSize > this->Size_) {
      this->Damaged("it ends within summary record " + std::to_string(next) + ": it is truncated");
    }
    this->ReadBytes((next - 1) * RecordSize, summaries, sizeof(summaries));
    const auto count = Value<double>(summaries + 16, swap);
    const auto following = Value<double>(summaries, swap);
    if (!(count >= 0.0 && count <= 125.0 / summaryWords) || count != std::floor(count) ||
        !(following >= 0.0 && following <= 2147483647.0) || following != std::floor(following)) {
      this->Damaged("summary record " + std::to_string(next) + " makes no sense");
    }
    std::memset(names, ' ', sizeof(names));
    if (count > 0) {
      const std::int64_t left = this->Size_ - next * RecordSize;
      const std::int64_t wanted = std::int64_t(count) * 8 * summaryWords;
      if (left < wanted) {
        this->Damaged("it ends within the names of its arrays: it is truncated");
      }
      this->ReadBytes(next * RecordSize, names, std::size_t(wanted));
    }
    for (int i = 0; i < int(count); ++i) {
      const char* summary = summaries + 24 + std::ptrdiff_t(i) * summaryWords * 8;
      Array array;
      array.name =
          Trimmed(names + std::ptrdiff_t(i) * summaryWords * 8, std::size_t(summaryWords) * 8);
      for (int k = 0; k < this->DoubleCount_; ++k) {
        array.doubles.push_back(Value<double>(summary + 8 * k, swap));
      }
      const char* integers = summary + std::ptrdiff_t(8) * this->DoubleCount_;
      for (int k = 0; k < this->IntegerCount_; ++k) {
        array.integers.push_back(Value<std::int32_t>(integers + 4 * k, swap));
      }
      array.last = array.integers.back();
      array.integers.pop_back();
      array.first = array.integers.back();
      array.integers.pop_back();
      if (array.first < 1 || array.last < array.first || array.last > words) {
        this->Damaged("array " + std::to_string(this->Arrays_.size()) + " ('" + array.name +
                      "') is at words " + std::to_string(array.first) + " to " +
                      std::to_string(array.last) + " of a file of " + std::to_string(words) +
                      ": it is truncated or damaged");
      }
      this->Arrays_.push_back(std::move(array));
    }
    next = std::int64_t(following);
  }
}

DafFile::~DafFile() = default;

void DafFile::ReadBytes(std::int64_t offset, void* bytes, std::size_t count) const {
  auto* target = static_cast<char*>(bytes);
  std::size_t done = 0;
  while (done < count) {
    const ::ssize_t read =
        ::pread(this->Blocks_->file, target + done, count - done, ::off_t(offset) + ::off_t(done));
    if (read < 0 && errno == EINTR) {
      continue;
    }
    if (read <= 0) {
      throw Error(Error::Kind::Io, this->Label(),
                  read < 0 ? "reading failed: " + std::string(std::strerror(errno))
                           : "the file became shorter since it was opened");
    }
    done += std::size_t(read);
  }
  this->Blocks_->bytesRead += count;
}

void DafFile::Read(std::int64_t first, std::int64_t count, double* words) const {
  const std::int64_t fileWords = this->Size_ / 8;
  if (count < 0 || first < 1 || first > fileWords || count > fileWords - first + 1) {
    this->Damaged("words " + std::to_string(first) + " to " + std::to_string(first + count - 1) +
                  " are outside the file's " + std::to_string(fileWords));
  }
  Blocks& blocks = *this->Blocks_;
  std::int64_t at = first - 1;
  while (count > 0) {
    const std::int64_t block = at / blocks.blockWords;
    const std::int64_t begin = block * blocks.blockWords;
    const std::int64_t here = std::min(count, begin + blocks.blockWords - at);
    const double* kept = blocks.words[std::size_t(block)].load(std::memory_order_acquire);
    if (!kept) {
      const std::lock_guard<std::mutex> lock(blocks.reading);
      kept = blocks.words[std::size_t(block)].load(std::memory_order_relaxed);
      const std::int64_t size = std::min(blocks.blockWords, fileWords - begin);
      if (!kept && blocks.kept + std::size_t(size) * 8 <= KeptLimit) {
        std::unique_ptr<double[]> read(new double[std::size_t(size)]);
        this->ReadBytes(begin * 8, read.get(), std::size_t(size) * 8);
        if (blocks.swap) {
          for (std::int64_t i = 0; i < size; ++i) {
            read[std::size_t(i)] =
                Value<double>(reinterpret_cast<const char*>(&read[std::size_t(i)]), true);
          }
        }
        blocks.kept += std::size_t(size) * 8;
        kept = read.release();
        blocks.words[std::size_t(block)].store(kept, std::memory_order_release);
      }
    }
    if (kept) {
      std::copy(kept + (at - begin), kept + (at - begin) + here, words);
    } else { // the limit is reached
      this->ReadBytes(at * 8, words, std::size_t(here) * 8);
      for (std::int64_t i = 0; blocks.swap && i < here; ++i) {
        words[i] = Value<double>(reinterpret_cast<const char*>(words + i), true);
      }
    }
    at += here;
    words += here;
    count -= here;
  }
}

std::vector<double> DafFile::Read(std::int64_t first, std::int64_t count) const {
  if (count < 0 || count > this->Size_ / 8) {
    this->Damaged("an array of " + std::to_string(count) + " words is longer than the file");
  }
  std::vector<double> words(static_cast<std::size_t>(count));
  this->Read(first, count, words.data());
  return words;
}

double DafFile::Read(std::int64_t address) const {
  double word = 0.0;
  this->Read(address, 1, &word);
  return word;
}

const double* DafFile::View(std::int64_t first, std::int64_t count,
                            std::vector<double>& kept) const {
  const Blocks& blocks = *this->Blocks_;
  const std::int64_t fileWords = this->Size_ / 8;
  if (first >= 1 && count >= 1 && count <= fileWords - first + 1) {
    const std::int64_t block = (first - 1) / blocks.blockWords;
    if ((first + count - 2) / blocks.blockWords == block) {
      const double* words = blocks.words[std::size_t(block)].load(std::memory_order_acquire);
      if (words) {
        return words + (first - 1 - block * blocks.blockWords);
      }
    }
  }
  kept.resize(std::size_t(std::max<std::int64_t>(
      0, std::min(count, fileWords)))); // Read rejects more than the file has
  this->Read(first, count, kept.data());
  return kept.data();
}

std::uint64_t DafFile::BytesRead() const {
  return this->Blocks_->bytesRead;
}

std::string DafFile::Comments() const {
  // Records between the file record and the first summary: 1000 characters each, lines end with
  // NUL, the text with EOT.
  std::string text;
  for (std::int64_t record = 2; record < this->FirstSummaryRecord_; ++record) {
    char bytes[RecordSize];
    this->ReadBytes((record - 1) * RecordSize, bytes, sizeof(bytes));
    text.append(bytes, 1000);
    if (text.find('\4') != std::string::npos || text.size() > (std::size_t(16) << 20)) {
      break;
    }
  }
  text.erase(std::find(text.begin(), text.end(), '\4'), text.end());
  std::replace(text.begin(), text.end(), '\0', '\n');
  return ToUtf8(text);
}

} // namespace dspace
