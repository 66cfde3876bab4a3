// Where the pixels of images come to lie as texels, against functions of the place.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/layers/raster/ImageLayer.h>

#include "ColorBlocks.h"
#include "Grids.h"
#include "RasterFile.h"

namespace {

using dspace::ColorBlock;
using dspace::ColorGrid;
using dspace::Crs;
using dspace::RasterLayerOptions;
using dspace::RasterPlace;
using dspace::testing::GlobeGrid;
using dspace::testing::GridAt;
using dspace::testing::MiddleOf;
using dspace::testing::RasterFile;
using dspace::testing::ReadTexels;
using dspace::testing::Texels;

const char* const Plane = "+proj=eqc +R=1737400 +type=crs";
const char* const Degrees = "+proj=longlat +R=1737400 +no_defs +type=crs";
const char* const Polar = "+proj=stere +lat_0=90 +lon_0=0 +R=1737400 +type=crs";
const char* const South = "+proj=stere +lat_0=-90 +lon_0=0 +R=1737400 +type=crs";
constexpr double Radius = 1737400.0;

RasterPlace PlaceOfGround(const char* crs, double left, double top, double pixel, int columns,
                          int rows) {
  RasterPlace place;
  place.name = "terrain 'ground'";
  place.crs = Crs::FromText(crs);
  place.pixelToMap.linear() << pixel, 0.0, 0.0, -pixel;
  place.pixelToMap.translation() << left, top;
  place.columns = columns;
  place.rows = rows;
  return place;
}

Eigen::Vector3d Direction(double lon_deg, double lat_deg) {
  const double lon = lon_deg * M_PI / 180.0, lat = lat_deg * M_PI / 180.0;
  return {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
}

// Smooth everywhere on a body, poles and date line as well.
Eigen::Vector3d Sky(const Eigen::Vector3d& direction) {
  return Eigen::Vector3d::Constant(127.5) + 120.0 * direction;
}

class Images : public ::testing::Test {
protected:
  // Unaligned with everything: 120 x 90 pixels of 10 m, red rises to the east, green to the north.
  RasterFile Sloped() {
    RasterFile file;
    file.width = 120;
    file.height = 90;
    file.bands = 3;
    file.type = GDT_UInt16;
    file.value = [](int c, int r, int b) {
      const Eigen::Vector2d map(1003.0 + 10.0 * (c + 0.5), 5007.0 - 10.0 * (r + 0.5));
      return std::round(257.0 * Slope(map, b));
    };
    file.geotransform = {{1003.0, 10.0, 0.0, 5007.0, 0.0, -10.0}};
    file.crs = Plane;
    return file;
  }
  static double Slope(const Eigen::Vector2d& map, int band) {
    return band == 0 ? (map.x() - 1000.0) / 5.0 : band == 1 ? (map.y() - 4100.0) / 5.0 : 77.0;
  }

  // A whole body, `pixel` degrees a pixel.
  std::string Globe(double left, double pixel = 1.0) {
    RasterFile file;
    file.width = int(std::round(360.0 / pixel));
    file.height = file.width / 2;
    file.bands = 3;
    file.type = GDT_UInt16;
    file.value = [=](int c, int r, int b) {
      return std::round(257.0 *
                        Sky(Direction(left + pixel * (c + 0.5), 90.0 - pixel * (r + 0.5)))[b]);
    };
    file.geotransform = {{left, pixel, 0.0, 90.0, 0.0, -pixel}};
    file.crs = Degrees;
    return file.Write(this->Folder / ("globe" + std::to_string(int(left)) + ".tif"));
  }

  dspace::testing::TemporaryFolder Folder;
};

// The greatest difference of a channel from Sky() over a block all of which must be opaque.
double WorstOfSky(const dspace::ColorLayer& layer, const ColorGrid& grid, const ColorBlock& block,
                  const std::function<Eigen::Vector3d(const Eigen::Vector2d&)>& directionOf) {
  const Texels texels = ReadTexels(layer, grid, block);
  EXPECT_TRUE(texels.any);
  double worst = 0.0;
  int clear = 0;
  for (int y = 0; y < block.height; ++y)
    for (int x = 0; x < block.width; ++x) {
      const Eigen::Vector3d sky = Sky(directionOf(MiddleOf(grid, block, x, y)));
      for (int k = 0; k < 3; ++k)
        worst = std::max(worst, std::abs(texels.At(x, y)[k] - sky[k]));
      clear += texels.At(x, y)[3] != 255;
    }
  EXPECT_EQ(clear, 0);
  return worst;
}

Eigen::Vector3d OfDegrees(const Eigen::Vector2d& map) {
  return Direction(map.x(), map.y());
}

// Snyder 1987, p. 158: rho = 2 R tan((90 - lat) / 2).
Eigen::Vector3d OfPolar(const Eigen::Vector2d& map, double sign) {
  const double lat = M_PI / 2.0 - 2.0 * std::atan(map.norm() / (2.0 * Radius));
  const double lon = std::atan2(map.x(), -sign * map.y());
  return {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), sign * std::sin(lat)};
}

} // namespace

TEST_F(Images, TheSameGridIsCopiedAndHalvesAreMeans) {
  RasterFile file;
  file.width = 200;
  file.height = 104;
  file.bands = 3;
  file.type = GDT_Byte;
  std::mt19937 random(7);
  std::vector<double> values(std::size_t(file.width) * file.height * 3);
  for (double& v : values)
    v = double(random() % 256);
  file.value = [&](int c, int r, int b) { return values[std::size_t(r * 200 + c) * 3 + b]; };
  file.geotransform = {{500.0, 2.0, 0.0, 900.0, 0.0, -2.0}};
  file.crs = Plane;
  const auto layer = OpenImageLayer(file.Write(this->Folder / "same.tif"),
                                    PlaceOfGround(Plane, 500.0, 900.0, 2.0, 256, 256));
  EXPECT_TRUE(layer->Warnings().empty());
  EXPECT_NEAR(layer->PixelSize(), 2.0, 1e-6);
  // Of zoom 3 a texel is a pixel; 2, 1 and 0 are means of 4, 16 and 64 of them.
  const ColorGrid grid = GridAt(Crs::FromText(Plane), {500.0, 900.0}, {16.0, -16.0});
  for (int zoom = 3; zoom >= 0; --zoom) {
    const int side = 8 >> zoom;
    const ColorBlock block{zoom, 0, 0, file.width / side, file.height / side};
    const Texels texels = ReadTexels(*layer, grid, block);
    ASSERT_TRUE(texels.any);
    double worst = 0.0;
    for (int y = 0; y < block.height; ++y)
      for (int x = 0; x < block.width; ++x)
        for (int b = 0; b < 3; ++b) {
          double mean = 0.0;
          for (int j = 0; j < side; ++j)
            for (int i = 0; i < side; ++i)
              mean += file.value(x * side + i, y * side + j, b) / (side * side);
          worst = std::max(worst, std::abs(texels.At(x, y)[b] - mean));
        }
    EXPECT_LE(worst, zoom == 3 ? 0.0 : 0.501) << zoom;
    EXPECT_EQ(texels.At(block.width - 1, block.height - 1)[3], 255);
  }
  // One column more is beyond the image.
  EXPECT_EQ(ReadTexels(*layer, grid, {3, 200, 0, 1, 1}).any, false);
}

TEST_F(Images, AnyZoomFollowsASlope) {
  const auto layer = OpenImageLayer(this->Sloped().Write(this->Folder / "slope.tif"),
                                    PlaceOfGround(Plane, 1000.0, 5000.0, 10.0, 100, 100));
  // Texels of 41 m down to 0.32 m, at odds with the pixels; half a pixel would be 1 of 255.
  const ColorGrid grid = GridAt(Crs::FromText(Plane), {980.0, 5020.0}, {41.0, -41.0});
  for (int zoom = 0; zoom <= 7; ++zoom) {
    const double texel = 41.0 / (1 << zoom);
    const auto first = static_cast<std::int64_t>(500.0 / texel);
    const ColorBlock block{zoom, first, first, zoom < 3 ? 8 << zoom : 64,
                           zoom < 3 ? 4 << zoom : 40};
    const Texels texels = ReadTexels(*layer, grid, block);
    double worst = 0.0;
    for (int y = 0; y < block.height; ++y)
      for (int x = 0; x < block.width; ++x)
        for (int b = 0; b < 3; ++b)
          worst =
              std::max(worst, std::abs(texels.At(x, y)[b] - Slope(MiddleOf(grid, block, x, y), b)));
    EXPECT_LT(worst, 0.53) << zoom; // rounding to a byte, and 0.03 (0.15 m)
  }
}

TEST_F(Images, AMarkerIsFoundWhereItIs) {
  RasterFile file;
  file.width = file.height = 512;
  file.type = GDT_Byte;
  file.value = [](int c, int r, int) { return c == 301 && r == 77 ? 255.0 : 0.0; };
  file.geotransform = {{0.0, 1.0, 0.0, 512.0, 0.0, -1.0}};
  file.crs = Plane;
  const auto layer = OpenImageLayer(file.Write(this->Folder / "marker.tif"),
                                    PlaceOfGround(Plane, 0.0, 512.0, 1.0, 512, 512));
  // Brightness times place, over brightness, is the marker's middle at every zoom.
  const ColorGrid grid = GridAt(Crs::FromText(Plane), {-7.3, 520.9}, {2.9, -2.9});
  for (int zoom : {0, 1, 2, 3, 4}) {
    const double texel = 2.9 / (1 << zoom);
    const ColorBlock block{zoom, int(308.8 / texel) - 12, int(86.4 / texel) - 12, 25, 25};
    const Texels texels = ReadTexels(*layer, grid, block);
    double sum = 0.0;
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    for (int y = 0; y < 25; ++y)
      for (int x = 0; x < 25; ++x) {
        sum += texels.At(x, y)[0];
        place += texels.At(x, y)[0] * MiddleOf(grid, block, x, y);
      }
    ASSERT_GT(sum, 0.0);
    // Where it lies within a texel that is larger than it no mean can tell.
    const Eigen::Vector2d off = place / sum - Eigen::Vector2d(301.5, 434.5);
    EXPECT_LT(off.cwiseAbs().maxCoeff(), texel > 1.0 ? 0.5 * texel : 0.06 * texel) << zoom;
    EXPECT_NEAR(sum * texel * texel, 255.0, 255.0 * 0.12) << zoom; // as bright as it was
  }
}

TEST_F(Images, AWholeBodyHasNoSeamAnywhere) {
  const ColorGrid globe = GlobeGrid(Crs::FromText(Degrees));
  const RasterPlace ground = PlaceOfGround(Degrees, 0.0, 90.0, 4.0, 90, 45);
  for (double left : {-180.0, 0.0, 90.0}) {
    const auto layer = OpenImageLayer(this->Globe(left), ground);
    EXPECT_NEAR(layer->PixelSize(), Radius * M_PI / 180.0, 0.001 * Radius * M_PI / 180.0);
    for (int zoom : {0, 1, 3}) {
      const std::int64_t seam = static_cast<std::int64_t>((left + 180.0) / 360.0 * 512.0) << zoom;
      EXPECT_LT(WorstOfSky(*layer, globe, {zoom, seam - 40, 100 << zoom, 80, 40}, OfDegrees), 0.6);
      // In another turn, and up to the pole, where half a pixel has the colour of its row: there
      // 120 sin(0.5 deg) is 1.05.
      EXPECT_LT(WorstOfSky(*layer, globe, {zoom, seam - 40 + (512 << zoom), 0, 80, 10}, OfDegrees),
                1.6);
    }
    for (double sign : {1.0, -1.0}) {
      const Crs crs = Crs::FromText(sign > 0.0 ? Polar : South);
      const ColorGrid pole = GridAt(crs, {-640000.0, 640000.0}, {5000.0, -5000.0});
      const auto direction = [=](const Eigen::Vector2d& map) { return OfPolar(map, sign); };
      for (int zoom : {0, 2}) {
        const std::int64_t middle = 128 << zoom;
        EXPECT_LT(WorstOfSky(*layer, pole, {zoom, middle - 90, middle - 120, 200, 200}, direction),
                  1.6)
            << left << " " << sign << " " << zoom;
      }
    }
  }
}

TEST_F(Images, ATexelDoesNotDependOnTheBlock) {
  const auto layer =
      OpenImageLayer(this->Globe(0.0), PlaceOfGround(Degrees, 0.0, 90.0, 4.0, 90, 45));
  const ColorGrid pole = GridAt(Crs::FromText(Polar), {-640000.0, 640000.0}, {5000.0, -5000.0});
  const Texels whole = ReadTexels(*layer, pole, {1, 150, 150, 240, 240});
  for (int x : {0, 57, 106})
    for (int y : {3, 106, 207}) {
      const Texels part = ReadTexels(*layer, pole, {1, 150 + x, 150 + y, 31, 17});
      for (int j = 0; j < 17; ++j)
        for (int i = 0; i < 31; ++i)
          for (int k = 0; k < 4; ++k)
            ASSERT_EQ(part.At(i, j)[k], whole.At(x + i, y + j)[k]) << x + i << " " << y + j;
    }
}

TEST_F(Images, APartOfABodyAcrossTheDateLineIsFoundInEveryTurn) {
  RasterFile file;
  file.width = 80;
  file.height = 40;
  file.bands = 3;
  file.type = GDT_UInt16;
  file.value = [](int c, int r, int b) {
    return std::round(257.0 * Sky(Direction(170.0 + 0.25 * (c + 0.5), 5.0 - 0.25 * (r + 0.5)))[b]);
  };
  file.geotransform = {{170.0, 0.25, 0.0, 5.0, 0.0, -0.25}};
  file.crs = Degrees;
  const std::string degrees = file.Write(this->Folder / "part.tif");
  const double metres = M_PI / 180.0 * Radius;
  file.geotransform = {{170.0 * metres, 0.25 * metres, 0.0, 5.0 * metres, 0.0, -0.25 * metres}};
  file.crs = Plane;
  const std::string plane = file.Write(this->Folder / "plane.tif");
  const ColorGrid globe = GlobeGrid(Crs::FromText(Degrees));
  for (const std::string& path : {degrees, plane}) {
    const auto layer = OpenImageLayer(path, PlaceOfGround(Degrees, -180.0, 90.0, 4.0, 90, 45));
    for (std::int64_t first : {-28 * 4 + 2, 512 * 4 - 28 * 4 + 2}) { // 160 to 200 degrees
      const ColorBlock block{2, first, 120 * 4, 56 * 4, 16 * 4};
      const Texels texels = ReadTexels(*layer, globe, block);
      for (int y = 0; y < block.height; ++y)
        for (int x = 0; x < block.width; ++x) {
          Eigen::Vector2d map = MiddleOf(globe, block, x, y);
          map.x() += map.x() < 0.0 ? 360.0 : 0.0;
          const double away = std::max(std::abs(map.x() - 180.0) - 10.0, std::abs(map.y()) - 5.0);
          if (std::abs(away) < 0.2) // its edge lies within these texels
            continue;
          const Eigen::Vector3d sky = Sky(OfDegrees(map));
          ASSERT_EQ(texels.At(x, y)[3], away < 0.0 ? 255 : 0) << map.transpose();
          for (int k = 0; k < 3; ++k)
            ASSERT_NEAR(texels.At(x, y)[k], away < 0.0 ? sky[k] : 0.0, 0.6) << map.transpose();
        }
    }
  }
}
