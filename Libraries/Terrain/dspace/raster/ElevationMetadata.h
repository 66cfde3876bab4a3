// Reads a raster's own statements about place, height and datum. Not a public header.
#ifndef DSPACE_TERRAIN_ELEVATIONMETADATA_H
#define DSPACE_TERRAIN_ELEVATIONMETADATA_H

#include <dspace/raster/ElevationSource.h>

class GDALDataset;
class GDALRasterBand;

namespace dspace {

// Metres a unit; accepts the usual spellings of metre, kilometre, centimetre, decimetre, foot and
// US survey foot. 0 when it is not known.
double MetresOfUnit(const std::string& unit);

// Fills window, crs, pixelToMap and georeferenced of `info`.
void ReadGeoreference(GDALDataset& dataset, const ElevationOptions& options, ElevationInfo& info);

// Fills verticalScale, verticalOffset, unit and verticalDatum; needs the georeference.
void ReadVertical(GDALRasterBand& band, const ElevationOptions& options, ElevationInfo& info);

} // namespace dspace

#endif
