// The only way to open a raster or a vector file in Dspace. Not for public headers.
//
// All code that needs a GDAL dataset of an existing file calls OpenDataset; none calls GDALOpen,
// GDALOpenEx or GDALDataset::Open.
#ifndef DSPACE_RASTER_DATASETGATE_H
#define DSPACE_RASTER_DATASETGATE_H

#include <cstdint>
#include <memory>
#include <string>

#include <gdal_priv.h>

#include <dspace/gdal/GdalErrors.h>

namespace dspace {

struct CloseDataset {
  void operator()(GDALDataset* dataset) const {
    const GdalErrors quiet;
    GDALClose(dataset);
  }
};
using DatasetPointer = std::unique_ptr<GDALDataset, CloseDataset>;

enum class DatasetKind : std::uint8_t { Raster, Shapes, Any };

// Opens a dataset for reading; `path` as GDAL names it. `drivers` (names, ending with a null
// pointer) restricts the formats. Returns null where GDAL does not open it; GDAL's messages are in
// the GdalErrors of the caller.
//
// Without a FilesGuard in this thread GDAL opens what it can, netCDF and HDF5 after a trial in a
// process apart (OpeningProbe.h). With one:
// - The name must be that of a plain file or folder, of a file within an archive (/vsizip/,
//   /vsitar/, /vsigzip/), or of a file on a server; the guard checks it.
//   Documents in the place of a name, and names with a driver's prefix, are rejected.
// - Only SelfContainedDrivers open it, or VRT for a mosaic whose sources (MosaicSources) pass the
//   same checks first, each of them opened once, and whose documents name a limited number of files
//   in all (Budget::MosaicFiles).
// - A dataset that names its overviews itself (OVERVIEW_FILE in the domain OVERVIEWS of its
//   metadata) is rejected.
// - The guard checks every file that belongs to the dataset, with links resolved. Links beside the
//   file whose names begin as its own are checked before it is opened.
// - Datasets that GDAL opens by itself during the call, or later in a thread with a guard
//   (overviews, masks, sources), pass the same checks. One that fails them makes the whole opening
//   fail.
//
// Throws Error(Resource) for a raster of more pixels than Budget::RasterPixels, or with a block
// larger than Budget::BlockBytes (Budgets.h), before anything of it is read; under a guard also for
// a mosaic of too many files. Throws Error under a guard: what the guard throws; NotFound;
// InvalidArgument (a name that is rejected, see above); Unsupported (none of the accepted formats).
// Each names the file.
DatasetPointer OpenDataset(const std::string& path, DatasetKind kind,
                           const char* const* drivers = nullptr);

// A GeoTIFF that Dspace itself has written, in a cache folder or in memory, by a name that no file
// and no command gives. The guard does not look at its name; it looks at what GDAL opens beside it.
DatasetPointer OpenOwnTiff(const std::string& path);

// For messages: the formats that OpenDataset accepts in this thread.
std::string AcceptedFormats(DatasetKind kind);

// The checks reach the datasets that GDAL opens by itself through a driver of this name, which
// OpenDataset puts before all others. It looks at each name and, in a thread without a FilesGuard,
// leaves it to the other drivers.
inline const char* const DatasetGateName = "DspaceGate";

} // namespace dspace

#endif
