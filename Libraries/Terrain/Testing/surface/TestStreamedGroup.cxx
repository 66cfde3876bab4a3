// Terrain groups as surfaces, on a body and on a plane: real data and a site made here.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/clipmap/PoleCharts.h>
#include <dspace/crs/CrsTransform.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Patches.h"
#include "RasterFile.h"
#include "TestData.h"

namespace {

using namespace dspace;
using namespace dspace::testing;

double HeightAt(const StreamedTerrain& terrain, double lon, double lat) {
  return terrain.SampleMap({lon, lat}).height;
}

// Rays from above and aslant meet the surface where samples say it is.
void ExpectRaysMeetIt(const StreamedTerrain& terrain, const Eigen::Vector3d& middle, double size) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Eigen::Vector3d up = terrain.Up(middle);
  int hits = 0;
  for (int i = 0; i < 60; ++i) {
    const auto about = [&](double spread, double height) {
      const Eigen::Vector3d d(unit(random), unit(random), unit(random));
      return Eigen::Vector3d(middle + spread * (d - d.dot(up) * up) + height * up);
    };
    const Eigen::Vector3d from = about(2.0 * size, (0.2 + i % 5) * size);
    const Eigen::Vector3d to = about(0.5 * size, 0.0);
    const RayHit hit = terrain.Intersect(from, to - from, 100.0 * size);
    if (!hit.hit) {
      continue;
    }
    ++hits;
    const SurfaceSample sample = terrain.Sample(hit.position_S);
    ASSERT_TRUE(sample.valid);
    EXPECT_LT((sample.position_S - hit.position_S).norm(), 2e-3) << i;
    // Nothing before it: the ray is on one side of the ground all the way.
    const double side = hit.fromBelow ? -1.0 : 1.0;
    for (int k = 1; k < 40; ++k) {
      const Eigen::Vector3d p = from + k / 40.0 * (hit.position_S - from);
      EXPECT_GT(side * (p - terrain.Sample(p).position_S).dot(up), -2e-3) << i;
    }
  }
  EXPECT_GT(hits, 40);
}

TEST(StreamedGroup, WholeMarsWithGaleAndHirise) {
  DSPACE_REAL_DATA(mars, "terrain/mars_mola_megt90n000cb_4ppd_m.tif");
  DSPACE_REAL_DATA(gale, "terrain/mars_gale_mola_128ppd_m.tif");
  DSPACE_REAL_DATA(hirise, "terrain/mars_gale_hirise_DTEEC_009650_5m_relative_u16.tif");
  StreamedTerrainOptions options;
  options.onBody = true;
  options.elevation.verticalDatum = VerticalDatum::FromText("sphere:3396190");
  const auto bare = StreamedTerrain::Open(mars, options);
  TerrainPatch window;
  window.path = gale;
  window.elevation.verticalDatum = options.elevation.verticalDatum;
  TerrainPatch site;
  site.path = hirise;
  site.elevation.verticalDatum = options.elevation.verticalDatum;
  site.elevation.verticalScale = 0.00245; // by hand: the file's numbers are relative
  site.elevation.verticalOffset = -4029.0;
  site.margin = 150.0;
  options.patches = {window, site};
  const auto terrain = StreamedTerrain::Open(mars, options);
  const GroupReport& report = *terrain->Group();
  ASSERT_EQ(report.patches.size(), 2u);
  EXPECT_NEAR(HeightAt(*terrain, 137.4417, -4.5895), -4503.0, 1.0); // Bradbury Landing
  EXPECT_LE(terrain->HeightRange()[0], -8068.0);
  // The site against its own numbers, at pixels beyond the margin.
  const ElevationSource source(hirise, site.elevation);
  const std::vector<double> own = source.Read();
  const CrsTransform toMap(source.Info().crs, terrain->Info().crs);
  std::mt19937 random(2);
  double squares = 0.0;
  for (int i = 0; i < 300; ++i) {
    const int c = 40 + int(random() % 120);
    const int r = 40 + int(random() % 120);
    const Eigen::Vector2d map =
        toMap.Apply(source.Info().pixelToMap * Eigen::Vector2d(c + 0.5, r + 0.5));
    const double error = HeightAt(*terrain, map.x(), map.y()) - own[std::size_t(r) * 200 + c];
    squares += error * error / 300.0;
  }
  EXPECT_NEAR(std::sqrt(squares), report.patches[1].rmsError, 0.3 * report.patches[1].rmsError);
  EXPECT_LT(report.patches[1].rmsError, 0.2);
  // No cliff across either border: metres a metre, walked in small steps.
  const auto steepest = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to, int steps) {
    double most = 0.0;
    double before = HeightAt(*terrain, from.x(), from.y());
    const double metres = (to - from).norm() * Deg * 3396190.0 / steps;
    for (int i = 1; i <= steps; ++i) {
      const Eigen::Vector2d p = from + double(i) / steps * (to - from);
      const double height = HeightAt(*terrain, p.x(), p.y());
      most = std::max(most, std::abs(height - before) / metres);
      before = height;
    }
    return most;
  };
  // The patches' slopes, and 1.5 sqrt(2) / margin x what the two differ by.
  EXPECT_LT(steepest({137.333, -4.7889}, {137.333, -4.7955}, 1500),
            1.0 + 1.5 * std::sqrt(2.0) / 150.0 * 120.0);
  EXPECT_LT(steepest({134.2, -5.0}, {135.2, -5.0}, 3000),
            0.4 + 1.5 * std::sqrt(2.0) / report.patches[0].margin * 800.0);
  // Far from both it is what it is without them.
  for (const auto& [lon, lat] : {std::pair(10.0, 20.0), {226.2, 18.65}, {137.0, 30.0}}) {
    EXPECT_NEAR(HeightAt(*terrain, lon, lat), HeightAt(*bare, lon, lat), 2e-3);
  }
  const Eigen::Vector3d middle = terrain->SampleMap({137.3333, -4.7993}).position_S;
  ExpectRaysMeetIt(*terrain, middle, 400.0);
}

TEST(StreamedGroup, WholeMoonWithASiteOfOneMetre) {
  DSPACE_REAL_DATA(lola, "terrain/moon_lola_global_4ppd_km.tif");
  const TemporaryFolder folder;
  StreamedTerrainOptions options;
  options.onBody = true;
  options.elevation.verticalScale = 1000.0;
  options.elevation.verticalDatum = VerticalDatum::FromText("sphere:1737400");
  const auto bare = StreamedTerrain::Open(lola, options);
  PatchFile site;
  site.projection = EquidistantCylindrical(3.6, 26.0);
  site.middle = {3.63, 26.13};
  site.width = 420;
  site.height = 360;
  site.size = 1.0;
  site.margin = 60.0;
  const double ground = HeightAt(*bare, 3.63, 26.13);
  site.formula = [ground](const Eigen::Vector2d& m) {
    return ground + 2.0 + 0.8 * std::sin(m.x() / 7.0) * std::cos(m.y() / 9.0);
  };
  options.patches = {site.Write(folder / "site.tif")};
  const auto terrain = StreamedTerrain::Open(lola, options);
  const PatchReport& report = terrain->Group()->patches.at(0);
  EXPECT_NEAR(report.pixel, 1.0, 2e-3);
  EXPECT_LT(terrain->Placement().CellSize({0.0, 0.5 * double(terrain->Pyramid()->Lattice().rows)}),
            1.0);
  EXPECT_GT(report.posts, 20);
  EXPECT_LT(report.greatestError, 0.02);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d pixel(210.0 + 120.0 * unit(random), 180.0 + 100.0 * unit(random));
    const Eigen::Vector2d p = site.LonLatOf(pixel);
    EXPECT_NEAR(HeightAt(*terrain, p.x(), p.y()), site.FormulaAt(p), 0.02);
    const Eigen::Vector2d out = site.LonLatOf({800.0 + 500.0 * unit(random), -60.0});
    EXPECT_NEAR(HeightAt(*terrain, out.x(), out.y()), HeightAt(*bare, out.x(), out.y()), 1e-3);
  }
  ExpectRaysMeetIt(*terrain, terrain->SampleMap({3.63, 26.13}).position_S, 100.0);
}

// Around the poles a body is drawn on charts of their own: there, too, with its patches.
TEST(StreamedGroup, PoleChartsHaveThePatches) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 128;
  file.height = 64;
  file.unit = "m";
  file.verticalDatum = "sphere";
  file.crs = "+proj=longlat +R=1737400 +no_defs";
  file.geotransform = std::array<double, 6>{-180, 360.0 / 128, 0, 90, 0, -360.0 / 128};
  file.value = [](int, int r, int) { return 10.0 * r; };
  StreamedTerrainOptions options;
  options.onBody = true;
  const std::string path = file.Write(folder / "globe.tif");
  for (const bool south : {false, true}) {
    PatchFile patch;
    patch.projection = south ? PolarStereographic(25.0, true) : PolarStereographic(25.0);
    patch.middle = {70.0, south ? -89.97 : 89.97};
    patch.width = 240;
    patch.height = 200;
    patch.size = 20.0;
    patch.margin = 600.0;
    patch.formula = [](const Eigen::Vector2d& m) {
      return 900.0 + 8.0 * std::sin(m.x() / 150.0) + 0.02 * m.y();
    };
    options.patches = {patch.Write(folder / (south ? "south.tif" : "north.tif"))};
    const auto terrain = StreamedTerrain::Open(path, options);
    ASSERT_TRUE(terrain->Group()->patches[0].used);
    const std::vector<ClipmapChart> charts = PoleChartsOf(*terrain, 124);
    ASSERT_EQ(charts.size(), 2u);
    const ClipmapChart& chart = charts[south ? 1 : 0];
    const double spacing = 2.0 * MoonRadius * chart.placement.PlaneStep();
    EXPECT_LT(spacing, 20.0);
    const auto half = std::int64_t(chart.placement.Pole().x());
    int within = 0;
    int outside = 0;
    std::mt19937 random(6);
    for (int i = 0; i < 150; ++i) {
      const auto about = [&] { return std::int64_t(random() % 600) - 300; };
      const PostBlock block{0, half + about(), half + about(), 5, 4};
      std::array<float, 20> heights = {};
      chart.pyramid->Read(block, heights.data());
      for (int k = 0; k < 20; ++k) {
        const Eigen::Vector2d angles = chart.placement.Angles(
            Eigen::Vector2d(double(block.column + k % 5), double(block.row + k / 5)));
        const Eigen::Vector2d lonLat = angles / Deg;
        const Eigen::Vector2d pixel = patch.PixelOf(lonLat);
        const double away =
            std::min({pixel.x(), patch.width - pixel.x(), pixel.y(), patch.height - pixel.y()});
        if (away > 35.0) {
          EXPECT_NEAR(heights[k], patch.FormulaAt(lonLat), 0.05) << lonLat.transpose();
          ++within;
        }
        outside += away < 0.0;
        // As queries answer; their lattice is another one, and in the margin the ground bends:
        // 900 m x 6 / (600 m)^2, which posts 17 m apart cut by up to 0.55 m.
        const SurfaceSample sample =
            terrain->Sample(1e6 * Eigen::Vector3d(std::cos(angles.y()) * std::cos(angles.x()),
                                                  std::cos(angles.y()) * std::sin(angles.x()),
                                                  std::sin(angles.y())));
        EXPECT_NEAR(heights[k], sample.height, 0.7) << lonLat.transpose();
      }
    }
    EXPECT_GT(within, 200) << south << ", " << spacing << ", " << outside;
    EXPECT_GT(outside, 20);
  }
}

// A base on a plane, whose posts are divided for the patch.
TEST(StreamedGroup, OnAPlane) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 60;
  file.height = 50;
  file.unit = "m";
  file.verticalDatum = "sphere";
  file.crs = EquidistantCylindrical(24.0, 60.0).text;
  const PatchFile patch = [] {
    PatchFile made;
    made.projection = PolarStereographic(10.0);
    made.middle = {24.3, 60.2};
    made.width = 200;
    made.height = 180;
    made.size = 20.0;
    made.margin = 500.0;
    made.formula = [](const Eigen::Vector2d& m) { return 70.0 + 5.0 * std::sin(m.x() / 90.0); };
    return made;
  }();
  const Projection plane = EquidistantCylindrical(24.0, 60.0);
  const Eigen::Vector2d middle = plane.toMap(patch.middle);
  file.geotransform =
      std::array<double, 6>{middle.x() - 9000.0, 300.0, 0, middle.y() + 7500.0, 0, -300.0};
  file.value = [](int c, int r, int) { return 3.0 * c - 2.0 * r; };
  const std::string path = file.Write(folder / "plane.tif");
  StreamedTerrainOptions options;
  const auto bare = StreamedTerrain::Open(path, options);
  options.patches = {patch.Write(folder / "patch.tif")};
  const auto terrain = StreamedTerrain::Open(path, options);
  EXPECT_EQ(terrain->Subdivisions(), 5); // 300 m of 60 degrees north to 20 m of the patch
  const TerrainBounds a = bare->GetBounds();
  const TerrainBounds b = terrain->GetBounds();
  EXPECT_TRUE(a.map.isApprox(b.map, 1e-12));
  EXPECT_TRUE(b.scene.contains(a.scene));
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector2d map = middle + 8000.0 * Eigen::Vector2d(unit(random), 0.8 * unit(random));
    const Eigen::Vector2d pixel = patch.PixelOf(plane.toLonLat(map));
    const double away = std::min({pixel.x(), patch.width - pixel.x(), pixel.y(),
                                  patch.height - pixel.y()}); // from its edge, inward
    const double height = terrain->SampleMap(map).height;
    if (away < 0.0) {
      EXPECT_NEAR(height, bare->SampleMap(map).height, 1e-4);
    } else if (away > 30.0) {
      EXPECT_NEAR(height, patch.FormulaAt(plane.toLonLat(map)), 0.2);
    }
    const Eigen::Vector3d p_S = terrain->MapToScene({map.x(), map.y(), 0.0});
    EXPECT_NEAR(terrain->Sample(p_S).height, height, 1e-6);
  }
  ExpectRaysMeetIt(*terrain, terrain->SampleMap(middle).position_S, 900.0);
  // A few places in a tile are answered without it, as it would answer them.
  const auto single = StreamedTerrain::Open(path, options);
  const PostLattice& lattice = terrain->Pyramid()->Lattice();
  std::vector<float> all(std::size_t(lattice.columns) * lattice.rows);
  terrain->Pyramid()->Read({0, 0, 0, int(lattice.columns), int(lattice.rows)}, all.data());
  Rows2 places(400, 2);
  for (int i = 0; i < 400; ++i) {
    places.row(i) = middle + 3000.0 * Eigen::Vector2d(unit(random), 0.8 * unit(random));
  }
  Eigen::VectorXd one(400), tiles(400);
  const std::uint64_t before = single->Pyramid()->Statistics().loads;
  single->HeightsMap(places, one);
  EXPECT_EQ(single->Pyramid()->Statistics().loads, before);
  terrain->HeightsMap(places, tiles);
  EXPECT_EQ(one, tiles);
  // A tile with many places is read.
  places.resize(6000, 2);
  one.resize(6000);
  tiles.resize(6000);
  for (int i = 0; i < 6000; ++i) {
    places.row(i) = middle + 30.0 * Eigen::Vector2d(unit(random), unit(random));
  }
  single->HeightsMap(places, one);
  terrain->HeightsMap(places, tiles);
  EXPECT_EQ(one, tiles);
  EXPECT_GT(single->Pyramid()->Statistics().loads, before);
}

} // namespace
