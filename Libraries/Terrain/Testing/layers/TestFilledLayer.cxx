// Ground that is made up is marked where the raster has no data, and nowhere else.
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/layers/raster/FilledLayer.h>

#include "ColorBlocks.h"
#include "RasterFile.h"

namespace {

using dspace::ColorGrid;
using dspace::Crs;
using dspace::FilledLayerOptions;
using dspace::OpenFilledLayer;
using dspace::RasterPlace;
using dspace::RasterWindow;
using dspace::testing::GridAt;
using dspace::testing::RasterFile;
using dspace::testing::ReadTexels;
using dspace::testing::Texels;

constexpr double Hole = std::numeric_limits<double>::quiet_NaN();

bool IsHole(int column, int row) {
  return column >= 20 && column < 40 && row >= 10 && row < 30;
}

// 64 x 64 pixels of 1 m; texels are 4 m at zoom 0, 1 m at zoom 2, 0.25 m at zoom 4.
class Filled : public ::testing::Test {
protected:
  Filled() : Grid(GridAt(Crs(), {0.0, 64.0}, {4.0, -4.0})) {
    this->Place.name = "terrain 'ground'";
    this->Place.pixelToMap.linear() << 1.0, 0.0, 0.0, -1.0;
    this->Place.pixelToMap.translation() << 0.0, 64.0;
    this->Place.columns = this->Place.rows = 64;
  }
  std::string Raster(const std::string& name, double missing) {
    RasterFile file;
    file.width = file.height = 64;
    file.type = GDT_Float32;
    file.value = [missing](int c, int r, int) { return IsHole(c, r) ? missing : 5.0 + c; };
    file.geotransform = {{0.0, 1.0, 0.0, 64.0, 0.0, -1.0}};
    if (!std::isnan(missing)) {
      file.noData = missing;
    }
    return file.Write(this->Folder / name);
  }
  Texels Read(const dspace::ColorLayer& layer, int zoom, int size) {
    return ReadTexels(layer, this->Grid, {zoom, 0, 0, size, size});
  }

  dspace::testing::TemporaryFolder Folder;
  RasterPlace Place;
  ColorGrid Grid;
};

// How much of a hole from `from` to `to` is seen at x, straight between the pixels' middles.
double Ramp(double x, double from, double to) {
  return std::clamp(std::min(x - from + 0.5, to + 0.5 - x), 0.0, 1.0);
}

} // namespace

TEST_F(Filled, PixelsWithoutDataAreMarkedAndNoOthers) {
  for (const double missing : {-9999.0, Hole}) {
    const auto layer =
        OpenFilledLayer(this->Raster("holes.tif", missing), 1, this->Place, {0, 0, 64, 64});
    const Texels texels = this->Read(*layer, 2, 80); // 16 of them beyond the raster
    ASSERT_TRUE(texels.any);
    for (int y = 0; y < 80; ++y) {
      for (int x = 0; x < 80; ++x) {
        const std::uint8_t* p = texels.At(x, y);
        const int marked = IsHole(x, y) ? 255 : 0;
        ASSERT_EQ(p[3], marked) << x << ", " << y;
        ASSERT_EQ(p[0], marked);
        ASSERT_EQ(p[1], 0);
        ASSERT_EQ(p[2], marked);
      }
    }
    EXPECT_FALSE(ReadTexels(*layer, this->Grid, {2, 0, 40, 64, 20}).any);
  }
}

TEST_F(Filled, OpacityIsTheShareWithoutData) {
  const auto layer =
      OpenFilledLayer(this->Raster("holes.tif", Hole), 1, this->Place, {0, 0, 64, 64});
  // Columns 20 to 39 are texels 5 to 9; rows 10 and 11, 28 and 29 are halves of texels 2 and 7.
  const Texels far = this->Read(*layer, 0, 16);
  ASSERT_TRUE(far.any);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const double across = x >= 5 && x <= 9 ? 1.0 : 0.0;
      const double down = y == 2 || y == 7 ? 0.5 : y > 2 && y < 7 ? 1.0 : 0.0;
      EXPECT_NEAR(far.At(x, y)[3], 255.0 * across * down, 0.51) << x << ", " << y;
    }
  }
  const Texels near = this->Read(*layer, 4, 256);
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const double share = Ramp((x + 0.5) / 4.0, 20.0, 40.0) * Ramp((y + 0.5) / 4.0, 10.0, 30.0);
      ASSERT_NEAR(near.At(x, y)[3], 255.0 * share, 0.51) << x << ", " << y;
    }
  }
}

TEST_F(Filled, AWindowIsWhereItsPixelsAre) {
  this->Place.pixelToMap.translation() << 16.0, 56.0;
  this->Place.columns = this->Place.rows = 48;
  const auto layer =
      OpenFilledLayer(this->Raster("holes.tif", Hole), 1, this->Place, {16, 8, 48, 48});
  const Texels texels = this->Read(*layer, 2, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      ASSERT_EQ(texels.At(x, y)[3], IsHole(x, y) ? 255 : 0) << x << ", " << y;
    }
  }
}

TEST_F(Filled, GroundOfAPatchIsNotMarked) {
  RasterFile patch;
  patch.width = 20;
  patch.height = 64;
  patch.type = GDT_Float32;
  patch.value = [](int, int, int) { return 7.0; };
  patch.geotransform = {{30.0, 1.0, 0.0, 64.0, 0.0, -1.0}};
  RasterFile beside = patch;
  beside.geotransform = {{3000.0, 1.0, 0.0, 64.0, 0.0, -1.0}};
  const auto layer =
      OpenFilledLayer(this->Raster("holes.tif", Hole), 1, this->Place, {0, 0, 64, 64}, {},
                      {{patch.Write(this->Folder / "patch.tif"), 1, std::nullopt},
                       {beside.Write(this->Folder / "beside.tif"), 1, std::nullopt}});
  const Texels texels = this->Read(*layer, 2, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      ASSERT_EQ(texels.At(x, y)[3], IsHole(x, y) && x < 30 ? 255 : 0) << x << ", " << y;
    }
  }
}

TEST_F(Filled, BadColoursAreRejected) {
  const std::string path = this->Raster("holes.tif", Hole);
  for (const double bad : {-0.1, 1.1, Hole}) {
    FilledLayerOptions options;
    options.color[1] = bad;
    EXPECT_THROW(OpenFilledLayer(path, 1, this->Place, {0, 0, 64, 64}, options), dspace::Error);
  }
}
