// Images as PNG files in memory.
#ifndef DSPACE_IMPORT_PNG_BYTES_H
#define DSPACE_IMPORT_PNG_BYTES_H

#include <cstdint>
#include <vector>

#include <dspace/import/model/Model.h>

namespace dspace {

// The same image gives the same bytes. Throws Error(Internal) naming the image.
std::vector<std::uint8_t> PngBytes(const Image& image);

} // namespace dspace

#endif
