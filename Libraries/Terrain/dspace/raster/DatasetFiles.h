// Which files a raster or a file of shapes consists of, as GDAL knows them.
#ifndef DSPACE_TERRAIN_DATASETFILES_H
#define DSPACE_TERRAIN_DATASETFILES_H

#include <string>
#include <vector>

class GDALDataset;

namespace dspace {

// Tells FilesReadScope of them: headers, side files and overviews, a mosaic's sources. Files on a
// server are told by their name, those in an archive as the archive. A source's own side files and
// sources are not looked for here (MosaicFiles does), since a mosaic may have thousands.
void NoteDataset(GDALDataset& dataset);

// All files below a mosaic (a VRT), with what belongs to each; empty for any other file and for one
// that GDAL does not open. Reads every source's head.
std::vector<std::string> MosaicFiles(const std::string& path);

} // namespace dspace

#endif
