// A GeoTIFF that is written tile by tile in any order, may be larger than memory, and is continued
// after a kill.
#ifndef DSPACE_MAPS_TILE_FILE_H
#define DSPACE_MAPS_TILE_FILE_H

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/crs/Crs.h>

namespace dspace {

struct TileFileLayout {
  int columns = 0; // cells
  int rows = 0;
  Eigen::Affine2d cellToMap = Eigen::Affine2d::Identity();
  Crs crs;
  std::vector<std::string> bands;              // their descriptions
  std::map<std::string, std::string> metadata; // of the dataset
  std::uint64_t hash = 0;                      // of the inputs
};

// 32-bit floats without compression, NaN for no data. All tiles have their places from the
// beginning, so that the file does not depend on the order of writing. Until Finish() the file is
// "PATH.part", and "PATH.part.done" lists the tiles that it has; both stay when this is destroyed,
// and the next TileFile of the same path and hash continues. One tile holds Side x Side cells of
// every band. Any thread may call Write().
//
// A process that is killed loses the tiles under way only. Every method throws Error(Io) for what
// the system reports.
class TileFile {
public:
  static constexpr int Side = 64; // cells

  // The bytes of the file.
  static std::uint64_t BytesOf(const TileFileLayout& layout);

  // Creates the file or continues it. Throws Error: AlreadyExists if `path` exists, if the partial
  // file belongs to other inputs, or if another TileFile of any process writes it; Resource, before
  // anything is written, if the file would not fit the disk; what AtomicFile::Check throws.
  // `replace`: Finish() replaces a file, which stays until then; a partial one of other inputs is
  // removed first.
  TileFile(const std::string& path, const TileFileLayout& layout, bool replace = false);
  ~TileFile();
  TileFile(const TileFile&) = delete;
  TileFile& operator=(const TileFile&) = delete;

  int TileColumns() const { return this->TileColumns_; }
  int TileRows() const { return this->TileRows_; }
  bool Has(int column, int row) const;
  // `cells`: band after band, Side x Side of each, row by row; what lies outside the map is
  // ignored.
  void Write(int column, int row, std::vector<float>& cells);
  // Once, when it has all tiles: the file gets its name.
  void Finish();

  // Metadata of a file of any path that GDAL opens as a GeoTIFF; empty where it is none.
  static std::map<std::string, std::string> MetadataOf(const std::string& path);

private:
  // Opens and locks the journal; false where it cannot be opened.
  bool OpenJournal(const std::string& journal, int flags);
  void Create(const TileFileLayout& layout);
  void FindOffsets(std::size_t bands);
  [[noreturn]] void Fail(const std::string& path, int reason) const;

  struct Files;
  std::string Path_;
  std::string Part_;
  bool Replace_ = false;
  int Columns_ = 0;
  int Rows_ = 0;
  int TileColumns_ = 0;
  int TileRows_ = 0;
  std::vector<std::uint64_t> Offsets_; // of every band's tiles, row by row
  std::vector<char> Done_;
  std::unique_ptr<Files> Files_;
};

} // namespace dspace

#endif
