// Real rasters: posts against GDAL's own values, places against PROJ, heights against each other.
#include <cmath>
#include <random>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <proj.h>

#include <dspace/Error.h>
#include <dspace/surface/GridTerrain.h>

#include "TestData.h"

namespace {

using dspace::GridTerrain;
using dspace::GridTerrainOptions;
using dspace::VerticalDatum;

// Every post: value read by GDAL alone, placed by the geotransform alone, against the map query.
// `metres` and `zero` make a height of a raw value.
void ExpectPosts(const std::string& path, const GridTerrain& terrain, double metres, double zero) {
  GDALAllRegister();
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(path.c_str(), GA_ReadOnly));
  ASSERT_NE(dataset, nullptr);
  const int width = dataset->GetRasterXSize(), height = dataset->GetRasterYSize();
  double g[6];
  if (dataset->GetGeoTransform(g) != CE_None) {
    const double plain[6] = {0.0, 2.0, 0.0, 2.0 * height, 0.0, -2.0};
    std::copy(plain, plain + 6, g);
  }
  std::vector<double> row(width);
  GDALRasterBand* band = dataset->GetRasterBand(1);
  int hasNoData = 0;
  const double noData = band->GetNoDataValue(&hasNoData);
  int wrong = 0;
  for (int r = 0; r < height; ++r) {
    ASSERT_EQ(
        band->RasterIO(GF_Read, 0, r, width, 1, row.data(), width, 1, GDT_Float64, 0, 0, nullptr),
        CE_None);
    for (int c = 0; c < width; ++c) {
      const Eigen::Vector2d map(g[0] + (c + 0.5) * g[1] + (r + 0.5) * g[2],
                                g[3] + (c + 0.5) * g[4] + (r + 0.5) * g[5]);
      const dspace::SurfaceSample sample = terrain.SampleMap(map);
      // A millimetre plus 1e-6 of the range is asked for; what is lost is rounding in the place.
      const double expected = row[c] * metres + zero;
      if (hasNoData && row[c] == noData)
        wrong += sample.valid;
      else
        wrong += !(std::abs(sample.height - expected) < 1e-6);
    }
  }
  EXPECT_EQ(wrong, 0) << "of " << width * height << " posts of " << path;
  GDALClose(dataset);
}

GridTerrainOptions ByHand(double scale, double offset, const std::string& datum) {
  GridTerrainOptions options;
  options.elevation.verticalScale = scale;
  options.elevation.verticalOffset = offset;
  options.elevation.verticalDatum = VerticalDatum::FromText(datum);
  return options;
}

// A place by PROJ's own operation from degrees, given as a PROJ string; x modulo `turn`, since a
// cylindrical map may run past the edge of PROJ's.
void ExpectPlaces(const GridTerrain& terrain, const std::string& operation, double turn = 1e99) {
  PJ* pj = proj_create(PJ_DEFAULT_CTX, operation.c_str());
  ASSERT_NE(pj, nullptr) << operation;
  const Eigen::AlignedBox2d box = terrain.GetBounds().map;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d map =
        box.min() + Eigen::Vector2d(unit(random), unit(random)).cwiseProduct(box.sizes());
    const Eigen::Vector3d place = terrain.MapToGeographic({map.x(), map.y(), 12.0});
    const PJ_COORD p =
        proj_trans(pj, PJ_FWD, proj_coord(proj_torad(place.x()), proj_torad(place.y()), 0.0, 0.0));
    EXPECT_NEAR(std::remainder(p.xy.x - map.x(), turn), 0.0, 1e-5); // metres
    EXPECT_NEAR(p.xy.y, map.y(), 1e-5);
    EXPECT_EQ(place.z(), 12.0);
    const Eigen::Vector3d back = terrain.GeographicToMap(place);
    EXPECT_LT((back.head<2>() - map).norm(), 1e-5);
    const Eigen::Vector3d p_S = terrain.MapToScene({map.x(), map.y(), 12.0});
    EXPECT_LT((terrain.SceneToMap(p_S).head<2>() - map).norm(), 1e-8 * (1.0 + map.norm()));
  }
  proj_destroy(pj);
}

} // namespace

TEST(RealTerrain, Apollo15ByHandGivenScale) {
  DSPACE_REAL_DATA(path, "terrain/moon_apollo15_nac_dtm_257.png");
  GridTerrainOptions options = ByHand(49.0 / 255.0, 0.0, "relative");
  options.elevation.pixelSize = 2.0;
  const auto terrain = GridTerrain::Load(path, options);
  ExpectPosts(path, *terrain, 49.0 / 255.0, 0.0);
  const Eigen::Vector3d size = terrain->GetBounds().scene.sizes();
  EXPECT_EQ(size.x(), 512.0); // 257 posts 2 m apart
  EXPECT_EQ(size.y(), 512.0);
  EXPECT_DOUBLE_EQ(size.z(), 49.0);
}

TEST(RealTerrain, GaleByMola) {
  DSPACE_REAL_DATA(path, "terrain/mars_gale_mola_128ppd_m.tif");
  const auto terrain = GridTerrain::Load(path, ByHand(1.0, 0.0, "areoid"));
  ExpectPosts(path, *terrain, 1.0, 0.0);
  // Bradbury Landing's pixel reads -4503 m; the triangles there stay within its neighbours.
  const Eigen::Vector3d map = terrain->GeographicToMap({137.4417, -4.5895, 0.0});
  EXPECT_NEAR(terrain->SampleMap(map.head<2>()).height, -4503.0, 10.0);
  bool bounded = false;
  for (const std::string& warning : terrain->GetWarnings())
    bounded = bounded || warning.find("up to 2") != std::string::npos; // 2 km and some
  EXPECT_TRUE(bounded);
  ASSERT_EQ(terrain->GetBounds().map.center(), Eigen::Vector2d(137.80078125, -5.40234375));
}

TEST(RealTerrain, GaleByHirise) {
  DSPACE_REAL_DATA(path, "terrain/mars_gale_hirise_DTEEC_009650_5m_relative_u16.tif");
  const auto terrain = GridTerrain::Load(path, ByHand(180.0 / 65535.0, -4600.0, "areoid"));
  ExpectPosts(path, *terrain, 180.0 / 65535.0, -4600.0);
  ExpectPlaces(*terrain, "+proj=eqc +lon_0=137.31 +R=3396190");
  // The same place in another CRS of the same body.
  const Eigen::Vector3d map(1387.0, -284480.0, 1.0);
  const Eigen::Vector3d iau = terrain->MapToCrs(map, dspace::Crs::FromText("IAU_2015:49900"));
  EXPECT_NEAR(iau.x(), 137.31 + 1387.0 / 3396190.0 * 180.0 / M_PI, 1e-9);
  EXPECT_LT((terrain->CrsToMap(iau, dspace::Crs::FromText("IAU_2015:49900")) - map).norm(), 1e-6);
  // Its numbers taken for metres: 65 km over 1 km, said of these and not of the heights by hand.
  const auto suspected = [](const GridTerrain& t) {
    bool said = false;
    for (const std::string& warning : t.GetWarnings())
      said = said || warning.find("span 65535 m") != std::string::npos;
    return said;
  };
  EXPECT_TRUE(suspected(*GridTerrain::Load(path)));
  for (const std::string& warning : terrain->GetWarnings())
    EXPECT_EQ(warning.find("vertical_scale"), std::string::npos) << warning;
}

TEST(RealTerrain, LunarNorthPole) {
  DSPACE_REAL_DATA(path, "terrain/moon_npole_stereo_33.tif");
  const auto terrain = GridTerrain::Load(path);
  ExpectPosts(path, *terrain, 1.0, 0.0);
  ExpectPlaces(*terrain, "+proj=stere +lat_0=90 +lon_0=0 +R=1737400");
  const Eigen::Vector3d place = terrain->MapToGeographic({-53709.961, -51090.039, 0.0});
  EXPECT_NEAR(place.x(), -(46.0 + 25.0 / 60.0 + 55.39 / 3600.0), 1e-5); // gdalinfo's centre
  EXPECT_NEAR(place.y(), 87.0 + 33.0 / 60.0 + 20.84 / 3600.0, 1e-5);
}

TEST(RealTerrain, IsisCubes) {
  DSPACE_REAL_DATA(pole, "terrain/moon_ulcn2005_spole_250.cub");
  const auto south = GridTerrain::Load(pole);
  ExpectPosts(pole, *south, 1.0, 0.0); // radius less the sphere
  ExpectPlaces(*south, "+proj=eqc +lon_0=180 +R=1737400", 2.0 * M_PI * 1737400.0);
  // 82 S on a plate carree: 7 x too long east-west, which is said.
  bool said = false;
  for (const std::string& warning : south->GetWarnings())
    said = said || warning.find("7.3") != std::string::npos;
  EXPECT_TRUE(said);
  DSPACE_REAL_DATA(whole, "terrain/moon_lola_ldem4_reduced.cub");
  ExpectPosts(whole, *GridTerrain::Load(whole), 0.5, 0.0);
}

TEST(RealTerrain, TwoLunarGridsAgree) {
  DSPACE_REAL_DATA(km, "terrain/moon_lola_global_4ppd_km.tif");
  DSPACE_REAL_DATA(cube, "terrain/moon_lola_ldem4_reduced.cub");
  const auto a = GridTerrain::Load(km, ByHand(1000.0, 0.0, "sphere:1737400"));
  ExpectPosts(km, *a, 1000.0, 0.0);
  const auto b = GridTerrain::Load(cube);
  // Radii against kilometres, 0..360 against -180..180, at the cube's own posts: 0.25 degree and
  // 0.75 degree posts of one data set, so that what differs is the smoothing of the latter.
  double sum = 0.0, difference = 0.0, mirrored = 0.0;
  int count = 0;
  for (int r = 20; r < 220; r += 3)
    for (int c = 1; c < 479; c += 3) {
      const Eigen::Vector2d map = b->PixelToMap() * Eigen::Vector2d(c + 0.5, r + 0.5);
      const Eigen::Vector3d place = b->MapToGeographic({map.x(), map.y(), 0.0});
      const double x = b->SampleMap(map).height;
      double y = 0.0;
      // The mean of the nine pixels of the finer grid.
      for (int i = 0; i < 9; ++i)
        y += a->SampleMap(a->GeographicToMap({place.x() + 0.25 * (i % 3 - 1),
                                              place.y() + 0.25 * (i / 3 - 1), 0.0})
                              .head<2>())
                 .height /
             9.0;
      if (std::isnan(y))
        continue;
      ++count;
      sum += x * x;
      difference += (x - y) * (x - y);
      const double z =
          a->SampleMap(a->GeographicToMap({-place.x(), place.y(), 0.0}).head<2>()).height;
      mirrored += (x - z) * (x - z);
    }
  ASSERT_GT(count, 9000);
  const double rms = std::sqrt(difference / count);
  RecordProperty("rms_m", std::to_string(rms));
  EXPECT_LT(rms, 60.0); // 25 m is known after averaging over the very pixels
  EXPECT_GT(std::sqrt(mirrored / count), 1000.0); // the check can fail
}

TEST(RealTerrain, California) {
  DSPACE_REAL_DATA(path, "terrain/earth_california_ned_1arcsec_129.tif");
  const auto terrain = GridTerrain::Load(path);
  ExpectPosts(path, *terrain, 1.0, 0.0);
  EXPECT_NEAR(terrain->Grid().GetMinimum(), 65.0, 1.0); // the file's own statistics are stale
  EXPECT_NEAR(terrain->Grid().GetMaximum(), 318.0, 1.0);
  // One arc second at 37.98375 N on GRS 80, by the formulae of the ellipsoid: 24.4033 m by
  // 30.8323 m.
  const Eigen::Vector3d size = terrain->GetBounds().scene.sizes() / 128.0;
  EXPECT_NEAR(size.x(), 24.4033, 1e-4);
  EXPECT_NEAR(size.y(), 30.8323, 1e-4);
}

TEST(RealTerrain, SanFranciscoBayHasOblongPixels) {
  DSPACE_REAL_DATA(path, "terrain/earth_sfbay_200x125.tif");
  const auto terrain = GridTerrain::Load(path);
  ExpectPosts(path, *terrain, 1.0, 0.0);
  const dspace::HeightGrid& grid = terrain->Grid();
  const Eigen::Matrix2d m = grid.GetGridToScene().linear();
  EXPECT_NEAR(m(0, 0), 443.4, 0.5);  // 0.00502 degrees of longitude at 37.5 N
  EXPECT_NEAR(m(1, 1), -891.0, 1.0); // 0.00803 degrees of latitude
}

TEST(RealTerrain, WholeMars) {
  DSPACE_REAL_DATA(path, "terrain/mars_mola_megt90n000cb_4ppd_m.tif");
  const auto terrain = GridTerrain::Load(path, ByHand(1.0, 0.0, "areoid"));
  ExpectPosts(path, *terrain, 1.0, 0.0);
  const auto at = [&](double lon, double lat) {
    return terrain->SampleMap(terrain->GeographicToMap({lon, lat, 0.0}).head<2>()).height;
  };
  EXPECT_GT(at(-133.8, 18.65), 18000.0); // Olympus Mons
  EXPECT_LT(at(70.5, -42.4), -5500.0);   // Hellas
}
