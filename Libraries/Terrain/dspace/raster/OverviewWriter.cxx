#include <dspace/raster/OverviewWriter.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

#include <cpl_conv.h>
#include <cpl_vsi.h>

#include <dspace/AtomicFile.h>
#include <dspace/Error.h>

#include <dspace/raster/OverviewFile.h>

namespace dspace {
namespace {

constexpr int TileSide = OverviewHeader::TileSize;

// One level: the cells of the row under way, and the finished rows of the tiles under way.
struct Level {
  int columns = 0;
  std::vector<double> sums;
  std::vector<std::uint64_t> counts; // of pixels with data
  int rowsIn = 0;                    // of the level before
  std::vector<double> finished;
  int rowsFinished = 0; // in all
};

class Gatherer {
public:
  Gatherer(OverviewHeader& header, AtomicFile& output) : Header_(header), Output_(output) {
    header.tiles.resize(header.TileCount());
    this->Levels_.resize(header.levels);
    for (int l = 0; l < header.levels; ++l) {
      Level& level = this->Levels_[l];
      level.columns = header.ColumnsAt(l);
      level.sums.assign(level.columns, 0.0);
      level.counts.assign(level.columns, 0);
    }
  }

  void Row(const double* heights, bool last) {
    std::vector<double> sums(heights, heights + this->Header_.width);
    std::vector<std::uint64_t> counts(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
      counts[i] = !std::isnan(sums[i]);
      sums[i] = counts[i] ? sums[i] : 0.0;
    }
    ++this->PixelRows_;
    for (int l = 0; l < this->Header_.levels; ++l) {
      Level& level = this->Levels_[l];
      for (std::size_t i = 0; i < sums.size(); ++i) {
        level.sums[i / 2] += sums[i];
        level.counts[i / 2] += counts[i];
      }
      if (++level.rowsIn < 2 && !last) {
        return;
      }
      sums = level.sums;
      counts = level.counts;
      this->Finish(l, last);
    }
  }

private:
  // A row of level l is complete.
  void Finish(int l, bool last) {
    Level& level = this->Levels_[l];
    const int factor = 1 << (l + 1);
    // The last row and column stand for what is left of the raster.
    const std::int64_t rows = std::min<std::int64_t>(
        factor, this->PixelRows_ - std::int64_t(level.rowsFinished) * factor);
    for (int c = 0; c < level.columns; ++c) {
      const std::int64_t columns =
          std::min<std::int64_t>(factor, this->Header_.width - std::int64_t(c) * factor);
      const std::uint64_t count = level.counts[c];
      level.finished.push_back(2 * count >= std::uint64_t(rows * columns)
                                   ? level.sums[c] / double(count)
                                   : std::numeric_limits<double>::quiet_NaN());
    }
    std::fill(level.sums.begin(), level.sums.end(), 0.0);
    std::fill(level.counts.begin(), level.counts.end(), 0);
    level.rowsIn = 0;
    ++level.rowsFinished;
    if (level.rowsFinished % TileSide == 0 || last) {
      this->WriteTiles(l);
    }
  }

  void WriteTiles(int l) {
    Level& level = this->Levels_[l];
    const int rows = int(level.finished.size() / std::size_t(level.columns));
    const int tileRow = (level.rowsFinished - 1) / TileSide;
    const auto sample = std::size_t(this->Header_.sampleBytes);
    for (int left = 0; left < level.columns; left += TileSide) {
      const int width = std::min(TileSide, level.columns - left);
      const std::size_t count = std::size_t(width) * rows;
      std::vector<char> planes(count * sample);
      for (std::size_t i = 0; i < count; ++i) {
        const double value = level.finished[i / width * level.columns + left + i % width];
        const auto single = float(value);
        char bytes[8];
        std::memcpy(bytes, sample == 4 ? static_cast<const void*>(&single) : &value, sample);
        for (std::size_t b = 0; b < sample; ++b) {
          planes[b * count + i] = bytes[b];
        }
      }
      std::vector<char> packed(planes.size() + planes.size() / 8 + 1024);
      std::size_t bytes = 0;
      if (!CPLZLibDeflate(planes.data(), planes.size(), 1, packed.data(), packed.size(), &bytes)) {
        throw Error(Error::Kind::Internal, "overviews", "a tile cannot be compressed");
      }
      OverviewHeader::Tile& tile =
          this->Header_.tiles[this->Header_.TileIndex(l, left / TileSide, tileRow)];
      tile = {this->Output_.Bytes(), std::uint32_t(bytes), Checksum(packed.data(), bytes)};
      this->Output_.Write(packed.data(), bytes);
    }
    level.finished.clear();
  }

  OverviewHeader& Header_;
  AtomicFile& Output_;
  std::vector<Level> Levels_;
  std::int64_t PixelRows_ = 0;
};

std::string IndexOf(const OverviewHeader& header) {
  std::string index;
  const auto put = [&](const auto& value) {
    index.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  for (const std::string& text : {header.identity, header.path}) {
    put(std::uint32_t(text.size()));
    index += text;
  }
  for (const int value : {header.width, header.height, header.sampleBytes, header.levels}) {
    put(std::int32_t(value));
  }
  for (const OverviewHeader::Tile& tile : header.tiles) {
    put(tile.offset);
    put(tile.bytes);
    put(tile.checksum);
  }
  return index;
}

} // namespace

bool WriteOverviews(const ElevationSource& source, const std::string& identity, AtomicFile& output,
                    const std::function<bool(double)>& progress) {
  const ElevationInfo& info = source.Info();
  OverviewHeader header;
  header.identity = identity;
  header.path = info.path;
  header.width = info.window.width;
  header.height = info.window.height;
  const bool fine = info.dataType == "Float64" || info.dataType == "Int32" ||
                    info.dataType == "UInt32" || info.dataType == "Int64" ||
                    info.dataType == "UInt64";
  header.sampleBytes = fine ? 8 : 4;
  do { // until one tile holds a level
    ++header.levels;
  } while (std::max(header.ColumnsAt(header.levels - 1), header.RowsAt(header.levels - 1)) >
           TileSide);

  OverviewPreamble start = {};
  output.Write(&start, sizeof(start));
  Gatherer gatherer(header, output);
  const int most = int(std::clamp<std::int64_t>((std::int64_t(1) << 22) / header.width, 1, 256));
  for (int row = 0; row < header.height; row += most) {
    if (progress && !progress(double(row) / header.height)) {
      return false;
    }
    const int rows = std::min(most, header.height - row);
    const std::vector<double> heights = source.Read({0, row, header.width, rows});
    for (int r = 0; r < rows; ++r) {
      gatherer.Row(heights.data() + std::size_t(r) * header.width, row + r + 1 == header.height);
    }
  }
  const std::string index = IndexOf(header);
  std::memcpy(start.magic, OverviewMagic, 8);
  start.indexOffset = output.Bytes();
  start.indexBytes = index.size();
  start.indexChecksum = Checksum(index.data(), index.size());
  start.ownChecksum =
      Checksum(reinterpret_cast<const char*>(&start), offsetof(OverviewPreamble, ownChecksum));
  output.Write(index.data(), index.size());
  output.WriteAt(0, &start, sizeof(start));
  return true;
}

} // namespace dspace
