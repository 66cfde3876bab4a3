// TIFFs of one strip that covers the whole file. GDAL splits such strips into lines, and its bands
// fail after a question about where a line lies.
#include <cmath>
#include <vector>

#include <cpl_string.h>
#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/raster/ElevationSource.h>
#include <dspace/raster/OpenRaster.h>
#include <dspace/raster/TiffBlocks.h>

#include "RasterFile.h"

namespace {

using namespace dspace;
using dspace::testing::TemporaryFolder;

constexpr int Columns = 40;
constexpr int Rows = 2600; // GDAL splits strips of more than 2000 rows

// 0 or 1, without a pattern that lines could share.
unsigned char Value(int column, int row) {
  return ((unsigned(column) * 2654435761U + unsigned(row) * 40503U) >> 7) & 1U;
}

std::string WriteStrip(const std::string& path, int columns, int rows,
                       const std::vector<const char*>& settings) {
  GDALAllRegister();
  CPLStringList options;
  for (const char* setting : settings) {
    options.AddString(setting);
  }
  if (options.FetchNameValue("BLOCKYSIZE") == nullptr) {
    options.SetNameValue("BLOCKYSIZE", std::to_string(rows).c_str());
  }
  auto* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  auto* file = driver->Create(path.c_str(), columns, rows, 1, GDT_Byte, options.List());
  std::array<double, 6> g = {0, 1, 0, 0, 0, -1};
  file->SetGeoTransform(g.data());
  std::vector<unsigned char> line(static_cast<std::size_t>(columns));
  for (int row = 0; row < rows && columns == Columns; ++row) {
    for (int column = 0; column < columns; ++column) {
      line[std::size_t(column)] = Value(column, row);
    }
    EXPECT_EQ(file->GetRasterBand(1)->RasterIO(GF_Write, 0, row, columns, 1, line.data(), columns,
                                               1, GDT_Byte, 0, 0, nullptr),
              CE_None);
  }
  GDALClose(file);
  return path;
}

class OneStrip : public ::testing::TestWithParam<std::vector<const char*>> {};

TEST_P(OneStrip, GivesEveryValueInAnyOrder) {
  const TemporaryFolder folder;
  const ElevationSource source(WriteStrip(folder / "strip.tif", Columns, Rows, GetParam()));
  for (const std::string& warning : source.Info().warnings) {
    EXPECT_EQ(warning.find("left out"), std::string::npos) << warning;
  }
  for (const int row : {0, 1, 2000, 52, 2599, 51, 1300}) {
    const std::vector<double> line = source.Read({0, row, Columns, 1});
    for (int column = 0; column < Columns; ++column) {
      EXPECT_EQ(line[std::size_t(column)], Value(column, row)) << column << ", " << row;
    }
  }
  const std::vector<double> all = source.Read();
  int wrong = 0;
  for (int i = 0; i < Columns * Rows; ++i) {
    wrong += all[std::size_t(i)] == Value(i % Columns, i / Columns) ? 0 : 1;
  }
  EXPECT_EQ(wrong, 0);
}

TEST_P(OneStrip, HasNoGaps) {
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  const DatasetPointer file =
      OpenRaster(WriteStrip(folder / "strip.tif", Columns, Rows, GetParam()), {}, warnings);
  GDALRasterBand& band = *file->GetRasterBand(1);
  EXPECT_FALSE(LeavesBlocksOut(band, {0, 0, Columns, Rows}));
  std::vector<std::uint8_t> mask(Columns * Rows, 255);
  MaskGaps(band, {0, 0, Columns, Rows}, Columns, Rows, Columns, mask.data());
  EXPECT_EQ(mask, std::vector<std::uint8_t>(Columns * Rows, 255));
  std::vector<unsigned char> pixel(1);
  ASSERT_EQ(band.RasterIO(GF_Read, 3, 2500, 1, 1, pixel.data(), 1, 1, GDT_Byte, 0, 0, nullptr),
            CE_None);
  EXPECT_EQ(pixel[0], Value(3, 2500));
}

INSTANTIATE_TEST_SUITE_P(Compressions, OneStrip,
                         ::testing::Values(std::vector<const char*>{"COMPRESS=DEFLATE"},
                                           std::vector<const char*>{"COMPRESS=LZW"},
                                           std::vector<const char*>{"COMPRESS=NONE"},
                                           std::vector<const char*>{"COMPRESS=DEFLATE", "NBITS=1"},
                                           std::vector<const char*>{"COMPRESS=CCITTFAX4",
                                                                    "NBITS=1"}));

TEST(OneStrip, IsMeasuredAsAWhole) {
  const TemporaryFolder folder;
  // 400 MB in a file of a few kB.
  const std::string path =
      WriteStrip(folder / "strip.tif", 20000, 20000, {"COMPRESS=DEFLATE", "SPARSE_OK=TRUE"});
  try {
    const ElevationSource source(path);
    FAIL() << "it was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Resource);
    EXPECT_NE(std::string(error.what()).find("20000 x 20000 pixels of 1 bytes"), std::string::npos)
        << error.what();
  }
}

TEST(TiffBlocks, AreFoundWhereTheyAre) {
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  const DatasetPointer file = OpenRaster(
      WriteStrip(folder / "strip.tif", Columns, Rows, {"COMPRESS=NONE", "BLOCKYSIZE=100"}), {},
      warnings);
  GDALRasterBand& band = *file->GetRasterBand(1);
  ASSERT_EQ(TiffBlocksOf(band), TiffBlocks::Known);
  std::FILE* bytes = std::fopen((folder / "strip.tif").c_str(), "rb");
  ASSERT_NE(bytes, nullptr);
  for (const int row : {0, 7, 25}) {
    EXPECT_EQ(TiffBlockSize(band, 0, row), 4000u);
    std::vector<unsigned char> pixels(4000);
    ASSERT_EQ(std::fseek(bytes, long(TiffBlockOffset(band, 0, row)), SEEK_SET), 0);
    ASSERT_EQ(std::fread(pixels.data(), 1, pixels.size(), bytes), pixels.size());
    for (int i = 0; i < 4000; ++i) {
      ASSERT_EQ(pixels[std::size_t(i)], Value(i % Columns, row * 100 + i / Columns));
    }
  }
  std::fclose(bytes);
}

} // namespace
