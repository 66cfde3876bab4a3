// Restricts GDAL in a process that opens only untrusted files.
#ifndef DSPACE_RASTER_CONFINEDDRIVERS_H
#define DSPACE_RASTER_CONFINEDDRIVERS_H

namespace dspace {

// Removes the open functions of all GDAL drivers except those that read a file by itself (GeoTIFF,
// PNG, JPEG, GeoPackage, shapefiles, ISIS and others: SelfContainedDrivers.cxx) and the mosaic
// driver (VRT). Formats that refer to other files, servers or databases can then not be opened: not
// by Dspace, not by GDAL itself (overviews, masks, sources), and not by other code of the process.
// GDAL's drivers are global: the restriction lasts until the process ends, also after the object is
// destroyed. (A deregistered driver would come back with the next GDALAllRegister, which `import
// osgeo.gdal` calls.)
//
// A server and `dspace play` create one at the start. A Playback within a user's program does not:
// there the FilesGuard of its commands restricts each opening (DatasetGate.h), and other rasters of
// the program are unaffected.
class ConfinedDrivers {
public:
  // withoutNamesOnly: also without those that take the name of another file from a file (mosaics,
  // labels apart from their data), where the system does not restrict the files of the process.
  explicit ConfinedDrivers(bool withoutNamesOnly = false);
  ConfinedDrivers(const ConfinedDrivers&) = delete;
  ConfinedDrivers& operator=(const ConfinedDrivers&) = delete;
};

} // namespace dspace

#endif
