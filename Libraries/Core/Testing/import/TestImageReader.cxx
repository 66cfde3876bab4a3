// Images of files and of memory: the order of their pixels, and bad ones.
#include <dspace/import/files/ImageReader.h>

#include "ImportTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

TEST(ImageReader, PngPixelsTopRowFirst) {
  const std::string png = DecodeBase64(FourColorsPng);
  const auto image = ReadImageMemory(png.data(), png.size(), "four");
  EXPECT_EQ(image->name, "four");
  ASSERT_EQ(image->channels, 3);
  EXPECT_EQ(image->pixels,
            (std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}));
  const std::string alpha = DecodeBase64(AlphaPng);
  EXPECT_EQ(ReadImageMemory(alpha.data(), alpha.size(), "a")->pixels,
            (std::vector<std::uint8_t>{200, 100, 50, 64, 10, 20, 30, 255}));
}

TEST(ImageReader, BadImagesAreTypedErrors) {
  const TempFolder folder;
  const std::string png = DecodeBase64(FourColorsPng);
  ExpectError(Error::Kind::NotFound, "none.png", [&] { ReadImage(folder / "none.png"); });
  ExpectError(Error::Kind::Io, "", [&] { ReadImage(folder / ""); });
  ExpectError(Error::Kind::Corrupt, "is empty", [&] { ReadImage(folder.Write("e.png", "")); });
  ExpectError(Error::Kind::Unsupported, "no known type",
              [&] { ReadImage(folder.Write("t.png", "not an image")); });
  const std::string huge = DecodeBase64(HugePng);
  ExpectError(Error::Kind::Resource, "100000 x 100000",
              [&] { ReadImageMemory(huge.data(), huge.size(), "huge"); });
  for (const std::size_t n : {8u, 20u, 33u, 45u}) {
    ExpectError(Error::Kind::Corrupt, "cut", [&] { ReadImageMemory(png.data(), n, "cut"); });
  }
}
