// Decodes images with OpenImageIO. Not a public header; part of libDspaceImageCodec.
#ifndef DSPACE_IMPORT_OPEN_IMAGE_IO_READER_H
#define DSPACE_IMPORT_OPEN_IMAGE_IO_READER_H

#include <cstddef>
#include <memory>
#include <string>

#include <dspace/import/model/Model.h>

namespace dspace {

// As ReadImageMemory.
std::shared_ptr<const Image> ReadWithOpenImageIo(const void* data, std::size_t size,
                                                 const std::string& name);

} // namespace dspace

#endif
