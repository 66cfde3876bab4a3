// The content of a raster: its size, value type, colour table, place and resolutions. Not for
// public headers.
#ifndef DSPACE_LAYERS_RASTERCONTENT_H
#define DSPACE_LAYERS_RASTERCONTENT_H

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/crs/Crs.h>
#include <dspace/raster/OpenRaster.h>

namespace dspace {

// How a band is shown: its values, opaque where there is data; or 0, opaque where there is none. Or
// how a raster is: three bands as the numbers of a vector, opaque where there is data.
enum class RasterShown : std::uint8_t { Data, Holes, Vectors };

// Cells of a raster whose columns are reduced by 2^levelX and rows by 2^levelY: there are
// ceil(width / 2^levelX) of them side by side, all of one size, which together cover the raster.
struct LevelWindow {
  int levelX = 0;
  int levelY = 0;
  int column = 0; // of the first cell
  int row = 0;
  int width = 0; // cells
  int height = 0;
};

// One resolution of a raster.
struct RasterLevel {
  int width = 0;
  int height = 0;
  std::vector<GDALRasterBand*> colors;
  GDALRasterBand* alpha = nullptr;
  std::vector<GDALRasterBand*> masks; // opaque where any of them is
  bool gaps = false;                  // see GivesZerosForGaps
  bool cached = false;                // from RasterOverviews: already scaled
};

// An open raster for one thread.
struct RasterHandle {
  DatasetPointer file;
  std::vector<DatasetPointer> overviews; // from RasterOverviews
  std::vector<RasterLevel> levels;       // the raster itself first, then coarser and coarser
};

// Describes one band of a raster, or a raster as an image.
struct RasterContent {
  int band = 0; // from 1; 0: the raster is an image, or vectors
  bool vectors = false;
  int width = 0;
  int height = 0;
  int bands = 0; // of the file
  GDALDataType type = GDT_Byte;
  int channels = 1; // 3: RGB or a vector; 1: grey or values
  bool alpha = false;
  std::vector<std::array<float, 4>> palette; // r g b 0 to 255, opacity 0 to 1
  double scale = 1.0;
  double offset = 0.0;
  double alphaScale = 1.0;
  std::string unit;

  // The file's georeference.
  struct Georeference {
    Crs crs;
    bool placed = false;
    Eigen::Affine2d pixelToMap = Eigen::Affine2d::Identity();
  };
  Georeference place;

  // Reads the header. Appends to `warnings`. Throws Error(Unsupported, InvalidArgument, Corrupt)
  // that names `object`.
  static RasterContent Of(GDALDataset& file, int band, RasterShown shown, const std::string& object,
                          std::vector<std::string>& warnings);

  // Whether `file` still has this size, number of bands and type.
  bool Matches(GDALDataset& file) const;
  // The full resolution and the file's overviews. An overview counts only if every band and the
  // mask have it.
  std::vector<RasterLevel> LevelsOf(GDALDataset& file) const;

  // Size in cells of 2^level pixels.
  int ColumnsAt(int level) const { return int(1 + ((std::int64_t(this->width) - 1) >> level)); }
  int RowsAt(int level) const { return int(1 + ((std::int64_t(this->height) - 1) >> level)); }

private:
  void InspectImage(GDALDataset& file, const std::string& object,
                    std::vector<std::string>& warnings);
  void InspectBand(GDALRasterBand& first, const std::string& object);
  void InspectVectors(GDALDataset& file, const std::string& object);
};

} // namespace dspace

#endif
