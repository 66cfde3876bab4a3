#include <dspace/raster/OverviewFile.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <dspace/Error.h>

namespace dspace {
namespace {

constexpr int Tile = OverviewHeader::TileSize;

int TilesOf(int cells) {
  return (cells + Tile - 1) / Tile;
}

[[noreturn]] void Damaged(const std::string& name, const std::string& what) {
  throw Error(Error::Kind::Corrupt, "cached overviews '" + name + "'", what);
}

// Takes values off the front of an index.
class IndexReader {
public:
  IndexReader(const std::vector<char>& bytes, const std::string& name)
      : Bytes_(bytes), Name_(name) {}
  template<class Value> Value Take() {
    Value value;
    std::memcpy(&value, this->Take(sizeof(Value)), sizeof(Value));
    return value;
  }
  std::string Text() {
    const auto length = this->Take<std::uint32_t>();
    return {this->Take(length), length};
  }

private:
  const char* Take(std::size_t bytes) {
    if (bytes > this->Bytes_.size() - this->At_) {
      Damaged(this->Name_, "its index ends early");
    }
    this->At_ += bytes;
    return this->Bytes_.data() + this->At_ - bytes;
  }
  const std::vector<char>& Bytes_;
  const std::string& Name_;
  std::size_t At_ = 0;
};

} // namespace

std::uint32_t Checksum(const char* data, std::size_t bytes) {
  return std::uint32_t(::crc32_z(0, reinterpret_cast<const Bytef*>(data), bytes));
}

std::size_t OverviewHeader::TileIndex(int level, int tileColumn, int tileRow) const {
  std::size_t index = 0;
  for (int l = 0; l < level; ++l) {
    index += std::size_t(TilesOf(this->ColumnsAt(l))) * TilesOf(this->RowsAt(l));
  }
  return index + (tileRow == 0 ? 0 : std::size_t(tileRow) * TilesOf(this->ColumnsAt(level))) +
         tileColumn;
}

OverviewFile::OverviewFile(const std::string& file) : Name_(file) {
  this->File_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat state = {};
  if (this->File_ < 0 || ::fstat(this->File_, &state) != 0) {
    const int reason = errno;
    throw Error(reason == ENOENT ? Error::Kind::NotFound : Error::Kind::Io,
                "cached overviews '" + file + "'", std::strerror(reason));
  }
  this->Bytes_ = std::uint64_t(state.st_size);
  try {
    OverviewPreamble start;
    if (this->Bytes_ < sizeof(start)) {
      Damaged(file, "the file is cut");
    }
    std::memcpy(&start, this->ReadAt(0, sizeof(start)).data(), sizeof(start));
    if (std::memcmp(start.magic, OverviewMagic, 8) != 0) {
      Damaged(file, "it is not an overview file");
    }
    if (start.ownChecksum != Checksum(reinterpret_cast<const char*>(&start),
                                      offsetof(OverviewPreamble, ownChecksum)) ||
        start.indexBytes > this->Bytes_ || start.indexOffset != this->Bytes_ - start.indexBytes) {
      Damaged(file, "its beginning is damaged, or the file is cut");
    }
    const std::vector<char> index = this->ReadAt(start.indexOffset, start.indexBytes);
    if (Checksum(index.data(), index.size()) != start.indexChecksum) {
      Damaged(file, "its index is damaged");
    }
    IndexReader reader(index, file);
    OverviewHeader& header = this->Header_;
    header.identity = reader.Text();
    header.path = reader.Text();
    header.width = reader.Take<std::int32_t>();
    header.height = reader.Take<std::int32_t>();
    header.sampleBytes = reader.Take<std::int32_t>();
    header.levels = reader.Take<std::int32_t>();
    if (header.width < 1 || header.height < 1 || header.levels < 1 || header.levels > 30 ||
        (header.sampleBytes != 4 && header.sampleBytes != 8) || header.TileCount() > index.size()) {
      Damaged(file, "its index is inconsistent");
    }
    header.tiles.resize(header.TileCount());
    for (OverviewHeader::Tile& tile : header.tiles) {
      tile.offset = reader.Take<std::uint64_t>();
      tile.bytes = reader.Take<std::uint32_t>();
      tile.checksum = reader.Take<std::uint32_t>();
    }
  } catch (...) {
    ::close(this->File_);
    throw;
  }
}

OverviewFile::~OverviewFile() {
  ::close(this->File_);
}

std::vector<char> OverviewFile::ReadAt(std::uint64_t offset, std::size_t bytes) const {
  if (offset > this->Bytes_ || bytes > this->Bytes_ - offset) {
    Damaged(this->Name_, "it points beyond its end");
  }
  std::vector<char> data(bytes);
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t got =
        ::pread(this->File_, data.data() + done, bytes - done, off_t(offset + done));
    if (got < 0 && errno != EINTR) {
      throw Error(Error::Kind::Io, "cached overviews '" + this->Name_ + "'", std::strerror(errno));
    }
    if (got == 0) {
      Damaged(this->Name_, "the file has been cut");
    }
    done += got > 0 ? std::size_t(got) : 0;
  }
  return data;
}

// The bytes of a tile's values: first all lowest bytes, then all second ones, ... (they compress).
std::vector<char> OverviewFile::ReadTile(std::size_t index, std::size_t values) const {
  const OverviewHeader::Tile& tile = this->Header_.tiles[index];
  const std::vector<char> packed = this->ReadAt(tile.offset, tile.bytes);
  const std::size_t bytes = values * std::size_t(this->Header_.sampleBytes);
  std::vector<char> planes(bytes);
  std::size_t unpacked = 0;
  if (Checksum(packed.data(), packed.size()) != tile.checksum ||
      !CPLZLibInflate(packed.data(), packed.size(), planes.data(), bytes, &unpacked) ||
      unpacked != bytes) {
    Damaged(this->Name_, "tile " + std::to_string(index) + " is damaged");
  }
  return planes;
}

void OverviewFile::Read(int level, const RasterWindow& cells, double* values) const {
  const OverviewHeader& header = this->Header_;
  const int columns = header.ColumnsAt(level);
  const int rows = header.RowsAt(level);
  const auto sample = std::size_t(header.sampleBytes);
  for (int tr = cells.row / Tile; tr * Tile < cells.row + cells.height; ++tr) {
    for (int tc = cells.column / Tile; tc * Tile < cells.column + cells.width; ++tc) {
      const int width = std::min(Tile, columns - tc * Tile);
      const std::size_t count = std::size_t(width) * std::min(Tile, rows - tr * Tile);
      const std::vector<char> planes = this->ReadTile(header.TileIndex(level, tc, tr), count);
      const int right = std::min(cells.column + cells.width, (tc + 1) * Tile);
      const int bottom = std::min(cells.row + cells.height, (tr + 1) * Tile);
      for (int r = std::max(cells.row, tr * Tile); r < bottom; ++r) {
        for (int c = std::max(cells.column, tc * Tile); c < right; ++c) {
          const std::size_t at = std::size_t(r - tr * Tile) * width + (c - tc * Tile);
          char bytes[8];
          for (std::size_t b = 0; b < sample; ++b) {
            bytes[b] = planes[b * count + at];
          }
          double& value = values[std::size_t(r - cells.row) * cells.width + (c - cells.column)];
          if (sample == 4) {
            float single;
            std::memcpy(&single, bytes, 4);
            value = single;
          } else {
            std::memcpy(&value, bytes, 8);
          }
        }
      }
    }
  }
}

void OverviewFile::Verify() const {
  for (int l = 0; l < this->Header_.levels; ++l) {
    const int columns = this->Header_.ColumnsAt(l);
    const int rows = this->Header_.RowsAt(l);
    for (int tr = 0; tr < TilesOf(rows); ++tr) {
      for (int tc = 0; tc < TilesOf(columns); ++tc) {
        this->ReadTile(this->Header_.TileIndex(l, tc, tr),
                       std::size_t(std::min(Tile, columns - tc * Tile)) *
                           std::min(Tile, rows - tr * Tile));
      }
    }
  }
}

void OverviewFile::Remove() const {
  struct stat own = {};
  struct stat named = {};
  if (::fstat(this->File_, &own) == 0 && ::stat(this->Name_.c_str(), &named) == 0 &&
      own.st_ino == named.st_ino && own.st_dev == named.st_dev) {
    ::unlink(this->Name_.c_str());
  }
}

} // namespace dspace
