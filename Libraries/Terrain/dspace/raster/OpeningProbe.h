// Opening in a process apart what may take any amount of memory. Not for public headers.
#ifndef DSPACE_RASTER_OPENINGPROBE_H
#define DSPACE_RASTER_OPENINGPROBE_H

#include <gdal_priv.h>

namespace dspace {

// The libraries of netCDF and HDF5 allocate what a file's head states: 20 kB can ask for 4 GB. A
// file that drivers of these libraries identify is opened first by the program dspace-raster-probe,
// in the folder "dspace" beside this library, with Budget::OpenMemory bytes (Budgets.h) and within
// a minute. It takes about a tenth of a second. Throws Error, which names the file and the limit,
// where that fails: Corrupt with GDAL's message; Resource where it takes too long or ends the
// program; Internal where the program cannot be started. Of files of other formats it does nothing.
void ProbeOpening(GDALOpenInfo& info);

} // namespace dspace

#endif
