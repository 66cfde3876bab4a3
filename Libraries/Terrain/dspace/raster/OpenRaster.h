// Opens rasters with GDAL and inspects properties that GDAL does not report. Not for public
// headers.
#ifndef DSPACE_TERRAIN_OPENRASTER_H
#define DSPACE_TERRAIN_OPENRASTER_H

#include <cstdint>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <sys/stat.h>

#include <dspace/raster/ElevationSource.h>

#include <dspace/gdal/GdalErrors.h>
#include <dspace/raster/DatasetGate.h>

namespace dspace {

// Throws what ElevationSource's constructor says, naming `object`; "raster 'path'" where it is
// empty; and what OpenDataset throws.
DatasetPointer OpenRaster(const std::string& path, const NetworkLimits& limits,
                          std::vector<std::string>& warnings, std::string object = {});

// State of a local file at the time of opening; empty for any other name.
struct FileState {
  bool local = false;
  struct stat state = {};

  static FileState Of(const std::string& path);
  // A file that is changed in place gives a mixture of old and new content. A file that was
  // replaced or removed by name is still read completely.
  bool ChangedInPlace(const std::string& path) const;
};

// Whether it is a mosaic with a file on a server.
bool IsRemoteMosaic(GDALDataset& dataset);

// The files that it consists of, a line each, with size and time of change.
std::string FilesOf(GDALDataset& dataset);

// Whether GDAL gives zeros for what the file leaves out (blocks of a sparse or unfinished TIFF,
// gaps of a mosaic), since it has neither a no-data value nor a mask.
bool GivesZerosForGaps(GDALRasterBand& band);

// Whether there are such parts.
bool LeavesBlocksOut(GDALRasterBand& band, const RasterWindow& part);

// No data, in a mask of `columns` x `rows` that was read of `part`, where a pixel is left out.
void MaskGaps(GDALRasterBand& band, const RasterWindow& part, int columns, int rows, int stride,
              std::uint8_t* mask);

} // namespace dspace

#endif
