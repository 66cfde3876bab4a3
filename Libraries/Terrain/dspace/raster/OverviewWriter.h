// Writes averaged overviews of one band, gathered in one pass over the raster. Not for public
// headers.
#ifndef DSPACE_TERRAIN_OVERVIEWWRITER_H
#define DSPACE_TERRAIN_OVERVIEWWRITER_H

#include <functional>
#include <string>

#include <dspace/raster/ElevationSource.h>

namespace dspace {

class AtomicFile;

// Writes the overviews of `source`'s values, read from its first row to its last, into `output`,
// which is empty; the caller commits it. Every cell is the mean of its pixels, however coarse.
// Returns false if `progress`, called with the part done, returned false. Throws what the source
// and the output throw.
bool WriteOverviews(const ElevationSource& source, const std::string& identity, AtomicFile& output,
                    const std::function<bool(double)>& progress);

} // namespace dspace

#endif
