// Images that OpenImageIO decodes: all types, and PNG files that are not plain.
#include <dspace/import/files/ImageCodec.h>

#include <cmath>
#include <fstream>

#include <OpenImageIO/imageio.h>

#include <dspace/import/files/ImageReader.h>
#include <dspace/import/files/PngReader.h>

#include "ImportTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

namespace {

// A PNG as OpenImageIO writes it.
std::string PngOf(const TempFolder& folder, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                  const void* pixels) {
  const std::string path = folder / "written.png";
  const auto out = OIIO::ImageOutput::create(path);
  EXPECT_TRUE(out && out->open(path, spec) && out->write_image(type, pixels) && out->close());
  std::ifstream file(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

std::uint32_t Crc(const std::string& data) { // PNG, annex D
  std::uint32_t crc = 0xffffffffu;
  for (const char c : data) {
    crc ^= std::uint8_t(c);
    for (int k = 0; k < 8; ++k) {
      crc = (crc & 1) != 0 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
    }
  }
  return ~crc;
}

std::string Chunk(const std::string& type, const std::string& content) {
  const auto word = [](std::uint32_t v) {
    return std::string{char(v >> 24), char(v >> 16), char(v >> 8), char(v)};
  };
  return word(std::uint32_t(content.size())) + type + content + word(Crc(type + content));
}

// 2 x 2 pixels with a palette of red, green and blue, the last one half transparent if wanted;
// deflated without compression (RFC 1951, 3.2.4).
std::string PalettePng(bool transparent) {
  const std::string rows("\0\0\1\0\2\0", 6); // a filter byte before each row
  std::uint32_t a = 1, b = 0;                // Adler-32 (RFC 1950)
  for (const char c : rows) {
    a = (a + std::uint8_t(c)) % 65521;
    b = (b + a) % 65521;
  }
  const std::string zlib = std::string("\x78\x01\x01\x06\x00\xf9\xff", 7) + rows +
                           std::string{char(b >> 8), char(b), char(a >> 8), char(a)};
  return std::string("\x89PNG\r\n\x1a\n") +
         Chunk("IHDR", std::string("\0\0\0\2\0\0\0\2\x8\3\0\0\0", 13)) +
         Chunk("PLTE", std::string("\xff\0\0\0\xff\0\0\0\xff", 9)) +
         (transparent ? Chunk("tRNS", "\xff\xff\x80") : "") + Chunk("IDAT", zlib) +
         Chunk("IEND", "");
}

} // namespace

TEST(ImageCodec, EveryTypeIsReadUpright) {
  const TempFolder folder;
  // Upper half red, lower half blue.
  const int size = 16;
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      pixels.insert(pixels.end(), {std::uint8_t(y < size / 2 ? 230 : 10), 20,
                                   std::uint8_t(y < size / 2 ? 10 : 230)});
    }
  }
  for (const std::string type : {"png", "jpg", "webp", "tif", "bmp", "tga", "gif", "ppm"}) {
    const std::string path = folder / ("half." + type);
    const auto out = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(out) << type;
    ASSERT_TRUE(out->open(path, OIIO::ImageSpec(size, size, 3, OIIO::TypeDesc::UINT8))) << type;
    ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT8, pixels.data())) << type;
    out->close();
    const auto image = ReadImage(path);
    ASSERT_EQ(image->width, size) << type;
    ASSERT_EQ(image->height, size) << type;
    ASSERT_GE(image->channels, 3) << type;
    ASSERT_EQ(image->pixels.size(), std::size_t(size * size * image->channels)) << type;
    const auto pixel = [&](int x, int y) {
      return &image->pixels[std::size_t((y * size + x) * image->channels)];
    };
    // JPEG, WebP and GIF change colours a little.
    EXPECT_NEAR(pixel(8, 2)[0], 230, 24) << type;
    EXPECT_NEAR(pixel(8, 2)[2], 10, 24) << type;
    EXPECT_NEAR(pixel(8, 13)[0], 10, 24) << type;
    EXPECT_NEAR(pixel(8, 13)[2], 230, 24) << type;
  }
}

// Kinds that libpng alone would change are OpenImageIO's.
TEST(ImageCodec, PngsThatAreNotPlainAreLeftToOpenImageIO) {
  const TempFolder folder;
  const std::string palette = PalettePng(false);
  EXPECT_EQ(ReadPlainPng(palette.data(), palette.size(), "p"), nullptr);
  EXPECT_EQ(ReadImageMemory(palette.data(), palette.size(), "p")->pixels,
            (std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 0, 0}));
  const std::string clear = PalettePng(true);
  EXPECT_EQ(ReadPlainPng(clear.data(), clear.size(), "p"), nullptr);
  EXPECT_EQ(
      ReadImageMemory(clear.data(), clear.size(), "p")->pixels,
      (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 128, 255, 0, 0, 255}));

  constexpr int Width = 5, Height = 3;
  std::vector<std::uint16_t> deep(std::size_t(Width * Height * 3));
  std::vector<std::uint8_t> expected(deep.size());
  for (std::size_t i = 0; i < deep.size(); ++i) {
    deep[i] = std::uint16_t(i * 1457 + 3);
    expected[i] = std::uint8_t(std::lround(deep[i] / 257.0));
  }
  const std::string png = PngOf(folder, OIIO::ImageSpec(Width, Height, 3, OIIO::TypeDesc::UINT16),
                                OIIO::TypeDesc::UINT16, deep.data());
  EXPECT_EQ(ReadPlainPng(png.data(), png.size(), "deep"), nullptr);
  const auto image = ReadImageMemory(png.data(), png.size(), "deep");
  const auto direct = LoadImageCodec().read(png.data(), png.size(), "deep");
  EXPECT_EQ(image->pixels, direct->pixels);
  ASSERT_EQ(image->pixels.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(image->pixels[i], expected[i], 1) << i; // both roundings are in use
  }
}
