// Prevents network access while a local file is read. Not for public headers.
#ifndef DSPACE_TERRAIN_OFFLINESCOPE_H
#define DSPACE_TERRAIN_OFFLINESCOPE_H

#include <string>

class OGRSpatialReference;

namespace dspace {

// While it lives, GDAL fetches nothing for this thread that a file names by URL (GeoJSON's "crs" of
// type "link" or "url"): such a fetch fails. Files that are opened as "/vsicurl/..." or of a cloud
// are no such fetches, and are not touched.
class OfflineScope {
public:
  OfflineScope();
  ~OfflineScope();
  OfflineScope(const OfflineScope&) = delete;
  OfflineScope& operator=(const OfflineScope&) = delete;
};

// Parses a CRS text as Crs::FromText accepts it; GDAL would also read a file of that name, or ask a
// server for it. False where it is not understood.
bool ReadCrsText(const std::string& text, OGRSpatialReference& srs);

} // namespace dspace

#endif
