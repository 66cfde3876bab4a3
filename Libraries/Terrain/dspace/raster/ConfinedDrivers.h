// A process that opens files of strangers only.
#ifndef DSPACE_RASTER_CONFINEDDRIVERS_H
#define DSPACE_RASTER_CONFINEDDRIVERS_H

namespace dspace {

// Takes the open functions away from all of GDAL's drivers but those that read a file by itself
// (GeoTIFF, PNG, JPEG, GeoPackage, shapefiles, ISIS and others: SelfContainedDrivers.cxx) and the
// mosaic driver (VRT): formats that refer to other files, to servers or to databases can no longer
// be opened, neither by Dspace nor by GDAL itself (overviews, masks, sources) nor by other code of
// the process. GDAL's drivers belong to the whole process: this lasts for the rest of its life,
// also after the object is gone. (A driver that is only deregistered would come back with the next
// GDALAllRegister, which `import osgeo.gdal` calls.)
//
// A server makes one when it starts, and so does `dspace play`. A Playback within a program of the
// user's makes none: there the FilesGuard under which it carries out commands restricts each
// opening by itself (DatasetGate.h), and other rasters of the program stay as they are.
class ConfinedDrivers {
public:
  ConfinedDrivers();
  ConfinedDrivers(const ConfinedDrivers&) = delete;
  ConfinedDrivers& operator=(const ConfinedDrivers&) = delete;
};

} // namespace dspace

#endif
