// What an image's pixels are as texels: opacity, masks, palettes, bits, overviews; and rejections.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/layers/raster/ImageLayer.h>

#include "ColorBlocks.h"
#include "RasterFile.h"

namespace {

using dspace::ColorGrid;
using dspace::ColorLayer;
using dspace::Crs;
using dspace::Error;
using dspace::RasterLayerOptions;
using dspace::RasterPlace;
using dspace::testing::GridAt;
using dspace::testing::RasterFile;
using dspace::testing::ReadTexels;
using dspace::testing::Texels;

using Texel = std::array<int, 4>;

// Pixels of 1 m, of zoom 2 one a texel: texels of zoom 1 are means of four, of zoom 0 of sixteen.
class Pixels : public ::testing::Test {
protected:
  Pixels() : Grid(GridAt(Crs(), {0.0, 64.0}, {4.0, -4.0})) {
    this->Place.name = "terrain 'ground'";
    this->Place.pixelToMap.linear() << 1.0, 0.0, 0.0, -1.0;
    this->Place.pixelToMap.translation() << 0.0, 64.0;
    this->Place.columns = this->Place.rows = 64;
  }
  template<class F> RasterFile File(int bands, GDALDataType type, F value) {
    RasterFile file;
    file.width = file.height = 64;
    file.bands = bands;
    file.type = type;
    file.value = value;
    file.geotransform = {{0.0, 1.0, 0.0, 64.0, 0.0, -1.0}};
    return file;
  }
  std::shared_ptr<const ColorLayer> Open(const std::string& path,
                                         const RasterLayerOptions& options = {}) {
    return OpenImageLayer(path, this->Place, options);
  }
  Texel At(const ColorLayer& layer, int zoom, int column, int row) {
    const Texels texels = ReadTexels(layer, this->Grid, {zoom, column, row, 1, 1});
    return texels.any ? Texel{texels.rgba[0], texels.rgba[1], texels.rgba[2], texels.rgba[3]}
                      : Texel{-1, -1, -1, -1};
  }
  std::pair<Error::Kind, std::string> Rejection(const std::function<void()>& call) {
    testing::internal::CaptureStderr();
    std::pair<Error::Kind, std::string> rejection(Error::Kind::Internal, "");
    try {
      call();
    } catch (const Error& error) {
      rejection = {error.GetKind(), error.what()};
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    return rejection;
  }

  dspace::testing::TemporaryFolder Folder;
  RasterPlace Place;
  ColorGrid Grid;
};

} // namespace

TEST_F(Pixels, MeansAreWeightedByOpacity) {
  // Every other column is clear, and white where nobody must see it; others 200, 100, 50.
  const auto value = [](int c, int, int b) {
    return c % 2 ? (b < 3 ? 255.0 : 0.0) : std::array<double, 4>{200.0, 100.0, 50.0, 255.0}[b];
  };
  const auto layer = this->Open(this->File(4, GDT_Byte, value).Write(this->Folder / "a.tif"));
  EXPECT_EQ(this->At(*layer, 2, 6, 6), (Texel{200, 100, 50, 255}));
  const Texels clear = ReadTexels(*layer, this->Grid, {2, 7, 6, 2, 1});
  EXPECT_EQ(std::vector<int>(clear.rgba.begin(), clear.rgba.begin() + 4),
            (std::vector<int>{0, 0, 0, 0}));
  for (int zoom : {0, 1})
    EXPECT_EQ(this->At(*layer, zoom, 3, 3), (Texel{200, 100, 50, 128})) << zoom;
  const Texels fine = ReadTexels(*layer, this->Grid, {5, 100, 100, 64, 64});
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      // Opacity falls linearly from the middle of one pixel to that of the next.
      const double column = (100 + x + 0.5) / 8.0 - 0.5;
      const double opacity = std::abs(std::fmod(column, 2.0) - 1.0);
      EXPECT_NEAR(fine.At(x, y)[3], 255.0 * opacity, 0.6);
      EXPECT_EQ(fine.At(x, y)[0], 200); // no fringe
      EXPECT_EQ(fine.At(x, y)[2], 50);
    }
  EXPECT_EQ(layer->Warnings().size(), 0u);
}

TEST_F(Pixels, GreyBitsAndBands) {
  const auto ramp = [](int c, int r, int b) { return (c * 64 + r) * 16.0 + b; };
  const auto deep = this->Open(this->File(1, GDT_UInt16, ramp).Write(this->Folder / "deep.tif"));
  for (int c : {0, 7, 31, 63}) {
    const int grey = int(std::lround(ramp(c, 5, 0) / 257.0));
    EXPECT_EQ(this->At(*deep, 2, c, 5), (Texel{grey, grey, grey, 255}));
  }
  const auto opacity = [](int c, int, int b) { return b == 0 ? 90.0 : 4.0 * c; };
  const auto grey = this->Open(this->File(2, GDT_Byte, opacity).Write(this->Folder / "ga.tif"));
  EXPECT_EQ(this->At(*grey, 2, 31, 1), (Texel{90, 90, 90, 124}));
  EXPECT_EQ(this->At(*grey, 1, 15, 1), (Texel{90, 90, 90, 122}));
}

TEST_F(Pixels, NoDataIsTransparentWhereAllBandsHaveIt) {
  // Pure green and pure blue have no-data in some bands; black has it in all.
  const auto value = [](int c, int, int b) {
    return c % 3 == 2 ? 0.0 : c % 3 == b - 1 ? 99.0 : 0.0;
  };
  RasterFile file = this->File(3, GDT_Byte, value);
  file.noData = 0.0;
  const auto layer = this->Open(file.Write(this->Folder / "nodata.tif"));
  EXPECT_EQ(this->At(*layer, 2, 30, 1), (Texel{0, 99, 0, 255}));
  EXPECT_EQ(this->At(*layer, 2, 31, 1), (Texel{0, 0, 99, 255}));
  EXPECT_EQ(this->At(*layer, 2, 32, 1), (Texel{-1, -1, -1, -1}));
}

TEST_F(Pixels, MasksAndPalettes) {
  GDALAllRegister();
  auto* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  auto* dataset = memory->Create("", 64, 64, 1, GDT_Byte, nullptr);
  GDALColorTable table;
  const GDALColorEntry entries[] = {{10, 20, 30, 255}, {200, 100, 0, 255}, {7, 7, 7, 0}};
  for (int i = 0; i < 3; ++i)
    table.SetColorEntry(i, &entries[i]);
  dataset->GetRasterBand(1)->SetColorTable(&table);
  std::vector<std::uint8_t> row(64);
  for (int r = 0; r < 64; ++r) {
    for (int c = 0; c < 64; ++c)
      row[c] = std::uint8_t(c / 2 % 2 ? 2 : c % 2);
    ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, r, 64, 1, row.data(), 64, 1,
                                                  GDT_Byte, 0, 0, nullptr),
              CE_None);
  }
  const std::string png = this->Folder / "palette.png";
  GDALClose(GetGDALDriverManager()->GetDriverByName("PNG")->CreateCopy(png.c_str(), dataset, false,
                                                                       nullptr, nullptr, nullptr));
  GDALClose(dataset);
  const auto palette = this->Open(png); // stretched over the terrain, which is of its size
  ASSERT_EQ(palette->Warnings().size(), 1u);
  EXPECT_EQ(this->At(*palette, 2, 4, 9), (Texel{10, 20, 30, 255}));
  EXPECT_EQ(this->At(*palette, 2, 5, 9), (Texel{200, 100, 0, 255}));
  EXPECT_EQ(this->At(*palette, 2, 6, 9), (Texel{-1, -1, -1, -1}));
  EXPECT_EQ(this->At(*palette, 1, 2, 4), (Texel{105, 60, 15, 255})); // colours, not indices
  EXPECT_EQ(this->At(*palette, 0, 2, 4), (Texel{105, 60, 15, 128}));

  const std::string masked = this->File(3, GDT_Byte, [](int, int, int b) { return 50.0 + b; })
                                 .Write(this->Folder / "m.tif");
  CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
  auto* file = static_cast<GDALDataset*>(GDALOpen(masked.c_str(), GA_Update));
  ASSERT_EQ(file->CreateMaskBand(GMF_PER_DATASET), CE_None);
  for (int r = 0; r < 64; ++r) {
    std::fill(row.begin(), row.end(), std::uint8_t(r < 32 ? 255 : 0));
    ASSERT_EQ(file->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, r, 64, 1, row.data(), 64,
                                                              1, GDT_Byte, 0, 0, nullptr),
              CE_None);
  }
  GDALClose(file);
  CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr);
  const auto half = this->Open(masked);
  EXPECT_EQ(this->At(*half, 2, 1, 31), (Texel{50, 51, 52, 255}));
  EXPECT_EQ(this->At(*half, 2, 1, 32), (Texel{-1, -1, -1, -1}));
}

TEST_F(Pixels, WhatAFileLeavesOutIsTransparent) {
  GDALAllRegister();
  const char* const options[] = {"SPARSE_OK=TRUE", "TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16",
                                 nullptr};
  const std::string path = this->Folder / "sparse.tif";
  auto* file = GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path.c_str(), 64, 64, 3, GDT_Byte, const_cast<char**>(options));
  std::vector<std::uint8_t> block(16 * 16 * 3, 80);
  ASSERT_EQ(file->RasterIO(GF_Write, 16, 32, 16, 16, block.data(), 16, 16, GDT_Byte, 3, nullptr, 0,
                           0, 0, nullptr),
            CE_None);
  GDALClose(file);
  const auto layer = this->Open(path);
  EXPECT_EQ(this->At(*layer, 2, 16, 47), (Texel{80, 80, 80, 255}));
  EXPECT_EQ(this->At(*layer, 2, 32, 47), (Texel{-1, -1, -1, -1}));
  EXPECT_EQ(this->At(*layer, 2, 16, 31), (Texel{-1, -1, -1, -1}));
}

TEST_F(Pixels, OverviewsAreRead) {
  const std::string path = this->File(3, GDT_Byte, [](int, int, int b) { return 40.0 * b; })
                               .Write(this->Folder / "o.tif");
  int factors[] = {2, 4};
  auto* file = static_cast<GDALDataset*>(GDALOpen(path.c_str(), GA_Update));
  ASSERT_EQ(file->BuildOverviews("AVERAGE", 2, factors, 0, nullptr, nullptr, nullptr), CE_None);
  for (int b = 1; b <= 3; ++b) // so that they are told from the pixels
    ASSERT_EQ(file->GetRasterBand(b)->GetOverview(0)->Fill(40.0 * b + 100.0), CE_None);
  GDALClose(file);
  const auto layer = this->Open(path);
  EXPECT_EQ(this->At(*layer, 2, 9, 9), (Texel{0, 40, 80, 255}));
  EXPECT_EQ(this->At(*layer, 0, 9, 9), (Texel{140, 180, 220, 255}));
}

TEST_F(Pixels, RejectionsNameTheFile) {
  const auto rejected = [&](const std::string& path, Error::Kind kind, const std::string& words,
                            const RasterLayerOptions& options = {}) {
    const auto [was, message] = this->Rejection([&] { this->Open(path, options); });
    EXPECT_EQ(was, kind) << path << " " << message;
    EXPECT_NE(message.find("image '" + path + "'"), std::string::npos) << message;
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  const auto one = [](int, int, int) { return 1.0; };
  rejected(this->Folder / "absent.tif", Error::Kind::NotFound, "");
  const std::string text = this->Folder / "text.png";
  std::ofstream(text) << "no picture";
  rejected(text, Error::Kind::Unsupported, "not recognized");
  rejected(this->File(1, GDT_Float32, one).Write(this->Folder / "f.tif"), Error::Kind::Unsupported,
           "false colour");
  rejected(this->File(5, GDT_Byte, one).Write(this->Folder / "5.tif"), Error::Kind::Unsupported,
           "5 bands");
  const std::string good = this->File(3, GDT_Byte, one).Write(this->Folder / "good.tif");
  RasterLayerOptions options;
  options.extent = {{0.0, 5.0, 0.0, 1.0}};
  rejected(good, Error::Kind::InvalidArgument, "extent", options);
  options.extent = {{500.0, 5.0, 510.0, 1.0}};
  rejected(good, Error::Kind::InvalidArgument, "does not overlap terrain 'ground'", options);
  options = {};
  options.network.retries = 11;
  rejected(good, Error::Kind::InvalidArgument, "retries", options);
  this->Place.crs = Crs::FromText("IAU_2015:49910"); // Mars
  options = {};
  options.crs = "IAU_2015:30110"; // the Moon
  rejected(good, Error::Kind::Unsupported, "another body", options);
  RasterFile bent = this->File(3, GDT_Byte, one);
  bent.geotransform = {{0.0, 1.0, 2.0, 64.0, 1.0, 2.0}};
  rejected(bent.Write(this->Folder / "bent.tif"), Error::Kind::InvalidArgument, "degenerate");
}

TEST_F(Pixels, AFileThatIsCutOrChangesIsAnError) {
  const auto value = [](int c, int r, int) { return double((c * 31 + r * 17) % 256); };
  const std::string path = this->File(3, GDT_Byte, value).Write(this->Folder / "cut.tif");
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const auto cut = this->Open(path);
  for (int i = 0; i < 2; ++i) // not black the second time either
    EXPECT_EQ(this->Rejection([&] { this->At(*cut, 0, 2, 15); }).first, Error::Kind::Corrupt);
  const std::string other = this->File(3, GDT_Byte, value).Write(this->Folder / "other.tif");
  const auto changed = this->Open(other);
  std::filesystem::resize_file(other, std::filesystem::file_size(other) + 1);
  const auto [kind, message] = this->Rejection([&] { this->At(*changed, 0, 2, 2); });
  EXPECT_EQ(kind, Error::Kind::Io);
  EXPECT_NE(message.find("has changed"), std::string::npos) << message;
}
