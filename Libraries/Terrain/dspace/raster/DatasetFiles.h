// The files of a raster or vector dataset, as GDAL lists them.
#ifndef DSPACE_TERRAIN_DATASETFILES_H
#define DSPACE_TERRAIN_DATASETFILES_H

#include <string>
#include <vector>

class GDALDataset;

namespace dspace {

// Notes the files of a dataset (NoteFileRead): headers, side files, overviews, and the sources of a
// mosaic. A file on a server is noted by its name, a file in an archive as the archive. Side files
// and sources of the sources are not searched (MosaicFiles does that), because a mosaic may have
// thousands.
void NoteDataset(GDALDataset& dataset);

// Returns all files below a mosaic (VRT), with their side files; empty for any other file and for
// one that GDAL does not open. Reads the header of every source.
std::vector<std::string> MosaicFiles(const std::string& path);

} // namespace dspace

#endif
