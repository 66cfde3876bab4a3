// Rasters whose blocks are larger than the limit are rejected when they are opened.
#include <filesystem>
#include <fstream>

#include <cpl_string.h>
#include <gtest/gtest.h>

#include <dspace/Budgets.h>
#include <dspace/Error.h>
#include <dspace/FilesRead.h>
#include <dspace/raster/ElevationSource.h>

#include "RasterFile.h"

namespace {

using namespace dspace;
using dspace::testing::TemporaryFolder;

// A TIFF without pixels: a few kB, whatever its size is.
std::string Write(const std::string& path, int side, int bands,
                  const std::vector<const char*>& settings) {
  GDALAllRegister();
  CPLStringList options;
  options.SetNameValue("SPARSE_OK", "TRUE");
  for (const char* setting : settings) {
    options.AddString(setting);
  }
  auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  auto* dataset = driver->Create(path.c_str(), side, side, bands, GDT_Float32, options.List());
  std::array<double, 6> g = {0, 1, 0, 0, 0, -1};
  dataset->SetGeoTransform(g.data());
  GDALClose(dataset);
  return path;
}

class BlockBytes {
public:
  explicit BlockBytes(std::uint64_t bytes) { SetBudget("block_bytes", bytes); }
  ~BlockBytes() {
    SetBudget("block_bytes", Budgets()[static_cast<std::size_t>(Budget::BlockBytes)].standard);
  }
  BlockBytes(const BlockBytes&) = delete;
  BlockBytes& operator=(const BlockBytes&) = delete;
};

std::string Rejection(const std::string& path) {
  try {
    const ElevationSource source(path);
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Resource) << error.what();
    return error.what();
  }
  return "";
}

TEST(BlockBudget, RejectsALargeStripOfAFewKilobytes) {
  const TemporaryFolder folder;
  const std::string path =
      Write(folder / "strip.tif", 30000, 1, {"COMPRESS=DEFLATE", "BLOCKYSIZE=30000"});
  EXPECT_LT(std::filesystem::file_size(path), 100000u);
  EXPECT_EQ(Rejection(path), "raster '" + path +
                                 "': its blocks have 30000 x 30000 pixels of 4 bytes; the limit "
                                 "block_bytes is 268435456, which dspace.limits.set raises");
  // As large in all, in smaller blocks.
  EXPECT_EQ(Rejection(Write(folder / "tiles.tif", 30000, 1, {"TILED=YES"})), "");
}

TEST(BlockBudget, IsExact) {
  const TemporaryFolder folder;
  const std::string path =
      Write(folder / "tiles.tif", 500, 1, {"TILED=YES", "BLOCKXSIZE=256", "BLOCKYSIZE=128"});
  {
    const BlockBytes limit(256 * 128 * 4);
    EXPECT_EQ(Rejection(path), "");
  }
  const BlockBytes limit(256 * 128 * 4 - 1);
  EXPECT_NE(Rejection(path), "");
}

TEST(BlockBudget, CountsPixelsThatLieTogetherOfAllBands) {
  const TemporaryFolder folder;
  const BlockBytes limit(128 * 128 * 4 * 2);
  for (const char* together : {"INTERLEAVE=PIXEL", "INTERLEAVE=BAND"}) {
    const std::string path = Write(folder / "bands.tif", 500, 3,
                                   {"TILED=YES", "BLOCKXSIZE=128", "BLOCKYSIZE=128", together});
    EXPECT_EQ(Rejection(path).empty(), std::string(together) == "INTERLEAVE=BAND") << together;
  }
}

TEST(BlockBudget, HoldsForTheSourcesOfAMosaicUnderAGuard) {
  const TemporaryFolder folder;
  // Compressed: libtiff cuts large strips of others into small ones.
  Write(folder / "source.tif", 500, 1, {"COMPRESS=DEFLATE", "BLOCKYSIZE=500"});
  const std::string path = folder / "mosaic.vrt";
  std::ofstream(path) << "<VRTDataset rasterXSize=\"500\" rasterYSize=\"500\">"
                         "<GeoTransform>0, 1, 0, 0, 0, -1</GeoTransform>"
                         "<VRTRasterBand dataType=\"Float32\" band=\"1\"><SimpleSource>"
                         "<SourceFilename relativeToVRT=\"1\">source.tif</SourceFilename>"
                         "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>";
  const FilesGuard guard([](const std::string&) {});
  EXPECT_EQ(Rejection(path), "");
  const BlockBytes limit(200000);
  EXPECT_NE(Rejection(path).find("source.tif"), std::string::npos) << Rejection(path);
}

} // namespace
