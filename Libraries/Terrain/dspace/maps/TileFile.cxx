#include <dspace/maps/TileFile.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <mutex>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <dspace/AtomicFile.h>
#include <dspace/Checks.h>
#include <dspace/gdal/GdalErrors.h>

namespace dspace {
namespace {

constexpr char Magic[8] = {'D', 'S', 'P', 'T', 'I', 'L', 'E', '1'};

struct JournalHead {
  char magic[8];
  std::uint64_t hash;
};
struct JournalEntry {
  std::uint32_t tile;
  std::uint32_t check; // ~tile: what was written in part does not count
};

// Removes the partial file unless it has the inputs.
void Discard(const std::string& part, const std::string& journal, std::uint64_t hash) {
  JournalHead head = {};
  std::ifstream file(journal, std::ios::binary);
  const bool same = file.read(reinterpret_cast<char*>(&head), sizeof(head)) && head.hash == hash;
  std::error_code error;
  if (!same) {
    std::filesystem::remove(journal, error);
    std::filesystem::remove(part, error);
  }
  if (error) {
    throw Error(Error::Kind::Io, "file '" + part + "'", error.message());
  }
}

std::string Bytes(double bytes) {
  return NumberText(std::round(bytes / 1e4) / 100.0) + " MB";
}

void RequireRoom(const std::string& path, std::uint64_t bytes) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  struct statvfs disk = {};
  if (::statvfs(folder.c_str(), &disk) != 0) {
    throw Error(Error::Kind::Io, "file '" + path + "'", std::strerror(errno));
  }
  const double free = double(disk.f_bavail) * double(disk.f_frsize);
  if (double(bytes) > free) {
    throw Error(Error::Kind::Resource, "file '" + path + "'",
                "it needs " + Bytes(double(bytes)) + ", and its disk has " + Bytes(free) +
                    "; accepted: fewer cells or azimuths, or another disk");
  }
}

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

} // namespace

struct TileFile::Files {
  ~Files() {
    if (this->journal >= 0) {
      ::flock(this->journal, LOCK_UN); // also for processes that were forked
    }
    for (const int file : {this->data, this->journal}) {
      if (file >= 0) {
        ::close(file);
      }
    }
  }
  int data = -1;
  int journal = -1; // locked: one process writes
  std::mutex mutex; // of the journal
};

bool TileFile::OpenJournal(const std::string& journal, int flags) {
  this->Files_->journal = ::open(journal.c_str(), O_RDWR | O_CLOEXEC | flags, 0666);
  if (this->Files_->journal < 0) {
    return false;
  }
  if (::flock(this->Files_->journal, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    throw Error(Error::Kind::AlreadyExists, "file '" + this->Part_ + "'",
                "another map is being written to it; accepted: another path, or wait for its end");
  }
  return true;
}

void TileFile::Fail(const std::string& path, int reason) const {
  throw Error(Error::Kind::Io, "file '" + path + "'", std::strerror(reason));
}

std::uint64_t TileFile::BytesOf(const TileFileLayout& layout) {
  const auto tiles = [](int cells) { return std::uint64_t((cells + Side - 1) / Side); };
  const std::uint64_t count =
      tiles(layout.columns) * tiles(layout.rows) * std::uint64_t(layout.bands.size());
  return count * (Side * Side * sizeof(float) + 16) + 65536; // and its directory
}

TileFile::TileFile(const std::string& path, const TileFileLayout& layout, bool replace)
    : Path_(path), Part_(path + ".part"), Replace_(replace), Columns_(layout.columns),
      Rows_(layout.rows), TileColumns_((layout.columns + Side - 1) / Side),
      TileRows_((layout.rows + Side - 1) / Side), Files_(std::make_unique<Files>()) {
  const std::string object = "file '" + path + "'";
  AtomicFile::Check(path);
  if (std::filesystem::exists(path) && !replace) {
    throw Error(Error::Kind::AlreadyExists, object,
                "it exists; accepted: the path of a new file, or of an incomplete map");
  }
  const std::string journal = this->Part_ + ".done";
  this->OpenJournal(journal, 0);
  if (replace) {
    Discard(this->Part_, journal, layout.hash);
    if (this->Files_->journal >= 0 && !std::filesystem::exists(journal)) {
      ::close(this->Files_->journal);
      this->Files_->journal = -1;
    }
  }
  const std::size_t tiles = std::size_t(this->TileColumns_) * std::size_t(this->TileRows_);
  JournalHead head = {};
  if (this->Files_->journal >= 0 &&
      ::read(this->Files_->journal, &head, sizeof(head)) == ssize_t(sizeof(head)) &&
      std::memcmp(head.magic, Magic, sizeof(Magic)) == 0) {
    if (head.hash != layout.hash) {
      throw Error(Error::Kind::AlreadyExists, "file '" + this->Part_ + "'",
                  "it is an incomplete map of other inputs (terrain, place, height, azimuths or "
                  "version); accepted: the same inputs, another path, or remove it");
    }
    this->Done_.assign(tiles, 0);
    off_t end = sizeof(head);
    JournalEntry entry = {};
    while (::read(this->Files_->journal, &entry, sizeof(entry)) == ssize_t(sizeof(entry))) {
      if (entry.check != ~entry.tile || entry.tile >= this->Done_.size()) {
        break;
      }
      this->Done_[entry.tile] = 1;
      end += off_t(sizeof(entry));
    }
    if (::ftruncate(this->Files_->journal, end) != 0 ||
        ::lseek(this->Files_->journal, end, SEEK_SET) < 0) {
      this->Fail(journal, errno);
    }
  } else {
    RequireRoom(path, BytesOf(layout));
    this->Done_.assign(tiles, 0);
    if (this->Files_->journal < 0 && !this->OpenJournal(journal, O_CREAT)) {
      this->Fail(journal, errno);
    }
    this->Create(layout); // while the journal has no head, nothing of it counts
    if (::ftruncate(this->Files_->journal, 0) != 0 ||
        ::lseek(this->Files_->journal, 0, SEEK_SET) < 0) {
      this->Fail(journal, errno);
    }
    std::memcpy(head.magic, Magic, sizeof(Magic));
    head.hash = layout.hash;
    if (::write(this->Files_->journal, &head, sizeof(head)) != ssize_t(sizeof(head)) ||
        ::fdatasync(this->Files_->journal) != 0) {
      this->Fail(journal, errno);
    }
  }
  this->FindOffsets(layout.bands.size());
  this->Files_->data = ::open(this->Part_.c_str(), O_RDWR | O_CLOEXEC);
  if (this->Files_->data < 0) {
    this->Fail(this->Part_, errno);
  }
}

TileFile::~TileFile() = default;

// All tiles are NaN at first.
void TileFile::Create(const TileFileLayout& layout) {
  const std::string object = "file '" + this->Path_ + "'";
  GdalErrors errors;
  RegisterGdal();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  char** options = nullptr;
  for (const char* option : {"TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64", "INTERLEAVE=BAND",
                             "BIGTIFF=IF_SAFER", "SPARSE_OK=FALSE"}) {
    options = CSLAddString(options, option);
  }
  Dataset dataset(driver->Create(this->Part_.c_str(), layout.columns, layout.rows,
                                 int(layout.bands.size()), GDT_Float32, options));
  CSLDestroy(options);
  if (!dataset) {
    throw Error(Error::Kind::Io, object, errors.Message("it cannot be created"));
  }
  const Eigen::Affine2d& m = layout.cellToMap;
  std::array<double, 6> geo = {m(0, 2), m(0, 0), m(0, 1), m(1, 2), m(1, 0), m(1, 1)};
  dataset->SetGeoTransform(geo.data());
  if (layout.crs.Ogr()) {
    dataset->SetSpatialRef(layout.crs.Ogr());
  }
  for (const auto& [key, value] : layout.metadata) {
    dataset->SetMetadataItem(key.c_str(), value.c_str());
  }
  for (std::size_t b = 0; b < layout.bands.size(); ++b) {
    dataset->GetRasterBand(int(b) + 1)->SetDescription(layout.bands[b].c_str());
  }
  dataset->GetRasterBand(1)->SetNoDataValue(std::numeric_limits<double>::quiet_NaN());
  dataset.reset(); // writes the tiles
  errors.Check(Error::Kind::Io, object);
}

void TileFile::FindOffsets(std::size_t bands) {
  GdalErrors errors;
  RegisterGdal();
  const char* const drivers[] = {"GTiff", nullptr};
  Dataset dataset(
      GDALDataset::Open(this->Part_.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers));
  const bool fits = dataset && std::size_t(dataset->GetRasterCount()) == bands &&
                    dataset->GetRasterXSize() == this->Columns_ &&
                    dataset->GetRasterYSize() == this->Rows_;
  for (std::size_t b = 0; fits && b < bands; ++b) {
    GDALRasterBand* band = dataset->GetRasterBand(int(b) + 1);
    for (int row = 0; row < this->TileRows_; ++row) {
      for (int column = 0; column < this->TileColumns_; ++column) {
        const std::string item =
            "BLOCK_OFFSET_" + std::to_string(column) + "_" + std::to_string(row);
        const char* offset = band->GetMetadataItem(item.c_str(), "TIFF");
        if (!offset) {
          break;
        }
        this->Offsets_.push_back(std::strtoull(offset, nullptr, 10));
      }
    }
  }
  if (this->Offsets_.size() != bands * this->Done_.size()) {
    throw Error(Error::Kind::Corrupt, "file '" + this->Part_ + "'",
                "it is damaged or not the incomplete map; accepted: remove it and its .done file");
  }
}

bool TileFile::Has(int column, int row) const {
  return this->Done_[std::size_t(row) * std::size_t(this->TileColumns_) + std::size_t(column)] != 0;
}

void TileFile::Write(int column, int row, std::vector<float>& cells) {
  const std::size_t tile = std::size_t(row) * std::size_t(this->TileColumns_) + std::size_t(column);
  constexpr std::size_t Cells = std::size_t(Side) * Side;
  const std::size_t bands = this->Offsets_.size() / this->Done_.size();
  const int width = std::min(Side, this->Columns_ - column * Side);
  const int height = std::min(Side, this->Rows_ - row * Side);
  for (std::size_t b = 0; b < bands; ++b) {
    float* data = &cells[b * Cells];
    for (int r = 0; r < Side; ++r) {
      for (int c = r < height ? width : 0; c < Side; ++c) {
        data[r * Side + c] = std::numeric_limits<float>::quiet_NaN();
      }
    }
    const auto* bytes = reinterpret_cast<const char*>(data);
    std::size_t left = Cells * sizeof(float);
    auto offset = off_t(this->Offsets_[b * this->Done_.size() + tile]);
    while (left > 0) {
      const ssize_t written = ::pwrite(this->Files_->data, bytes, left, offset);
      if (written < 0 && errno != EINTR) {
        this->Fail(this->Part_, errno);
      }
      if (written > 0) {
        bytes += written;
        offset += written;
        left -= std::size_t(written);
      }
    }
  }
  if (::fdatasync(this->Files_->data) != 0) {
    this->Fail(this->Part_, errno);
  }
  const std::lock_guard<std::mutex> lock(this->Files_->mutex);
  const JournalEntry entry = {std::uint32_t(tile), ~std::uint32_t(tile)};
  if (::write(this->Files_->journal, &entry, sizeof(entry)) != ssize_t(sizeof(entry))) {
    this->Fail(this->Part_ + ".done", errno);
  }
  this->Done_[tile] = 1;
}

void TileFile::Finish() {
  if (std::count(this->Done_.begin(), this->Done_.end(), 0) > 0) {
    throw Error(Error::Kind::Internal, "file '" + this->Path_ + "'", "tiles are missing");
  }
  if (::fsync(this->Files_->data) != 0) {
    this->Fail(this->Part_, errno);
  }
  // link() never replaces a file.
  if (this->Replace_ || ::link(this->Part_.c_str(), this->Path_.c_str()) != 0) {
    if ((!this->Replace_ && errno == EEXIST) ||
        ::rename(this->Part_.c_str(), this->Path_.c_str()) != 0) {
      this->Fail(this->Path_, errno);
    }
  }
  ::unlink(this->Part_.c_str());
  ::unlink((this->Part_ + ".done").c_str());
}

std::map<std::string, std::string> TileFile::MetadataOf(const std::string& path) {
  std::map<std::string, std::string> found;
  GdalErrors errors;
  RegisterGdal();
  const char* const drivers[] = {"GTiff", nullptr};
  const Dataset dataset(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers));
  char** metadata = dataset ? dataset->GetMetadata() : nullptr;
  for (char** item = metadata; item && *item; ++item) {
    const std::string text = *item;
    const std::size_t equals = text.find('=');
    if (equals != std::string::npos) {
      found[text.substr(0, equals)] = text.substr(equals + 1);
    }
  }
  return found;
}

} // namespace dspace
