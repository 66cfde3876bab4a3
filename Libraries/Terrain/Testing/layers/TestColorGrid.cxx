// Where the tiles of colour layers lie: on planes, around bodies, at their poles.
#include <cmath>

#include <gtest/gtest.h>

#include <dspace/clipmap/ColorGridsOf.h>
#include <dspace/clipmap/PoleCharts.h>
#include <dspace/crs/CrsTransform.h>
#include <dspace/layers/ColorGrid.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Globe.h"

namespace {

using namespace dspace;
using dspace::testing::Degree;
using dspace::testing::Globe;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

TEST(ColorGrid, OnAPlaneAZoomHasTheRastersOwnPixels) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 700;
  file.height = 300;
  file.crs = "+proj=eqc +R=1737400 +units=m +no_defs";
  file.geotransform = std::array<double, 6>{1000.0, 2.0, 0.0, 5000.0, 0.0, -2.0};
  file.value = [](int c, int r, int) { return 0.1 * c - 0.2 * r; };
  StreamedTerrainOptions options;
  options.subdivisions = 3; // posts are closer than pixels: tiles are not
  const auto terrain = StreamedTerrain::Open(file.Write(folder / "plane.tif"), options);
  const ColorGrid grid = ColorGridsOf(*terrain, {}).at(0);
  EXPECT_FALSE(grid.periodic);
  EXPECT_EQ(grid.ColumnsAt(2), 4);
  const int zoom = 2; // 1024 texels to the 700 pixels
  EXPECT_EQ(grid.ZoomFor(2.0), zoom);
  EXPECT_EQ(grid.ZoomFor(1.9), zoom + 1);
  EXPECT_NEAR(grid.RootTexelSize(), 8.0, 1e-6); // [m]
  for (const Eigen::Vector2d& pixel :
       std::vector<Eigen::Vector2d>{{0, 0}, {700, 300}, {12.5, 299.5}}) {
    const Eigen::Vector2d map = grid.TexelToMap(zoom) * pixel;
    EXPECT_NEAR(map.x(), 1000.0 + 2.0 * pixel.x(), 1e-9);
    EXPECT_NEAR(map.y(), 5000.0 - 2.0 * pixel.y(), 1e-9);
    const Eigen::Vector2d post = grid.TexelToPost(zoom) * pixel;
    const Eigen::Vector3d scene = terrain->MapToScene({map.x(), map.y(), 0.0});
    EXPECT_LT((grid.placement.ToScene(post, 0.0) - scene).norm(), 1e-6);
  }
  EXPECT_LT((grid.TexelToPost(zoom) * Eigen::Vector2d(700, 300) - grid.extent.max()).norm(), 1e-9);
}

TEST(ColorGrid, AroundABodyTilesLieAlikeWhereverTheRastersEdgeIs) {
  const TemporaryFolder folder;
  for (const auto& [west, direction] : {std::pair(-180.0, 1), {0.0, 1}, {180.0, -1}}) {
    Globe globe;
    globe.west_deg = west;
    globe.direction = direction;
    globe.height = [](double, double) { return 0.0; };
    StreamedTerrainOptions options;
    options.onBody = true;
    const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), options);
    const std::vector<ClipmapChart> poles = PoleChartsOf(*terrain, 124);
    ASSERT_EQ(poles.size(), 2u);
    const std::vector<ColorGrid> grids = ColorGridsOf(*terrain, poles);
    ASSERT_EQ(grids.size(), 3u);
    const ColorGrid& grid = grids[0];
    EXPECT_TRUE(grid.periodic);
    EXPECT_EQ(grid.ColumnsAt(3), 16);
    EXPECT_EQ(grid.RowsAt(3), 8);
    EXPECT_NEAR(grid.RootTexelSize(), M_PI * globe.radius / 256.0, 1.0);
    for (const Eigen::Vector2d& texel :
         std::vector<Eigen::Vector2d>{{0, 0}, {1024, 512}, {77.5, 100.25}}) {
      const Eigen::Vector2d map = grid.TexelToMap(1) * texel;
      const double lon = direction * (-180.0 + texel.x() * 360.0 / 1024.0);
      EXPECT_NEAR(std::remainder(map.x() - lon, 360.0), 0.0, 1e-9);
      EXPECT_NEAR(map.y(), 90.0 - texel.y() * 180.0 / 512.0, 1e-9);
      const Eigen::Vector2d post = grid.TexelToPost(1) * texel;
      const Eigen::Vector3d place(std::cos(map.y() * Degree) * std::cos(lon * Degree),
                                  std::cos(map.y() * Degree) * std::sin(lon * Degree),
                                  std::sin(map.y() * Degree));
      EXPECT_LT((grid.placement.ToScene(post, 0.0) - globe.radius * place).norm(), 1e-6);
    }
    // A pole's map is PROJ's: places through it and through the chart's posts are the same.
    for (const std::size_t k : {1u, 2u}) {
      const CrsTransform toDegrees(grids[k].crs, terrain->Info().crs);
      for (const Eigen::Vector2d& texel :
           std::vector<Eigen::Vector2d>{{200, 300}, {255, 256}, {400, 90}}) {
        const Eigen::Vector2d degrees = toDegrees.Apply(grids[k].TexelToMap(1) * texel);
        const Eigen::Vector3d place(std::cos(degrees.y() * Degree) * std::cos(degrees.x() * Degree),
                                    std::cos(degrees.y() * Degree) * std::sin(degrees.x() * Degree),
                                    std::sin(degrees.y() * Degree));
        const Eigen::Vector2d post = grids[k].TexelToPost(1) * texel;
        EXPECT_LT((grids[k].placement.ToScene(post, 0.0) - globe.radius * place).norm(), 1e-3);
      }
    }
  }
}

} // namespace
