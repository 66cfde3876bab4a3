// Values through a colour ramp: means first, colours afterwards.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/layers/raster/FalseColorLayer.h>
#include <dspace/layers/raster/ImageLayer.h>

#include "ColorBlocks.h"
#include "RasterFile.h"
#include "TestData.h"

namespace {

using dspace::ColorGrid;
using dspace::Crs;
using dspace::Error;
using dspace::FalseColorOptions;
using dspace::RasterPlace;
using dspace::testing::GridAt;
using dspace::testing::MiddleOf;
using dspace::testing::RasterFile;
using dspace::testing::ReadTexels;
using dspace::testing::Texels;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

class FalseColor : public ::testing::Test {
protected:
  FalseColor() : Grid(GridAt(Crs(), {0.0, 64.0}, {4.0, -4.0})) {
    this->Place.name = "terrain 'ground'";
    this->Place.pixelToMap.linear() << 1.0, 0.0, 0.0, -1.0;
    this->Place.pixelToMap.translation() << 0.0, 64.0;
    this->Place.columns = this->Place.rows = 64;
  }
  template<class F> RasterFile File(GDALDataType type, F value) {
    RasterFile file;
    file.width = file.height = 64;
    file.type = type;
    file.value = value;
    file.geotransform = {{0.0, 1.0, 0.0, 64.0, 0.0, -1.0}};
    return file;
  }
  std::array<int, 4> At(const dspace::ColorLayer& layer, int zoom, int column, int row) {
    const Texels texels = ReadTexels(layer, this->Grid, {zoom, column, row, 1, 1});
    return {texels.rgba[0], texels.rgba[1], texels.rgba[2], texels.rgba[3]};
  }

  dspace::testing::TemporaryFolder Folder;
  RasterPlace Place;
  ColorGrid Grid;
};

using ColorTexel = std::array<int, 4>;

} // namespace

TEST_F(FalseColor, ValuesAreMeansBeforeTheyAreColoured) {
  // -20 and 20 by turns; black to white to black: their mean is white, that of their colours black.
  FalseColorOptions colors;
  colors.ramp = {{0, 0, 0}, {1, 1, 1}, {0, 0, 0}};
  const auto value = [](int c, int, int) { return c % 2 ? 20.0 : -20.0; };
  const auto layer = OpenFalseColorLayer(
      this->File(GDT_Int16, value).Write(this->Folder / "turns.tif"), this->Place, colors);
  EXPECT_EQ(layer->Range()[0], -20.0);
  EXPECT_EQ(layer->Range()[1], 20.0);
  EXPECT_EQ(this->At(*layer, 2, 4, 4), (ColorTexel{0, 0, 0, 255}));
  EXPECT_EQ(this->At(*layer, 2, 5, 4), (ColorTexel{0, 0, 0, 255}));
  EXPECT_EQ(this->At(*layer, 1, 4, 4), (ColorTexel{255, 255, 255, 255}));
  const Texels fine = ReadTexels(*layer, this->Grid, {6, 700, 700, 40, 1});
  for (int x = 0; x < 40; ++x) { // between two pixels the values in between
    const double column = (700 + x + 0.5) / 16.0 - 0.5;
    const double v = 40.0 * std::abs(std::fmod(column, 2.0) - 1.0) - 20.0;
    EXPECT_NEAR(fine.At(x, 0)[0], 255.0 * (1.0 - std::abs(v) / 20.0), 0.6);
  }
}

TEST_F(FalseColor, ScaleOffsetNoDataAndEnds) {
  RasterFile file =
      this->File(GDT_UInt16, [](int c, int r, int) { return r == 3 ? 65535.0 : 100.0 + c; });
  file.scale = 0.5;
  file.offset = -30.0;
  file.noData = 65535.0;
  file.unit = "K";
  FalseColorOptions colors;
  colors.ramp = {{0, 0, 1}, {1, 0.5, 0}};
  const std::string path = file.Write(this->Folder / "scaled.tif");
  const auto all = OpenFalseColorLayer(path, this->Place, colors);
  EXPECT_EQ(all->Unit(), "K");
  EXPECT_EQ(all->Range()[0], 20.0); // 0.5 * 100 - 30
  EXPECT_EQ(all->Range()[1], 51.5);
  EXPECT_TRUE(all->Warnings().empty());
  EXPECT_EQ(this->At(*all, 2, 0, 0), (ColorTexel{0, 0, 255, 255}));
  EXPECT_EQ(this->At(*all, 2, 63, 0), (ColorTexel{255, 128, 0, 255}));
  EXPECT_FALSE(ReadTexels(*all, this->Grid, {2, 5, 3, 1, 1}).any);
  const ColorTexel edge =
      this->At(*all, 1, 15, 1); // rows 2 and 3: half of it, its colour that of row 2
  EXPECT_EQ(edge[3], 128);
  EXPECT_NEAR(edge[0], 255.0 * 30.5 / 63.0, 0.51);
  colors.low = 30.0;
  colors.high = 40.0;
  const auto some = OpenFalseColorLayer(path, this->Place, colors);
  EXPECT_EQ(this->At(*some, 2, 0, 0),
            (ColorTexel{0, 0, 255, 255})); // beyond the ends their colours
  EXPECT_EQ(this->At(*some, 2, 63, 0), (ColorTexel{255, 128, 0, 255}));
  EXPECT_EQ(this->At(*some, 2, 30, 0), (ColorTexel{128, 64, 128, 255})); // 35
}

TEST_F(FalseColor, LargeValuesKeepTheirDigits) {
  // Steps of 0.01 at a hundred million: a float has steps of 8 there.
  const auto value = [](int c, int, int) { return c == 9 ? NaN : 1e8 + 0.01 * c; };
  FalseColorOptions colors;
  colors.ramp = {{0, 0, 0}, {1, 1, 1}};
  const auto layer = OpenFalseColorLayer(
      this->File(GDT_Float64, value).Write(this->Folder / "large.tif"), this->Place, colors);
  EXPECT_EQ(layer->Range()[0], 1e8);
  EXPECT_NEAR(layer->Range()[1], 1e8 + 0.63, 2e-8);
  for (int c : {0, 13, 40, 63})
    EXPECT_NEAR(this->At(*layer, 2, c, 7)[0], 255.0 * c / 63.0, 0.51);
  EXPECT_FALSE(ReadTexels(*layer, this->Grid, {2, 9, 3, 1, 1}).any);
}

TEST_F(FalseColor, OneValueHasTheMiddlesColour) {
  const auto layer = OpenFalseColorLayer(
      this->File(GDT_Byte, [](int, int, int) { return 7.0; }).Write(this->Folder / "one.tif"),
      this->Place, {1, {{0, 0, 0}, {1, 1, 1}}, {}, {}});
  EXPECT_EQ(this->At(*layer, 2, 9, 9), (ColorTexel{128, 128, 128, 255}));
  EXPECT_EQ(layer->Warnings().size(), 1u);
}

TEST_F(FalseColor, RejectionsNameTheFile) {
  const std::string path =
      this->File(GDT_Int16, [](int c, int, int) { return c; }).Write(this->Folder / "r.tif");
  const auto rejected = [&](const std::function<void(FalseColorOptions&)>& change) {
    FalseColorOptions colors;
    change(colors);
    try {
      OpenFalseColorLayer(path, this->Place, colors);
    } catch (const Error& error) {
      EXPECT_EQ(error.GetObjectName(), "raster '" + path + "'") << error.what();
      return error.GetKind() == Error::Kind::InvalidArgument;
    }
    return false;
  };
  EXPECT_FALSE(rejected([](auto&) {}));
  EXPECT_TRUE(rejected([](auto& o) { o.band = 0; }));
  EXPECT_TRUE(rejected([](auto& o) { o.band = 2; }));
  EXPECT_TRUE(rejected([](auto& o) { o.ramp.clear(); }));
  EXPECT_TRUE(rejected([](auto& o) { o.ramp = {{0, 0, 1.5}}; }));
  EXPECT_TRUE(rejected([](auto& o) { o.ramp = {{NaN, 0, 1}}; }));
  EXPECT_TRUE(rejected([](auto& o) { o.low = NaN; }));
  EXPECT_TRUE(rejected([](auto& o) { o.low = 64.0; })); // above its greatest
  EXPECT_TRUE(rejected([](auto& o) { o.low = 5.0, o.high = 5.0; }));
  RasterFile none = this->File(GDT_Int16, [](int, int, int) { return 3; });
  none.noData = 3.0;
  const std::string empty = none.Write(this->Folder / "none.tif");
  try {
    OpenFalseColorLayer(empty, this->Place, {});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Corrupt);
  }
}

TEST_F(FalseColor, HeightsOfMarsUnderTheirOwnGrid) {
  DSPACE_REAL_DATA(mola, "terrain/mars_mola_megt90n000cb_4ppd_m.tif");
  RasterPlace place;
  place.name = "terrain 'mars'";
  place.crs = Crs::FromText("IAU_2015:49900");
  place.pixelToMap.linear() << 0.25, 0.0, 0.0, -0.25;
  place.pixelToMap.translation() << 0.0, 90.0;
  place.columns = 1440;
  place.rows = 720;
  FalseColorOptions colors;
  colors.ramp = {{0, 0, 0}, {1, 1, 1}};
  const auto layer = OpenFalseColorLayer(mola, place, colors);
  auto* file = static_cast<GDALDataset*>(GDALOpen(mola.c_str(), GA_ReadOnly));
  double range[2];
  ASSERT_EQ(GDALComputeRasterMinMax(file->GetRasterBand(1), false, range), CE_None);
  EXPECT_EQ(layer->Range()[0], range[0]);
  EXPECT_EQ(layer->Range()[1], range[1]);
  std::vector<float> heights(1440 * 720);
  ASSERT_EQ(file->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 1440, 720, heights.data(), 1440, 720,
                                             GDT_Float32, 0, 0, nullptr),
            CE_None);
  GDALClose(file);
  // Texels that are its pixels, across longitude 0, where it begins.
  ColorGrid grid = GridAt(place.crs, {-180.0, 90.0}, {0.25, -0.25});
  grid.extent.extend(Eigen::Vector2d(1440.0, 720.0));
  const Texels texels = ReadTexels(*layer, grid, {0, 700, 300, 40, 40});
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      const double height = heights[std::size_t(300 + y) * 1440 + (700 + x + 720) % 1440];
      EXPECT_NEAR(texels.At(x, y)[0], 255.0 * (height - range[0]) / (range[1] - range[0]), 0.51);
    }
}
