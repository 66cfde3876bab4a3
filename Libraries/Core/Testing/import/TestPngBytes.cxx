// PNG files in memory, read by libpng and by OpenImageIO.
#include <dspace/import/files/PngBytes.h>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/import/files/ImageCodec.h>
#include <dspace/import/files/PngReader.h>

using namespace dspace;

// What is written, libpng and OpenImageIO read again, for every number of channels.
TEST(PngBytes, AreTheImage) {
  for (const int channels : {1, 2, 3, 4}) {
    Image image;
    image.name = "picture";
    image.width = 13;
    image.height = 5;
    image.channels = channels;
    for (int i = 0; i < 13 * 5 * channels; ++i) {
      image.pixels.push_back(std::uint8_t(i * 29 + 7));
    }
    const std::vector<std::uint8_t> png = PngBytes(image);
    EXPECT_EQ(png, PngBytes(image)); // the same bytes
    const auto plain = ReadPlainPng(png.data(), png.size(), "again");
    ASSERT_NE(plain, nullptr);
    EXPECT_EQ(plain->pixels, image.pixels);
    const auto other = LoadImageCodec().read(png.data(), png.size(), "again");
    EXPECT_EQ(other->width, 13);
    EXPECT_EQ(other->channels, channels);
    EXPECT_EQ(other->pixels, image.pixels);
  }
  Image empty;
  empty.name = "nothing";
  empty.channels = 3;
  try {
    PngBytes(empty);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("'nothing'"), std::string::npos) << error.what();
  }
}
