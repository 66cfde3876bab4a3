#include <dspace/ephemeris/De405Source.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <dspace/Checks.h>
#include <dspace/SystemFiles.h>
#include <dspace/kernels/ChebyshevRecords.h>
#include <dspace/time/Days.h>

namespace dspace {
namespace {

constexpr std::int64_t Header = 12;
constexpr std::int64_t RecordBytes = 8160;
constexpr std::size_t RecordWords = 1018;
constexpr std::int64_t Records = 1143;
constexpr double RecordSeconds = 32.0 * DaySeconds;
constexpr double Begin = (36912.0 - (J2000Mjd + 0.5)) * DaySeconds; // TDB [s past J2000]
constexpr double End = Begin + double(Records) * RecordSeconds;

// Where a body's coefficients are in a record: from word `first` on `count` a component, in `parts`
// intervals.
struct Place {
  std::size_t first, count, parts;
};
constexpr Place Moon{440, 13, 8}; // from the Earth
constexpr Place Sun{752, 11, 2};
constexpr Place Librations{898, 10, 4};
constexpr std::array<Place, 9> Planets{{{2, 14, 4},   // Mercury
                                        {170, 10, 2}, // Venus
                                        {230, 13, 2}, // Earth and Moon
                                        {308, 11, 1},
                                        {341, 8, 1},
                                        {365, 7, 1},
                                        {386, 6, 1},
                                        {404, 6, 1},
                                        {422, 6, 1}}};

} // namespace

// The file, and records that were read.
class De405Source::Table {
public:
  explicit Table(const std::string& path) : Label_("ephemeris '" + path + "'") {
    NoteSystemFile(path);
    this->File_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status {};
    if (this->File_ < 0 || ::fstat(this->File_, &status) != 0) {
      const int error = errno;
      this->Close();
      throw Error(error == ENOENT ? Error::Kind::NotFound : Error::Kind::Io, this->Label_,
                  std::string("it cannot be opened: ") + std::strerror(error) +
                      "; Debian's package casacore-data-jpl-de405 brings it");
    }
    if (status.st_size != Header + Records * RecordBytes) {
      this->Close();
      throw Error(Error::Kind::Corrupt, this->Label_,
                  "it has " + std::to_string(status.st_size) +
                      " bytes; accepted: the 9326892 of table.f0i of Debian's "
                      "casacore-data-jpl-de405");
    }
    const auto add = [this](int body, int center) {
      this->Coverages_.push_back({body, center, 1, Begin, End, {}});
    };
    for (int i = 1; i <= 9; ++i) {
      add(i, 0);
    }
    add(10, 0);
    add(301, 3);
    add(399, 3);
    add(199, 1);
    add(299, 2);
    add(499, 4);
    // Another table of this size has no Earth at the Sun's distance.
    try {
      State earth = this->At(Begin, Planets[2]);
      earth -= this->At(Begin, Sun);
      const double distance = earth.position.norm();
      if (!(distance > 1.46e11 && distance < 1.53e11)) {
        throw Error(Error::Kind::Corrupt, this->Label_,
                    "the Earth is " + NumberText(distance) +
                        " m from the Sun in its first record; accepted: table.f0i of Debian's "
                        "casacore-data-jpl-de405");
      }
    } catch (...) {
      this->Close();
      throw;
    }
  }

  ~Table() {
    for (auto& record : this->Kept_) {
      delete[] record.load();
    }
    this->Close();
  }

  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  static bool Covers(double tdb) { return tdb >= Begin && tdb <= End; }

  // [m, m/s], or [rad, rad/s] with a unit of 1.
  State At(double tdb, const Place& place, double unit = 1000.0) const {
    const double index = std::floor((tdb - Begin) / RecordSeconds);
    const auto record = std::size_t(std::clamp(index, 0.0, double(Records - 1)));
    const double length = RecordSeconds / double(place.parts);
    const double inRecord = tdb - (Begin + double(record) * RecordSeconds);
    const double partIndex =
        std::clamp(std::floor(inRecord / length), 0.0, double(place.parts - 1));
    const double x = 2.0 * (inRecord - partIndex * length) / length - 1.0;
    const double* words =
        this->Record(record) + place.first + std::size_t(partIndex) * 3 * place.count;
    State state;
    for (int axis = 0; axis < 3; ++axis) {
      ChebyshevSum(words + std::size_t(axis) * place.count, place.count, x, state.position[axis],
                   state.velocity[axis]);
    }
    state.position *= unit;
    state.velocity *= unit * 2.0 / length;
    if (!state.position.allFinite() || !state.velocity.allFinite()) {
      throw Error(Error::Kind::Corrupt, this->Label_,
                  "record " + std::to_string(record) +
                      " has coefficients that add up to no finite number");
    }
    return state;
  }

  const std::vector<Coverage>& Coverages() const { return this->Coverages_; }

private:
  void Close() {
    if (this->File_ >= 0) {
      ::close(this->File_);
      this->File_ = -1;
    }
  }

  const double* Record(std::size_t index) const {
    const double* kept = this->Kept_[index].load(std::memory_order_acquire);
    if (kept) {
      return kept;
    }
    const std::lock_guard<std::mutex> lock(this->Reading_);
    kept = this->Kept_[index].load(std::memory_order_relaxed);
    if (kept) {
      return kept;
    }
    unsigned char bytes[RecordWords * 8];
    const ::off_t offset = Header + ::off_t(index) * RecordBytes;
    if (::pread(this->File_, bytes, sizeof(bytes), offset) != ::ssize_t(sizeof(bytes))) {
      throw Error(Error::Kind::Io, this->Label_,
                  "record " + std::to_string(index) + " cannot be read");
    }
    std::unique_ptr<double[]> words(new double[RecordWords]);
    for (std::size_t i = 0; i < RecordWords; ++i) {
      std::uint64_t bits = 0;
      for (int byte = 7; byte >= 0; --byte) { // little-endian
        bits = bits << 8 | bytes[8 * i + std::size_t(byte)];
      }
      std::memcpy(&words[i], &bits, 8);
      if (i >= 2 && !std::isfinite(words[i])) {
        throw Error(Error::Kind::Corrupt, this->Label_,
                    "record " + std::to_string(index) + " has a coefficient that is not finite");
      }
    }
    kept = words.release();
    this->Kept_[index].store(kept, std::memory_order_release);
    return kept;
  }

  std::string Label_;
  int File_ = -1;
  std::vector<Coverage> Coverages_;
  mutable std::mutex Reading_;
  mutable std::array<std::atomic<const double*>, std::size_t(Records)> Kept_{};
};

const char* De405Source::StandardPath() {
  return "/usr/share/casacore/data/ephemerides/DE405/table.f0i";
}

bool De405Source::IsInstalled() {
  std::error_code error;
  return std::filesystem::is_regular_file(StandardPath(), error);
}

De405Source::De405Source(const std::string& path) : Table_(std::make_unique<Table>(path)) {}

De405Source::~De405Source() = default;

const std::string& De405Source::Name() const {
  static const std::string name = "JPL DE405";
  return name;
}

// Distances from DE430 on 2015-03-02, which has 15 years more of observations (TestEphemeris).
std::string De405Source::Accuracy(int body) const {
  switch (body) {
  case 301:
    return "10 m from DE430 in 2015";
  case 1:
  case 2:
  case 3:
  case 4:
  case 199:
  case 299:
  case 399:
    return "1 km from DE430 in 2015";
  case 499:
    return "1 km from DE430 in 2015; taken as Mars's barycentre, off by up to 0.2 m";
  case 5:
    return "130 km from DE430 in 2015";
  case 6:
    return "620 km from DE430 in 2015";
  case 7:
    return "2,300 km from DE430 in 2015";
  case 8:
    return "5,000 km from DE430 in 2015";
  case 9:
    return "12,400 km from DE430 in 2015";
  default:
    return {};
  }
}

const std::vector<StateSource::Coverage>& De405Source::Coverages() const {
  return this->Table_->Coverages();
}

std::optional<StateSource::Link> De405Source::Find(int body, double tdb) const {
  const auto& coverages = this->Table_->Coverages();
  if (!Table::Covers(tdb)) {
    return std::nullopt;
  }
  const auto link = [&](std::size_t part, State state) {
    return Link{coverages[part].center, 1, state, int(part)};
  };
  if (body >= 1 && body <= 9) {
    const auto part = std::size_t(body - 1);
    return link(part, this->Table_->At(tdb, Planets[part]));
  }
  switch (body) {
  case 10:
    return link(9, this->Table_->At(tdb, Sun));
  case 301:
  case 399: {
    State moon = this->Table_->At(tdb, Moon);
    const double part = body == 301 ? 1.0 - MoonMassShare : -MoonMassShare;
    moon.position *= part;
    moon.velocity *= part;
    return link(body == 301 ? 10 : 11, moon);
  }
  case 199:
    return link(12, {});
  case 299:
    return link(13, {});
  case 499:
    return link(14, {});
  default:
    return std::nullopt;
  }
}

std::optional<De405Source::Libration> De405Source::LibrationAt(double tdb) const {
  if (!Table::Covers(tdb)) {
    return std::nullopt;
  }
  const State angles = this->Table_->At(tdb, Librations, 1.0);
  return Libration{angles.position, angles.velocity};
}

} // namespace dspace
