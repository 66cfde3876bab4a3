// Images whose parts cannot be read by themselves are decoded once, and show what others show.
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/layers/raster/ImageLayer.h>

#include "ColorBlocks.h"
#include "RasterFile.h"

namespace {

using dspace::ColorGrid;
using dspace::ColorLayer;
using dspace::Crs;
using dspace::OpenImageLayer;
using dspace::RasterPlace;
using dspace::testing::GridAt;
using dspace::testing::RasterFile;
using dspace::testing::ReadTexels;
using dspace::testing::Texels;

constexpr int Columns = 301;
constexpr int Rows = 207;

class KeptImage : public ::testing::Test {
protected:
  KeptImage() : Grid(GridAt(Crs(), {0.0, Rows}, {11.0, -11.0})) {
    this->Place.name = "terrain 'ground'";
    this->Place.pixelToMap.linear() << 1.0, 0.0, 0.0, -1.0;
    this->Place.pixelToMap.translation() << 0.0, Rows;
    this->Place.columns = Columns;
    this->Place.rows = Rows;
  }
  // Of noise; the same pixels as TIFF and as PNG.
  std::string Tiff(GDALDataType type, int bands) {
    RasterFile file;
    file.width = Columns;
    file.height = Rows;
    file.bands = bands;
    file.type = type;
    file.value = [type](int c, int r, int b) {
      return double((c * 7919 + r * 104729 + b * 31 + c * r) % (type == GDT_Byte ? 256 : 65536));
    };
    file.geotransform = {{0.0, 1.0, 0.0, double(Rows), 0.0, -1.0}};
    return file.Write(this->Folder / ("image" + std::to_string(bands) + ".tif"));
  }
  static std::string Png(const std::string& tiff) {
    const std::string path = tiff + ".png";
    auto* from = GDALDataset::Open(tiff.c_str());
    auto* driver = GetGDALDriverManager()->GetDriverByName("PNG");
    GDALClose(driver->CreateCopy(path.c_str(), from, 0, nullptr, nullptr, nullptr));
    GDALClose(from);
    return path;
  }
  std::shared_ptr<const ColorLayer> Open(const std::string& path) {
    dspace::RasterLayerOptions options;
    options.extent = {{0.0, double(Rows), double(Columns), 0.0}};
    return OpenImageLayer(path, this->Place, options);
  }

  dspace::testing::TemporaryFolder Folder;
  RasterPlace Place;
  ColorGrid Grid;
};

} // namespace

TEST_F(KeptImage, APngShowsWhatATiffShows) {
  for (const GDALDataType type : {GDT_Byte, GDT_UInt16}) {
    for (const int bands : {1, 2, 3, 4}) {
      const std::string path = this->Tiff(type, bands);
      const auto tiff = this->Open(path);
      const auto png = this->Open(this->Png(path));
      for (const int zoom : {0, 2, 4, 5}) {
        const Texels expected = ReadTexels(*tiff, this->Grid, {zoom, -3, -2, 150, 90});
        const Texels shown = ReadTexels(*png, this->Grid, {zoom, -3, -2, 150, 90});
        ASSERT_TRUE(expected.any);
        ASSERT_EQ(shown.rgba, expected.rgba) << bands << " bands at zoom " << zoom;
      }
      EXPECT_EQ(tiff->KeptBytes(), 0u);
      EXPECT_EQ(png->KeptBytes(), std::size_t(Columns) * Rows * bands * (type == GDT_Byte ? 1 : 2));
    }
  }
}

TEST_F(KeptImage, ThreadsShareWhatIsDecoded) {
  const std::string path = this->Tiff(GDT_Byte, 3);
  const Texels expected = ReadTexels(*this->Open(path), this->Grid, {2, 0, 0, 100, 70});
  const auto png = this->Open(this->Png(path));
  EXPECT_EQ(png->KeptBytes(), 0u); // nothing was asked for
  std::array<Texels, 4> shown;
  std::vector<std::thread> threads;
  for (Texels& texels : shown) {
    threads.emplace_back([&] { texels = ReadTexels(*png, this->Grid, {2, 0, 0, 100, 70}); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const Texels& texels : shown) {
    EXPECT_EQ(texels.rgba, expected.rgba);
  }
  EXPECT_EQ(png->KeptBytes(), std::size_t(Columns) * Rows * 3);
}

TEST_F(KeptImage, OneThatIsTooLargeIsToldWithItsRemedy) {
  GDALAllRegister();
  for (const int rows : {8000, 8016}) { // one block; left out, so that the file is small
    const std::string path = this->Folder / (std::to_string(rows) + ".tif");
    const std::string block = "BLOCKYSIZE=" + std::to_string(rows);
    const char* const options[] = {"TILED=YES", "BLOCKXSIZE=8000", block.c_str(), "SPARSE_OK=TRUE",
                                   nullptr};
    auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    GDALClose(driver->Create(path.c_str(), 8000, rows, 1, GDT_Byte, const_cast<char**>(options)));
    const auto layer = this->Open(path);
    bool told = false;
    for (const std::string& warning : layer->Warnings()) {
      told |= warning.find("TILED=YES") != std::string::npos &&
              warning.find("8000 x " + std::to_string(rows)) != std::string::npos;
    }
    EXPECT_EQ(told, rows == 8016); // 64 million pixels are kept
  }
}
