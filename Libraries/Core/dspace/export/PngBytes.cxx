#include <dspace/export/PngBytes.h>

#include <png.h>

#include <dspace/Error.h>

namespace dspace {

std::vector<std::uint8_t> PngBytes(const Image& image) {
  constexpr png_uint_32 Formats[] = {PNG_FORMAT_GRAY, PNG_FORMAT_GA, PNG_FORMAT_RGB,
                                     PNG_FORMAT_RGBA};
  png_image file{};
  file.version = PNG_IMAGE_VERSION;
  file.width = png_uint_32(image.width);
  file.height = png_uint_32(image.height);
  file.format = Formats[image.channels - 1];
  const auto write = [&](std::uint8_t* to, png_alloc_size_t& size) {
    if (!png_image_write_to_memory(&file, to, &size, 0, image.pixels.data(), 0, nullptr)) {
      const std::string message = file.message;
      png_image_free(&file);
      throw Error(Error::Kind::Internal, "image '" + image.name + "'",
                  "cannot be encoded: " + message);
    }
  };
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(file);
  std::vector<std::uint8_t> bytes(size);
  write(bytes.data(), size);
  bytes.resize(size);
  return bytes;
}

} // namespace dspace
