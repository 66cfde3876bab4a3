// Determines the CRS of a vector file. Not for public headers.
#ifndef DSPACE_LAYERS_VECTORCRS_H
#define DSPACE_LAYERS_VECTORCRS_H

#include <string>
#include <vector>

#include <dspace/layers/vector/VectorLayer.h>

class GDALDataset;
class OGRLayer;

namespace dspace {

// The option's; else the file's; else the terrain's, with a warning. GeoJSON that states none is
// in longitude and latitude: of the terrain's body where that is not the Earth, which its
// specification takes for granted.
Crs VectorCrsOf(OGRLayer& layer, GDALDataset& file, const std::string& path,
                const RasterPlace& terrain, const VectorLayerOptions& options,
                std::vector<std::string>& warnings);

} // namespace dspace

#endif
