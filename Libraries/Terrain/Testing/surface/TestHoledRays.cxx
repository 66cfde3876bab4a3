// Rays where heights are known to lie between others: at the rim of a hole, and at the very top.
#include <cmath>

#include <gtest/gtest.h>

#include <dspace/surface/StreamedTerrain.h>

#include "RasterFile.h"

namespace {

using namespace dspace;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

// 12 x 12 pixels of 100 m at 50 m, one without data at (550, -550). The patch, at 0 m, is alone in
// the cell south-east of it, up to the base's posts at x = 650, where it counts for a half: a wall
// as wide as its posts are apart, 100 / 256 m.
TEST(HoledRays, AWallWhereAPatchCoversTheRimOfAHoleIsHit) {
  const TemporaryFolder folder;
  RasterFile base;
  base.width = base.height = 12;
  base.crs = "+proj=eqc +R=1737400 +no_defs";
  base.unit = "m";
  base.verticalDatum = "sphere";
  base.noData = -9999.0;
  base.geotransform = std::array<double, 6>{0, 100, 0, 0, 0, -100};
  base.value = [](int c, int r, int) { return c == 5 && r == 5 ? -9999.0 : 50.0; };
  RasterFile over = base;
  over.width = 320; // to x = 680
  over.height = 300;
  over.geotransform = std::array<double, 6>{520, 0.5, 0, -500, 0, -0.5};
  over.value = [](int, int, int) { return 0.0; };
  StreamedTerrainOptions options;
  options.origin = Eigen::Vector2d(0.0, 0.0);
  TerrainPatch patch;
  patch.path = over.Write(folder / "patch.tif");
  patch.margin = 60.0;
  options.patches = {patch};
  const auto terrain = StreamedTerrain::Open(base.Write(folder / "base.tif"), options);
  ASSERT_EQ(terrain->Subdivisions(), 8);
  const double step = 100.0 / 256.0;
  // GroupPosts and PatchWeight: 29.5 m and a pixel less than three from the edge, of 60 m.
  const double s = (30.25 - 1.5) / 60.0;
  const double top = 50.0 * (1.0 - s * s * (3.0 - 2.0 * s));
  for (const double z : {5.0, 10.0, 20.0}) {
    const RayHit hit = terrain->Intersect({600.0, -575.3, z}, {1.0, 0.0, 0.0});
    ASSERT_TRUE(hit.hit) << z;
    EXPECT_NEAR(hit.position_S.x(), 650.0 - step + step * z / top, 2e-3) << z;
    EXPECT_NEAR(terrain->Sample(hit.position_S).height, z, 1e-3);
    EXPECT_FALSE(hit.fromBelow);
  }
}

// A plateau at 4001.1232 m, which as a float is a tenth of a millimetre higher than the double that
// tells how high the ground is.
TEST(HoledRays, APlateauThatIsTheHighestGroundIsHit) {
  const TemporaryFolder folder;
  const double height = 4001.1232;
  ASSERT_GT(double(float(height)) - height, 4e-5);
  RasterFile file;
  file.width = file.height = 40;
  file.crs = "+proj=longlat +R=1737400 +no_defs";
  file.unit = "m";
  file.verticalDatum = "sphere";
  file.geotransform = std::array<double, 6>{10, 0.01, 0, 20, 0, -0.01};
  file.value = [=](int c, int r, int) {
    return std::abs(c - 20) < 6 && std::abs(r - 20) < 6 ? height : height - 20.0;
  };
  StreamedTerrainOptions options;
  options.onBody = true;
  const auto terrain = StreamedTerrain::Open(file.Write(folder / "plateau.tif"), options);
  const Eigen::Vector3d up = terrain->MapToScene({10.205, 19.795, 0.0}).normalized();
  const RayHit hit = terrain->Intersect((1737400.0 + 9000.0) * up, -up);
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(hit.distance, 9000.0 - height, 5e-4); // floats are 0.24 mm apart
  EXPECT_NEAR(terrain->Sample(hit.position_S).height, height, 5e-4);
}

} // namespace
