// Overviews of colour layers in a cache folder: a TIFF a level. Not for public headers.
#ifndef DSPACE_TERRAIN_CACHEDLAYERS_H
#define DSPACE_TERRAIN_CACHEDLAYERS_H

#include <string>
#include <vector>

#include <dspace/raster/ElevationCache.h>

namespace dspace {

// A metadata item of such files: the raster's path.
inline const char* const LayerPathItem = "DSPACE_PATH";

// By its name: HASH-layer-N.tif.
bool IsLayerFile(const std::string& file);
// Groups `files` into one entry per raster and band.
std::vector<ElevationCacheEntry> LayerEntries(const std::vector<std::string>& files);
// Reads all pixels. Throws Error(Corrupt) naming the file.
void VerifyLayerFile(const std::string& file);

} // namespace dspace

#endif
