// Plain PNG files, decoded with libpng: their samples, and damaged files.
#include <dspace/import/files/PngReader.h>

#include <OpenImageIO/imageio.h>

#include <dspace/import/files/ImageCodec.h>
#include <dspace/import/files/ImageReader.h>

#include "ImportTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

// Plain PNG files are decoded with libpng, others with OpenImageIO: both must give the stored
// samples.
TEST(PngReader, PngSamplesAreThoseOfOpenImageIO) {
  const TempFolder folder;
  constexpr int Width = 19, Height = 7;
  for (const int channels : {1, 2, 3, 4}) {
    for (const float gamma : {0.0f, 1.0f, 2.2f}) {
      std::vector<std::uint8_t> pixels(std::size_t(Width * Height * channels));
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = std::uint8_t(i * 37 + 11);
      }
      const std::string path = folder / "samples.png";
      OIIO::ImageSpec spec(Width, Height, channels, OIIO::TypeDesc::UINT8);
      spec.alpha_channel = channels % 2 == 0 ? channels - 1 : -1;
      spec.attribute("oiio:UnassociatedAlpha", 1);
      if (gamma > 0.0f) {
        spec.attribute("oiio:ColorSpace", "GammaCorrected");
        spec.attribute("oiio:Gamma", gamma);
      } else {
        spec.attribute("oiio:ColorSpace", "sRGB");
      }
      const auto out = OIIO::ImageOutput::create(path);
      ASSERT_TRUE(out->open(path, spec) && out->write_image(OIIO::TypeDesc::UINT8, pixels.data()) &&
                  out->close());
      const auto image = ReadImage(path);
      EXPECT_EQ(image->channels, channels);
      EXPECT_EQ(image->pixels, pixels) << channels << " channels, gamma " << gamma;
    }
  }
}

TEST(PngReader, PlainPngsAreReadTwiceAlike) {
  const std::string png = DecodeBase64(FourColorsPng);
  const auto plain = ReadPlainPng(png.data(), png.size(), "four");
  ASSERT_NE(plain, nullptr);
  const auto direct = LoadImageCodec().read(png.data(), png.size(), "four");
  EXPECT_EQ(plain->pixels, direct->pixels);
  EXPECT_EQ(plain->name, direct->name);
  EXPECT_EQ(plain->channels, direct->channels);
}

// Every beginning of a file, and every file with one byte changed: an image of its size or nothing.
TEST(PngReader, DamagedPngsAreNoImages) {
  const std::string png = DecodeBase64(FourColorsPng);
  const std::size_t pixels = png.find("IDAT");
  ASSERT_NE(pixels, std::string::npos);
  for (std::size_t n = 0; n < pixels + 8; ++n) {
    EXPECT_EQ(ReadPlainPng(png.data(), n, "cut"), nullptr) << n;
  }
  for (std::size_t i = 0; i < png.size(); ++i) {
    std::string damaged = png;
    damaged[i] = char(damaged[i] ^ 0x41);
    const auto image = ReadPlainPng(damaged.data(), damaged.size(), "damaged");
    EXPECT_TRUE(!image ||
                image->pixels.size() == std::size_t(image->width) * image->height * image->channels)
        << i;
  }
  EXPECT_EQ(ReadPlainPng("", 0, "none"), nullptr);
}
