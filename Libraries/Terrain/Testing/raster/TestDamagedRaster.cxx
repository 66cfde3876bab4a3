// Files that shrink, change or vanish under an open source: no read gives zeros or holes for what
// is not there any more.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <cpl_string.h>
#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/posts/RasterPosts.h>
#include <dspace/pyramid/ElevationPyramid.h>
#include <dspace/raster/ElevationSource.h>

#include "RasterFile.h"

namespace {

using namespace dspace;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;
namespace fs = std::filesystem;

constexpr int Side = 400;

double HeightAt(int c, int r) {
  return 1000.0 + (c * 7919 + r * 104729 + c * r % 977) % 100003 / 64.0;
}

// `kind`: a compression, or "TILED".
std::string Write(const std::string& path, const std::string& kind) {
  RasterFile file;
  file.width = Side;
  file.height = Side;
  file.type = GDT_Float32;
  file.geotransform = std::array<double, 6>{0, 1, 0, 0, 0, -1};
  file.value = [](int c, int r, int) { return HeightAt(c, r); };
  auto* plain = GDALDataset::Open(file.Write(path + ".plain.tif").c_str(), GDAL_OF_RASTER);
  CPLStringList options;
  options.SetNameValue("COMPRESS", kind == "TILED" ? "NONE" : kind.c_str());
  options.SetNameValue("TILED", kind == "TILED" ? "YES" : "NO");
  auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  GDALClose(driver->CreateCopy(path.c_str(), plain, 0, options.List(), nullptr, nullptr));
  GDALClose(plain);
  fs::remove(path + ".plain.tif");
  return path;
}

// The left half from one file, the right half from another.
std::string WriteMosaic(const std::string& path, const std::string& left,
                        const std::string& right) {
  std::ofstream vrt(path);
  vrt << "<VRTDataset rasterXSize=\"800\" rasterYSize=\"400\">"
         "<GeoTransform>0, 1, 0, 0, 0, -1</GeoTransform>"
         "<VRTRasterBand dataType=\"Float32\" band=\"1\">";
  for (const std::string& file : {left, right}) {
    vrt << "<SimpleSource><SourceFilename>" << file
        << "</SourceFilename><SourceBand>1</SourceBand>"
           "<SourceProperties RasterXSize=\"400\" RasterYSize=\"400\" DataType=\"Float32\" "
           "BlockXSize=\"400\" BlockYSize=\"5\"/>"
           "<SrcRect xOff=\"0\" yOff=\"0\" xSize=\"400\" ySize=\"400\"/><DstRect xOff=\""
        << (file == left ? 0 : 400) << "\" yOff=\"0\" xSize=\"400\" ySize=\"400\"/></SimpleSource>";
  }
  vrt << "</VRTRasterBand></VRTDataset>";
  return path;
}

void ExpectHeights(const std::vector<double>& heights) {
  ASSERT_EQ(heights.size(), std::size_t(Side) * Side);
  int wrong = 0;
  for (int i = 0; i < Side * Side; ++i) {
    wrong += heights[i] != float(HeightAt(i % Side, i / Side));
  }
  EXPECT_EQ(wrong, 0);
}

std::string Rejection(const ElevationSource& source, const RasterWindow& window, Error::Kind kind,
                      int factor = 1) {
  try {
    source.ReadReduced(window, factor);
  } catch (const Error& error) {
    EXPECT_EQ(int(error.GetKind()), int(kind)) << error.what();
    EXPECT_NE(std::string(error.what()).find(source.Info().path), std::string::npos);
    return error.what();
  }
  ADD_FAILURE() << "was read";
  return "";
}

TEST(DamagedRaster, AFileThatShrinksWhileOpenIsNotRead) {
  const TemporaryFolder folder;
  for (const std::string kind : {"NONE", "TILED", "DEFLATE", "LZW"}) {
    for (const double part : {0.99, 0.6, 0.01, 0.0}) {
      SCOPED_TRACE(kind + " " + std::to_string(part));
      const std::string path = Write(folder / "shrinks.tif", kind);
      const ElevationSource source(path);
      EXPECT_EQ(source.Read({0, 0, 1, 1})[0], float(HeightAt(0, 0)));
      fs::resize_file(path, std::uintmax_t(double(fs::file_size(path)) * part));
      for (const int factor : {1, 4}) {
        const std::string said = Rejection(source, {0, 0, Side, Side}, Error::Kind::Io, factor);
        EXPECT_NE(said.find("has changed since"), std::string::npos) << said;
      }
    }
  }
}

// A mosaic's file stays as it is, so that only GDAL meets what is missing.
TEST(DamagedRaster, AMosaicWhoseFileShrinksOrVanishesIsNotReadThere) {
  const TemporaryFolder folder;
  for (const std::string kind : {"NONE", "TILED", "DEFLATE", "LZW"}) {
    for (const double part : {0.99, 0.6, 0.01, 0.0, -1.0}) {
      SCOPED_TRACE(kind + " " + std::to_string(part));
      const std::string left = Write(folder / "left.tif", kind);
      const std::string right = Write(folder / "right.tif", kind);
      const ElevationSource source(WriteMosaic(folder / "mosaic.vrt", left, right));
      ExpectHeights(source.Read({0, 0, Side, Side}));
      if (part < 0.0) {
        fs::remove(right);
      } else {
        fs::resize_file(right, std::uintmax_t(double(fs::file_size(right)) * part));
      }
      for (int again = 0; again < 3; ++again) { // nor after the first rejection
        Rejection(source, {Side, 0, Side, Side}, Error::Kind::Corrupt);
        Rejection(source, {0, Side - 10, 2 * Side, 10}, Error::Kind::Corrupt);
      }
      ExpectHeights(source.Read({0, 0, Side, Side})); // what is there is read
      Write(right, kind);                             // and what comes back
      ExpectHeights(source.Read({Side, 0, Side, Side}));
    }
  }
}

TEST(DamagedRaster, AFileRewrittenInPlaceIsOpenedAnew) {
  const TemporaryFolder folder;
  const std::string path = Write(folder / "rewritten.tif", "NONE");
  const ElevationSource source(path);
  ExpectHeights(source.Read());
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(200000);
    file.write("changed!", 8);
  }
  fs::last_write_time(path, fs::last_write_time(path) + std::chrono::seconds(2));
  Rejection(source, {0, 0, 1, 1}, Error::Kind::Io);
  EXPECT_NO_THROW(ElevationSource(path).Read());
}

// GDAL gives other heights for some of them without a word.
TEST(DamagedRaster, NoFlippedByteOfADeflatedFileIsReadAsHeights) {
  const TemporaryFolder folder;
  std::mt19937 random(1);
  int unnoticed = 0; // by GDAL
  for (const auto& [tiled, predictor] : {std::pair("NO", "1"), {"NO", "3"}, {"YES", "1"}}) {
    const std::string plain = Write(folder / "plain.tif", "NONE");
    const std::string path = folder / "flipped.tif";
    CPLStringList options;
    options.SetNameValue("COMPRESS", "DEFLATE");
    options.SetNameValue("PREDICTOR", predictor);
    options.SetNameValue("TILED", tiled);
    auto* from = GDALDataset::Open(plain.c_str(), GDAL_OF_RASTER);
    auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
    GDALClose(driver->CreateCopy(path.c_str(), from, 0, options.List(), nullptr, nullptr));
    GDALClose(from);
    ExpectHeights(ElevationSource(path).Read());
    std::ifstream in(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    for (int i = 0; i < 40; ++i) {
      std::string flipped = bytes; // beyond the directory, which comes first
      flipped[4096 + random() % (bytes.size() - 4096)] ^= char(1 + random() % 255);
      std::ofstream(path, std::ios::binary) << flipped;
      std::vector<float> given(std::size_t(Side) * Side);
      CPLPushErrorHandler(CPLQuietErrorHandler);
      auto* dataset = GDALDataset::Open(path.c_str(), GDAL_OF_RASTER);
      const bool read =
          dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, Side, Side, given.data(), Side, Side,
                                              GDT_Float32, 0, 0, nullptr) == CE_None;
      GDALClose(dataset);
      CPLPopErrorHandler();
      unnoticed += read;
      const ElevationSource source(path);
      const std::string said = Rejection(source, {0, 0, Side, Side}, Error::Kind::Corrupt);
      EXPECT_TRUE(!read || said.find("checksum") != std::string::npos) << said;
    }
  }
  EXPECT_GT(unnoticed, 10);
}

TEST(DamagedRaster, WhatIsRemovedOrReplacedByNameIsReadAsItWas) {
  const TemporaryFolder folder;
  for (const std::string kind : {"NONE", "DEFLATE"}) {
    const std::string path = Write(folder / "removed.tif", kind);
    const ElevationSource source(path);
    fs::remove(path);
    ExpectHeights(source.Read());
    std::ofstream(path) << "something else";
    ExpectHeights(source.Read());
  }
}

bool WarnsOfGaps(const ElevationSource& source) {
  for (const std::string& warning : source.Info().warnings) {
    if (warning.find("blocks of it are left out") != std::string::npos) {
      return true;
    }
  }
  return false;
}

// As a program that ended while it wrote leaves them, too. GDAL gives zeros there.
TEST(DamagedRaster, BlocksThatAreNotInTheFileAreHoles) {
  const TemporaryFolder folder;
  const std::string path = folder / "sparse.tif";
  CPLStringList options;
  options.SetNameValue("SPARSE_OK", "TRUE");
  options.SetNameValue("TILED", "YES");
  options.SetNameValue("BLOCKXSIZE", "64");
  options.SetNameValue("BLOCKYSIZE", "64");
  GDALAllRegister();
  auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  auto* dataset = driver->Create(path.c_str(), 300, 200, 1, GDT_Float32, options.List());
  double place[] = {0, 1, 0, 0, 0, -1};
  dataset->SetGeoTransform(place);
  const auto written = [](int c, int r) { return (c / 64 + r / 64) % 3 != 1; };
  for (int r = 0; r < 200; r += 64) {
    for (int c = 0; c < 300; c += 64) {
      if (written(c, r)) {
        const int width = std::min(64, 300 - c);
        const int height = std::min(64, 200 - r);
        std::vector<float> block(std::size_t(width) * height, float(1000 + c + r));
        EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, c, r, width, height, block.data(),
                                                      width, height, GDT_Float32, 0, 0, nullptr),
                  CE_None);
      }
    }
  }
  GDALClose(dataset);
  const ElevationSource source(path);
  EXPECT_TRUE(WarnsOfGaps(source));
  for (const int factor : {1, 4}) {
    const std::vector<double> heights = source.ReadReduced({0, 0, 300, 200}, factor);
    const int columns = 1 + 299 / factor;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const int c = int(i) % columns * factor;
      const int r = int(i) / columns * factor;
      if (written(c, r)) {
        ASSERT_EQ(heights[i], 1000 + c / 64 * 64 + r / 64 * 64);
      } else {
        ASSERT_TRUE(std::isnan(heights[i])) << c << ", " << r;
      }
    }
  }
  EXPECT_TRUE(std::isnan(source.Read({70, 3, 1, 1})[0]));
  EXPECT_FALSE(WarnsOfGaps(ElevationSource(Write(folder / "whole.tif", "TILED"))));
}

// Level ground at height 0, which file systems keep as holes of the file.
TEST(DamagedRaster, ZerosThatAreInTheFileAreHeights) {
  const TemporaryFolder folder;
  const std::string path = folder / "level.tif";
  GDALAllRegister();
  auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  auto* dataset = driver->Create(path.c_str(), 512, 512, 1, GDT_Float32, nullptr);
  double place[] = {0, 1, 0, 0, 0, -1};
  dataset->SetGeoTransform(place);
  std::vector<float> zeros(512 * 512, 0.0f);
  EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, 512, 512, zeros.data(), 512, 512,
                                                GDT_Float32, 0, 0, nullptr),
            CE_None);
  GDALClose(dataset);
  const ElevationSource source(path);
  EXPECT_FALSE(WarnsOfGaps(source));
  for (const int factor : {1, 4}) {
    for (const double height : source.ReadReduced({0, 0, 512, 512}, factor)) {
      ASSERT_EQ(height, 0.0);
    }
  }
}

TEST(DamagedRaster, GapsOfAMosaicAreHoles) {
  const TemporaryFolder folder;
  const std::string left = Write(folder / "left.tif", "TILED");
  std::string vrt;
  {
    std::ifstream whole(WriteMosaic(folder / "gap.vrt", left, Write(folder / "right.tif", "NONE")));
    vrt.assign(std::istreambuf_iterator<char>(whole), {});
  }
  // Its right half begins 77 columns further, and the raster ends there.
  vrt.replace(vrt.find("xOff=\"400\""), 10, "xOff=\"477\"");
  vrt.replace(vrt.find("rasterXSize=\"800\""), 17, "rasterXSize=\"877\"");
  std::ofstream(folder / "gap.vrt") << vrt;
  const ElevationSource source(folder / "gap.vrt");
  const std::vector<double> heights = source.Read();
  for (int i = 0; i < 877 * 400; ++i) {
    const int c = i % 877;
    if (c >= 400 && c < 477) {
      ASSERT_TRUE(std::isnan(heights[i])) << c;
    } else {
      ASSERT_EQ(heights[i], float(HeightAt(c < 400 ? c : c - 477, i / 877))) << c;
    }
  }
}

// Nothing is there to draw, and every query says so.
TEST(DamagedRaster, AnEmptyRasterIsNaNAtEveryLevel) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 1000;
  file.height = 700;
  file.type = GDT_Int16;
  file.noData = 0.0;
  file.value = [](int, int, int) { return 0.0; };
  const auto source = std::make_shared<ElevationSource>(file.Write(folder / "empty.tif"));
  ElevationPyramid pyramid(std::make_shared<RasterPosts>(source));
  for (int level = 0; level < pyramid.Lattice().levels; ++level) {
    std::vector<float> heights(std::size_t(60) * 40, 0.0f);
    pyramid.Read({level, 0, 0, 60, 40}, heights.data());
    for (const float h : heights) {
      ASSERT_TRUE(std::isnan(h)) << level;
    }
  }
}

// The pyramid gives an error to who waits and goes on drawing what it has.
TEST(DamagedRaster, APyramidOfAFileThatShrinksKeepsWhatItHas) {
  const TemporaryFolder folder;
  const std::string path = Write(folder / "pyramid.tif", "DEFLATE");
  ElevationPyramidOptions options;
  options.retryDelay = 0.01;
  ElevationPyramid pyramid(std::make_shared<RasterPosts>(std::make_shared<ElevationSource>(path)),
                           options);
  std::vector<float> heights(100);
  pyramid.Read({2, 0, 0, 10, 10}, heights.data());
  fs::resize_file(path, fs::file_size(path) / 2);
  EXPECT_THROW(pyramid.Read({0, 380, 380, 10, 10}, heights.data()), Error);
  EXPECT_NE(pyramid.Statistics().lastFailure.find(path), std::string::npos);
  EXPECT_TRUE(pyramid.TryRead({2, 0, 0, 10, 10}, heights.data()));
  for (const float h : heights) {
    EXPECT_GE(h, 1000.0f);
  }
}

} // namespace
