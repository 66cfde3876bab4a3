// Averaged overviews of one band in a file of Dspace's own, each tile with a checksum. Not for
// public headers.
#ifndef DSPACE_TERRAIN_OVERVIEWFILE_H
#define DSPACE_TERRAIN_OVERVIEWFILE_H

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <dspace/raster/ElevationSource.h>

namespace dspace {

// The index at the end of the file. Native byte order: a cache is its machine's own.
struct OverviewHeader {
  std::string identity; // ElevationSource::Identity() of what it was made from
  std::string path;     // of the same
  int width = 0;        // of the raster [pixels]
  int height = 0;
  int sampleBytes = 4; // floats, or 8: doubles
  int levels = 0;      // level l stands for 2^(l+1) x 2^(l+1) pixels
  struct Tile {
    std::uint64_t offset = 0;
    std::uint32_t bytes = 0;
    std::uint32_t checksum = 0;
  };
  std::vector<Tile> tiles; // level by level, row by row

  static constexpr int TileSize = 256; // cells a side; fewer at a level's right and bottom edge

  int ColumnsAt(int level) const { return 1 + ((this->width - 1) >> (level + 1)); }
  int RowsAt(int level) const { return 1 + ((this->height - 1) >> (level + 1)); }
  std::size_t TileIndex(int level, int tileColumn, int tileRow) const;
  std::size_t TileCount() const { return this->TileIndex(this->levels, 0, 0); }
};

// Open for reading, from any thread. Values are those of the band, before scale and offset; NaN
// where less than half of the pixels have data.
class OverviewFile {
public:
  // Throws Error: NotFound; Io; Corrupt where it is not such a file, or cut, or its index is
  // damaged. Tiles are checked as they are read.
  explicit OverviewFile(const std::string& file);
  ~OverviewFile();
  OverviewFile(const OverviewFile&) = delete;
  OverviewFile& operator=(const OverviewFile&) = delete;

  const OverviewHeader& Header() const { return this->Header_; }
  const std::string& Name() const { return this->Name_; }
  std::uint64_t Bytes() const { return this->Bytes_; }

  // Cells of a level, row by row. Throws Error(Corrupt) for a damaged tile, Io.
  void Read(int level, const RasterWindow& cells, double* values) const;
  void Verify() const; // every tile
  // Removes the file, unless another file has replaced it.
  void Remove() const;

private:
  std::vector<char> ReadAt(std::uint64_t offset, std::size_t bytes) const;
  std::vector<char> ReadTile(std::size_t index, std::size_t values) const;

  std::string Name_;
  int File_ = -1;
  std::uint64_t Bytes_ = 0;
  OverviewHeader Header_;
};

// CRC-32 as in zlib and PNG.
std::uint32_t Checksum(const char* data, std::size_t bytes);

// The file's beginning.
struct OverviewPreamble {
  char magic[8];
  std::uint64_t indexOffset;
  std::uint64_t indexBytes;
  std::uint32_t indexChecksum;
  std::uint32_t ownChecksum; // of the bytes before it
};
constexpr char OverviewMagic[9] = "DspOvr01";

} // namespace dspace

#endif
