// Encodes images with OpenImageIO. Not a public header; part of libDspaceImageCodec.
#ifndef DSPACE_IMPORT_OPEN_IMAGE_IO_WRITER_H
#define DSPACE_IMPORT_OPEN_IMAGE_IO_WRITER_H

#include <dspace/import/files/ImageCodec.h>

namespace dspace {

// As ImageCodec::write. The same input gives the same bytes.
void WriteWithOpenImageIo(const PictureFile& picture);

} // namespace dspace

#endif
