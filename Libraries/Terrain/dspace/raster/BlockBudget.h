// Rejects rasters whose blocks are too large to decode. Not for public headers.
#ifndef DSPACE_RASTER_BLOCKBUDGET_H
#define DSPACE_RASTER_BLOCKBUDGET_H

#include <string>

#include <gdal_priv.h>

namespace dspace {

// GDAL decodes whole blocks (tiles, strips), and a small compressed file may state a huge one.
// Throws Error(Resource) naming the file and the block if one of a band, or of an overview in the
// file, has more bytes than Budget::BlockBytes (Budgets.h). Bands whose pixels lie together are
// decoded together and count as one block. Reads no pixels.
void RequireBlockBytes(GDALDataset& dataset, const std::string& path);

} // namespace dspace

#endif
