#include <dspace/import/files/PngReader.h>

#include <cstdint>
#include <cstring>

#include <png.h>

#include <dspace/Budgets.h>
#include <dspace/import/files/ImageReader.h>

namespace dspace {
namespace {

constexpr std::uint32_t SrgbGamma = 45455; // 100,000 / 2.2, what encoders write for sRGB

std::uint32_t BigEndian(const std::uint8_t* at) {
  return std::uint32_t(at[0]) << 24 | std::uint32_t(at[1]) << 16 | std::uint32_t(at[2]) << 8 |
         std::uint32_t(at[3]);
}

bool Is(const std::uint8_t* type, const char* name) {
  return std::memcmp(type, name, 4) == 0;
}

// Whether the chunks before the pixels leave the samples as they are stored.
bool IsPlain(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t Signature = 8;
  constexpr std::size_t AroundChunk = 12; // length, type and checksum
  for (std::size_t at = Signature; at + AroundChunk <= size;) {
    const std::size_t length = BigEndian(data + at);
    const std::uint8_t* type = data + at + 4;
    const std::uint8_t* content = type + 4;
    if (length > size - at - AroundChunk) {
      return false;
    }
    if (Is(type, "IDAT")) {
      return at > Signature;
    }
    if (at == Signature) {
      const bool palette = length == 13 && content[9] == PNG_COLOR_TYPE_PALETTE;
      if (!Is(type, "IHDR") || length != 13 || content[8] != 8 || palette) {
        return false;
      }
    } else if (Is(type, "PLTE") || Is(type, "tRNS") || Is(type, "iCCP") || Is(type, "cHRM") ||
               Is(type, "acTL") ||
               (Is(type, "gAMA") && (length != 4 || BigEndian(content) != SrgbGamma))) {
      return false;
    }
    at += AroundChunk + length;
  }
  return false;
}

} // namespace

std::shared_ptr<const Image> ReadPlainPng(const void* data, std::size_t size,
                                          const std::string& name) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  if (size < 8 || png_sig_cmp(bytes, 0, 8) != 0 || !IsPlain(bytes, size)) {
    return nullptr;
  }
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (!png_image_begin_read_from_memory(&png, data, size)) {
    return nullptr;
  }
  png.format &= PNG_FORMAT_FLAG_COLOR | PNG_FORMAT_FLAG_ALPHA;
  auto image = std::make_shared<Image>();
  image->name = name;
  image->width = int(png.width);
  image->height = int(png.height);
  image->channels = int(PNG_IMAGE_SAMPLE_CHANNELS(png.format));
  const std::size_t decoded =
      std::size_t(png.width) * std::size_t(png.height) * std::size_t(image->channels);
  if (png.width > png_uint_32(MaximumImageSide) || png.height > png_uint_32(MaximumImageSide) ||
      std::uint64_t(png.width) * png.height > BudgetOf(Budget::ImagePixels)) {
    png_image_free(&png);
    return nullptr;
  }
  image->pixels.resize(decoded);
  if (!png_image_finish_read(&png, nullptr, image->pixels.data(), 0, nullptr) ||
      PNG_IMAGE_FAILED(png)) {
    return nullptr;
  }
  return image;
}

} // namespace dspace
