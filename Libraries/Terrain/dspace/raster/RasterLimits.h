// What opening one raster may cost. Not for public headers.
#ifndef DSPACE_RASTER_RASTERLIMITS_H
#define DSPACE_RASTER_RASTERLIMITS_H

#include <cstdint>

namespace dspace {

// The environment variable of the same name raises or lowers a limit: an integer above 0; any other
// value is ignored.
struct RasterLimit {
  const char* variable;
  std::uint64_t otherwise;

  std::uint64_t Value() const;
};

// Files that a mosaic (VRT) makes GDAL open in all, each as often as it is named: its sources, the
// sources of these, and so on.
inline constexpr RasterLimit MosaicFileLimit = {"DSPACE_MAX_MOSAIC_FILES", 20000};

// Bytes of the document of one mosaic.
inline constexpr RasterLimit MosaicByteLimit = {"DSPACE_MAX_MOSAIC_BYTES", 64 << 20};

// Columns times rows. A raster of 1 m of the whole Earth has 8e14.
inline constexpr RasterLimit PixelLimit = {"DSPACE_MAX_RASTER_PIXELS", std::uint64_t(1) << 50};

} // namespace dspace

#endif
