// How many files a mosaic (a VRT document) makes GDAL open. Not for public headers.
#ifndef DSPACE_RASTER_MOSAICCOUNT_H
#define DSPACE_RASTER_MOSAICCOUNT_H

#include <string>

namespace dspace {

bool IsMosaic(const std::string& path);

// Rejects mosaics of mosaics that would take too long: only the documents are read, each once,
// before any source is opened. Sources that are not mosaics, or are on a server, count as one file.
//
// Throws what MosaicSources throws, Error(InvalidArgument) for a mosaic that is among its own
// sources or behind a chain of more than 16 mosaics, and Error(Resource) where there are more files
// than Budget::MosaicFiles (Budgets.h).
void CheckMosaicSize(const std::string& path);

} // namespace dspace

#endif
