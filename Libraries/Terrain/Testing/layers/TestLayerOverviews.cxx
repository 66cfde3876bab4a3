// Overviews that are made of large files without any: right, used again, and made again in time.
#include <cmath>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/layers/raster/ImageLayer.h>
#include <dspace/raster/ElevationCache.h>

#include "ColorBlocks.h"
#include "RasterFile.h"

namespace {

using dspace::ColorBlock;
using dspace::ColorGrid;
using dspace::ColorLayer;
using dspace::Crs;
using dspace::RasterLayerOptions;
using dspace::RasterPlace;
using dspace::testing::GridAt;
using dspace::testing::MiddleOf;
using dspace::testing::RasterFile;
using dspace::testing::ReadTexels;
using dspace::testing::Texels;

constexpr int OverviewColumns = 4501; // no multiple of anything
constexpr int OverviewRows = 333;

class Overviews : public ::testing::Test {
protected:
  Overviews() : Grid(GridAt(Crs(), {0.0, OverviewRows}, {32.0, -32.0})) {
    this->Place.name = "terrain 'ground'";
    this->Place.pixelToMap.linear() << 1.0, 0.0, 0.0, -1.0;
    this->Place.pixelToMap.translation() << 0.0, OverviewRows;
    this->Place.columns = OverviewColumns;
    this->Place.rows = OverviewRows;
    std::filesystem::create_directories(this->Data);
  }
  // Stripes of a pixel about a slope; clear where `clear` says so.
  static double Slope(const Eigen::Vector2d& map) { return 30.0 + map.x() / 30.0 + map.y() / 9.0; }
  std::string Write(double added = 0.0) {
    RasterFile file;
    file.width = OverviewColumns;
    file.height = OverviewRows;
    file.bands = 2;
    file.type = GDT_Byte;
    file.value = [=](int c, int r, int b) {
      const double stripe = (c + r) % 2 ? 20.0 : -20.0;
      return b == 1 ? (c % 512 < 256 ? 255.0 : 0.0)
                    : std::round(Slope({c + 0.5, OverviewRows - r - 0.5}) + stripe + added);
    };
    file.geotransform = {{0.0, 1.0, 0.0, double(OverviewRows), 0.0, -1.0}};
    return file.Write(this->Data + "/large.tif");
  }
  std::shared_ptr<const ColorLayer> Open(const std::string& folder) {
    RasterLayerOptions options;
    options.cacheFolder = folder;
    return OpenImageLayer(this->Data + "/large.tif", this->Place, options);
  }
  // The greatest difference from the slope of texels of 8, 16 and 32 pixels that are opaque.
  double Worst(const ColorLayer& layer, double added = 0.0) {
    double worst = 0.0;
    for (int zoom : {0, 1, 2}) {
      const int side = 32 >> zoom;
      const ColorBlock block{zoom, 0, 0, OverviewColumns / side, OverviewRows / side};
      const Texels texels = ReadTexels(layer, this->Grid, block);
      EXPECT_TRUE(texels.any);
      int seen = 0;
      for (int y = 0; y < block.height; ++y)
        for (int x = 0; x < block.width; ++x) {
          const int at =
              x * side % 512; // a texel and more from where it begins or ends to be clear
          if (at >= side && at + 2 * side <= 256) {
            ++seen;
            EXPECT_EQ(texels.At(x, y)[3], 255) << x << " " << y;
            worst = std::max(worst, std::abs(texels.At(x, y)[0] - added -
                                             Slope(MiddleOf(this->Grid, block, x, y))));
          } else if (at >= 256 + side && at + 2 * side <= 512) {
            EXPECT_EQ(texels.At(x, y)[3], 0) << x << " " << y;
          }
        }
      EXPECT_GT(seen, block.width / 4);
    }
    return worst;
  }
  std::vector<std::string> FilesIn(const std::string& folder) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
  }

  dspace::testing::TemporaryFolder Folder;
  std::string Data = this->Folder / "data";
  std::string Cache = this->Folder / "cache/deep";
  RasterPlace Place;
  ColorGrid Grid;
};

} // namespace

TEST_F(Overviews, InMemoryAndInAFolderTheyAreMeans) {
  this->Write();
  EXPECT_LT(this->Worst(*this->Open("")),
            2.2); // of stripes of 20 up and 20 down, and two roundings
  const auto layer = this->Open(this->Cache);
  EXPECT_FALSE(std::filesystem::exists(this->Cache)); // not in the open call
  EXPECT_LT(this->Worst(*layer), 2.2);
  EXPECT_EQ(this->FilesIn(this->Cache).size(), 3u); // 1126, 563 and 282 columns, nothing else
  EXPECT_EQ(this->FilesIn(this->Data).size(), 1u);  // nothing beside the source
}

TEST_F(Overviews, TheyAreUsedAgainUntilTheFileChanges) {
  this->Write();
  this->Worst(*this->Open(this->Cache));
  for (const std::string& name : this->FilesIn(this->Cache)) { // so that they are told from it
    auto* file = static_cast<GDALDataset*>(GDALOpen(name.c_str(), GA_Update));
    file->GetRasterBand(1)->Fill(7.0);
    file->GetRasterBand(2)->Fill(255.0);
    GDALClose(file);
  }
  const Texels again = ReadTexels(*this->Open(this->Cache), this->Grid, {0, 5, 5, 1, 1});
  EXPECT_EQ(again.rgba[0], 7);
  std::filesystem::remove(this->Data + "/large.tif");
  this->Write(10.0);
  EXPECT_LT(this->Worst(*this->Open(this->Cache), 10.0), 2.2);
}

TEST_F(Overviews, DamagedOnesAreAnErrorAndThenMadeAnew) {
  this->Write();
  this->Worst(*this->Open(this->Cache));
  for (const std::string& name : this->FilesIn(this->Cache)) {
    // Its tiles are overwritten, its directory is not.
    auto* file = static_cast<GDALDataset*>(GDALOpen(name.c_str(), GA_ReadOnly));
    const char* offset = file->GetRasterBand(1)->GetMetadataItem("BLOCK_OFFSET_0_0", "TIFF");
    ASSERT_TRUE(offset);
    const long at = std::atol(offset);
    GDALClose(file);
    std::FILE* raw = std::fopen(name.c_str(), "r+b");
    std::fseek(raw, at, SEEK_SET);
    for (int i = 0; i < 200; ++i)
      std::fputc(0xee, raw);
    std::fclose(raw);
  }
  const auto layer = this->Open(this->Cache);
  testing::internal::CaptureStderr();
  EXPECT_THROW(this->Worst(*layer), dspace::Error);
  EXPECT_LT(this->Worst(*layer), 2.2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(Overviews, ThreadsMakeThemOnce) {
  this->Write();
  const auto layer = this->Open("");
  std::vector<std::thread> threads;
  std::array<std::vector<std::uint8_t>, 4> got;
  for (auto& rgba : got)
    threads.emplace_back([&] {
      rgba =
          ReadTexels(*layer, this->Grid, {0, 0, 0, OverviewColumns / 32, OverviewRows / 32}).rgba;
    });
  for (std::thread& thread : threads)
    thread.join();
  for (const auto& rgba : got)
    EXPECT_EQ(rgba, got[0]);
}

TEST_F(Overviews, TheCacheListsVerifiesAndClearsThem) {
  this->Write();
  const std::string folder = this->Folder / "cache";
  this->Worst(*this->Open(folder));
  std::uint64_t bytes = 0;
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    bytes += file.file_size();
    ++files;
  }
  const dspace::ElevationCache cache(folder);
  const auto entries = cache.Entries();
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0].path, this->Data + "/large.tif");
  EXPECT_EQ(entries[0].bytes, bytes);
  EXPECT_EQ(entries[0].levels, files);
  EXPECT_FALSE(entries[0].damaged);
  EXPECT_NO_THROW(dspace::ElevationCache::Verify(entries[0]));
  std::filesystem::resize_file(entries[0].file, 600);
  EXPECT_THROW(dspace::ElevationCache::Verify(entries[0]), dspace::Error);
  const std::string hash = std::filesystem::path(entries[0].file).filename().string().substr(0, 32);
  const std::string killed = folder + "/." + hash + "-layer-2.tif.0123456789abcdef.part";
  std::ofstream(killed) << "killed";
  std::ofstream(folder + "/mine-layer-2.tif") << "of somebody";
  std::ofstream(folder + "/" + hash + ".tif") << "of somebody";
  EXPECT_EQ(cache.Entries().size(), 1u);
  cache.Clear();
  EXPECT_TRUE(cache.Entries().empty());
  EXPECT_TRUE(std::filesystem::exists(folder + "/mine-layer-2.tif"));
  EXPECT_TRUE(std::filesystem::exists(folder + "/" + hash + ".tif"));
  EXPECT_FALSE(std::filesystem::exists(killed));
}
