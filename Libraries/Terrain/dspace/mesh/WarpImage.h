// An image file, warped to the raster of a terrain.
#ifndef DSPACE_TERRAIN_WARPIMAGE_H
#define DSPACE_TERRAIN_WARPIMAGE_H

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <dspace/mesh/DrapeImage.h>

namespace dspace {

// An image file, and values that replace or complete its georeference.
struct DrapeSource {
  std::string path;
  std::optional<std::string> crs; // replaces the file's; the terrain's where the file has none
  // Map x, y of the outer corners of its top-left and bottom-right pixels, in its CRS; replaces the
  // file's geotransform. A file without either is stretched over the terrain's raster.
  std::optional<std::array<double, 4>> extent; // left, top, right, bottom
};

struct WarpOptions {
  int maximumSize = 4096; // pixels along the longer side; fewer where the image has fewer there
  std::array<std::uint8_t, 3> background = {90, 90, 90}; // where the image has no data
};

// Reads `source` (1 band: grey or with a colour table; 2: grey and alpha; 3: RGB; 4: RGBA) and
// converts it to the terrain's CRS with GDAL's warper, in memory. The kernel is bilinear; where the
// image is finer than the result, it is the mean of the pixels. A plate carrée image that goes once
// around a body fits a grid whose left edge is elsewhere. Throws Error naming the file: NotFound,
// Corrupt, Unsupported (bands; a CRS of another body), InvalidArgument (extent, no overlap with the
// terrain).
DrapeImage WarpImage(const RasterPlace& place, const DrapeSource& source,
                     const WarpOptions& options = {});

} // namespace dspace

#endif
