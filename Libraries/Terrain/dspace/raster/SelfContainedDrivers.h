// GDAL's drivers that are safe for untrusted files. Not for public headers.
#ifndef DSPACE_RASTER_SELFCONTAINEDDRIVERS_H
#define DSPACE_RASTER_SELFCONTAINEDDRIVERS_H

#include <string>

namespace dspace {

// Names, ending with a null pointer, as GDAL takes them. Each driver opens no other dataset by a
// name that a file gives without asking GDAL's driver manager (where DatasetGate looks at it),
// writes nothing when it reads, asks no server, and lists every file that it reads by a name from a
// header. The mosaic driver (VRT) is not among them: DatasetGate checks its sources first.
const char* const* SelfContainedDrivers();

bool IsSelfContained(const std::string& driver);

// Whether mosaics (VRT) may be opened, after their sources have been checked.
bool AreMosaicsAccepted();

// From now on the functions above know only the drivers that take no name of another file from a
// file, for a process whose files the system does not restrict.
void AcceptFilesWithoutNamesOnly();

} // namespace dspace

#endif
