// The file on disk that a GDAL name refers to. Not for public headers.
#ifndef DSPACE_RASTER_UNDERLYINGFILE_H
#define DSPACE_RASTER_UNDERLYINGFILE_H

#include <string>

namespace dspace {

// "/vsizip//a/b.zip/c.tif" lies in "/a/b.zip", "/vsisubfile/0_100,/a/b" in "/a/b". A name on a
// server, and one without a file on disk, is returned unchanged.
std::string UnderlyingFile(const std::string& name);

} // namespace dspace

#endif
