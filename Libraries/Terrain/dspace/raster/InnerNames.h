// Names of other files within a raster or a file of shapes that GDAL follows while it opens the
// file, before it tells of them.
#pragma once

#include <string>

namespace dspace {

// Checks with this thread's FilesGuard what the labels of PDS 3 and ISIS 3 files name (^IMAGE,
// ^Core, ...), and rejects documents of text (GeoJSON, XML, GeoPackage) and the .aux.xml, .prj,
// .qpj and .hdr files beside a file whose coordinate systems name files (CrsFiles.h). `path` may
// lie in an archive (/vsizip/); of a folder, its .prj files are read. Throws
// Error(InvalidArgument), and what the guard throws.
void CheckInnerNames(const std::string& path);

} // namespace dspace
