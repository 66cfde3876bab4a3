// Image files to dspace::Image, through OpenImageIO.
#ifndef DSPACE_IMPORT_IMAGE_READER_H
#define DSPACE_IMPORT_IMAGE_READER_H

#include <cstddef>
#include <memory>
#include <string>

#include <dspace/import/Model.h>

namespace dspace {

// Largest image that is read: 32768 pixels a side and 1 GiB decoded.
constexpr int MaximumImageSide = 32768;
constexpr std::size_t MaximumImageBytes = std::size_t(1) << 30;

// Reads an image file of any type that OpenImageIO knows (png, jpeg, webp, tiff, bmp, tga, ...),
// as 8 bits a channel; channels beyond the fourth are dropped. Row 0 is the top row. Alpha is not
// premultiplied. Values are those of the file (sRGB-encoded for the usual types).
// Throws Error: NotFound, Io (not a readable file), Corrupt (damaged or of no known type),
// Resource (larger than the limits above).
std::shared_ptr<const Image> ReadImage(const std::string& path);

// The same from `size` bytes in memory; the type is found by content (png, jpeg, webp, bmp, gif,
// tiff, hdr, exr, dds, ktx are not guessed beyond their magic bytes). `name` is for messages and
// Image::name.
std::shared_ptr<const Image> ReadImageMemory(const void* data, std::size_t size,
                                             const std::string& name);

} // namespace dspace

#endif
