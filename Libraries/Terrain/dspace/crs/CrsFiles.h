// Files that a coordinate reference system (CRS) names: grids of shifts, geoids, files of
// definitions. PROJ opens them while it reads the CRS.
#pragma once

#include <string>

class OGRSpatialReference;

namespace dspace {

// Whether a CRS text as Crs::FromText accepts it names a file: by itself, as a grid or a parameter
// file in WKT or PROJ, as PROJ within WKT 1, or as a definition in a file (init=).
bool CrsNamesFile(const std::string& text);
// The same of one that GDAL has read; "+nadgrids=@null" is no file.
bool CrsNamesFile(const OGRSpatialReference& srs);

// The words by which a document that holds a CRS names such a file, "" without one. The document
// may be JSON or XML, with escaped characters; `text` is all of it or a part.
std::string CrsFileWordIn(const std::string& text);

} // namespace dspace
