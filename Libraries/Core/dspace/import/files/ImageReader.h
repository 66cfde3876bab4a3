// Image files to dspace::Image, through OpenImageIO.
#ifndef DSPACE_IMPORT_IMAGE_READER_H
#define DSPACE_IMPORT_IMAGE_READER_H

#include <cstddef>
#include <memory>
#include <string>

#include <dspace/import/model/Model.h>

namespace dspace {

// Largest image that is read: 32768 pixels a side, and Budget::ImagePixels (Budgets.h) in all.
constexpr int MaximumImageSide = 32768;
// Largest file of an image that is read, packed.
constexpr std::size_t MaximumImageBytes = std::size_t(1) << 30;

// Reads a PNG, JPEG, WebP, GIF, BMP, TIFF, PNM or (by its extension) TGA file as 8 bits a channel;
// channels beyond the fourth are dropped, of several pictures the first is taken. Row 0 is the top
// row. Alpha is not premultiplied. Values are the file's own (sRGB-encoded for the usual types).
// Throws Error: NotFound, Io (not a readable file), Unsupported (of none of these types), Corrupt
// (damaged, truncated), Resource (larger than the limits above).
std::shared_ptr<const Image> ReadImage(const std::string& path);

// The same from `size` bytes in memory, the type found by content. `name` is for messages and
// becomes Image::name; its extension decides where content is silent (TGA).
std::shared_ptr<const Image> ReadImageMemory(const void* data, std::size_t size,
                                             const std::string& name);

} // namespace dspace

#endif
