// The library that decodes and encodes images. Not a public header.
#ifndef DSPACE_IMPORT_IMAGE_CODEC_H
#define DSPACE_IMPORT_IMAGE_CODEC_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <dspace/import/model/Model.h>

namespace dspace {

// A picture to be written to a file whose type is that of the extension.
struct PictureFile {
  enum class Sample { UInt8, UInt16, UInt32, Float, HalfFromFloat };
  std::string path;
  int width = 0;
  int height = 0;
  int channels = 0;
  Sample sample = Sample::UInt8;
  const void* pixels = nullptr;               // row 0 on top
  std::ptrdiff_t pixelBytes = 0;              // from one pixel to the next
  std::vector<std::string> channelNames = {}; // empty: the type's own
  bool srgb = false;
  bool zip = false;
  int jpegQuality = 0; // 1 to 100; 0: not a JPEG
};

// The functions of libDspaceImageCodec. OpenImageIO brings some 250 libraries, which take a third
// of a second to load: a process that handles no image should not wait for them.
struct ImageCodec {
  // As ReadImageMemory.
  std::shared_ptr<const Image> (*read)(const void* data, std::size_t size, const std::string& name);
  // Throws Error(Io or Internal) that names the file. An earlier file stays as it is.
  void (*write)(const PictureFile& picture);
};

// Loads the library at the first call. Throws Error(Internal) if it is not beside this one.
const ImageCodec& LoadImageCodec();
// Whether a call has loaded it.
bool ImageCodecIsLoaded();

} // namespace dspace

#endif
