// The files that a mosaic (a VRT document) names. Not for public headers.
#ifndef DSPACE_RASTER_MOSAICSOURCES_H
#define DSPACE_RASTER_MOSAICSOURCES_H

#include <string>
#include <vector>

namespace dspace {

// The sources of a mosaic, in the document's order, each as often as it is named; a relative name
// starts at the folder of the document, with links resolved. Nothing is opened but the document.
// FilesGuard checks each source before this function tests whether it exists.
//
// Throws what the guard throws; Error(InvalidArgument) for a document that names data in another
// way than as plain files or files on a server (warped, raw or computed bands, open options,
// formats with a prefix, documents within documents), or has an element that this function does not
// know; Error(Resource) for one of more bytes than Budget::MosaicBytes.
std::vector<std::string> MosaicSources(const std::string& path);

} // namespace dspace

#endif
