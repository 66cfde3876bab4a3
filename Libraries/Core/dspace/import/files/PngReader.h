// Decodes plain PNG files with libpng. Not a public header.
#ifndef DSPACE_IMPORT_PNG_READER_H
#define DSPACE_IMPORT_PNG_READER_H

#include <cstddef>
#include <memory>
#include <string>

#include <dspace/import/model/Model.h>

namespace dspace {

// The same image as ReadImageMemory's. Null, for the image codec to decode or to report: a file
// that is no PNG, that is damaged, that has a palette, a transparent colour, a colour profile, a
// gamma other than sRGB's or other than 8 bits a channel, or that is too large.
std::shared_ptr<const Image> ReadPlainPng(const void* data, std::size_t size,
                                          const std::string& name);

} // namespace dspace

#endif
