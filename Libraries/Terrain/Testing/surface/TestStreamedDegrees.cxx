// Which rasters stand on a body, and the real ones.
#include <cmath>
#include <random>

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Globe.h"
#include "TestData.h"

namespace {

using namespace dspace;
using dspace::testing::Bulges;
using dspace::testing::Degree;
using dspace::testing::Direction;
using dspace::testing::Globe;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

StreamedTerrainOptions DegreesOnBody() {
  StreamedTerrainOptions options;
  options.onBody = true;
  return options;
}

// The same ground as degrees, as metres of an equidistant cylindrical map, with its columns
// repeated at the edge, and as parts of it.
TEST(StreamedDegrees, FormsOfDegreeGridsAreOneGround) {
  const TemporaryFolder folder;
  Globe globe;
  globe.height = Bulges;
  const auto whole =
      StreamedTerrain::Open(globe.File().Write(folder / "whole.tif"), DegreesOnBody());
  const auto compare = [&](const StreamedTerrain& other, double lon0, double lon1, double lat0,
                           double lat1, double tolerance) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int i = 0; i < 500; ++i) {
      const double lon = lon0 + (lon1 - lon0) * unit(random);
      const Eigen::Vector3d p = 2e6 * Direction(lon, lat0 + (lat1 - lat0) * unit(random));
      const SurfaceSample a = whole->Sample(p);
      const SurfaceSample b = other.Sample(p);
      ASSERT_TRUE(b.valid) << p.transpose();
      EXPECT_NEAR(a.height, b.height, tolerance) << p.transpose();
      const RayHit c = whole->Intersect(p, -p);
      const RayHit d = other.Intersect(p, -p);
      ASSERT_TRUE(d.hit) << p.transpose();
      EXPECT_NEAR(c.distance, d.distance, tolerance);
      // The map leads to the same place.
      const Eigen::Vector3d map = other.SceneToMap(p);
      EXPECT_LT((other.MapToScene(map) - p).norm(), 1e-3);
      EXPECT_NEAR(other.SampleMap(map.head<2>()).height, b.height, 1e-3);
      if (other.GetCrs().GetKind() == Crs::Kind::Geographic) { // turns of longitude do not matter
        const Eigen::Vector2d turned(map.x() + (i % 2 == 0 ? 360.0 : -720.0), map.y());
        EXPECT_NEAR(other.SampleMap(turned).height, b.height, 1e-3);
      }
      // What does not quite go around is drawn out by up to a hundredth of a pixel.
      EXPECT_NEAR(std::remainder(other.MapToGeographic(map).x() - lon, 360.0), 0.0,
                  tolerance > 0.02 ? 1e-4 : 1e-6);
    }
  };
  RasterFile metres = globe.File();
  const double side = globe.Step() * Degree * globe.radius;
  metres.crs = "+proj=eqc +lon_0=30 +lat_ts=0 +R=1737400 +x_0=500 +units=m +no_defs";
  // As ISIS writes it, 3 m too wide as a whole.
  const double wide = side * (1.0 + 3e-7);
  metres.geotransform = std::array<double, 6>{500.0 - 210.0 * Degree * globe.radius, wide, 0,
                                              0.5 * globe.width / 2 * wide,          0,    -wide};
  const auto projected =
      StreamedTerrain::Open(metres.Write(folder / "metres.tif"), DegreesOnBody());
  EXPECT_TRUE(projected->Pyramid()->Lattice().periodic);
  compare(*projected, -180.0, 180.0, -90.0, 90.0, 5e-2);

  RasterFile repeated = globe.File();
  repeated.width += 1;
  const auto again =
      StreamedTerrain::Open(repeated.Write(folder / "repeated.tif"), DegreesOnBody());
  EXPECT_EQ(again->Info().window.width, globe.width);
  compare(*again, -180.0, 180.0, -90.0, 90.0, 1e-9);

  // 300 degrees of it, across the date line: more than half a turn.
  RasterFile part = globe.File();
  part.width = 80;
  part.height = 30;
  part.geotransform = std::array<double, 6>{60.0, globe.Step(), 0, 60.0, 0, -globe.Step()};
  part.value = [&](int c, int r, int) {
    return double(float(Bulges(60.0 + (c + 0.5) * globe.Step(), 60.0 - (r + 0.5) * globe.Step())));
  };
  const auto regional = StreamedTerrain::Open(part.Write(folder / "part.tif"), DegreesOnBody());
  EXPECT_FALSE(regional->Pyramid()->Lattice().periodic);
  compare(*regional, 62.0, 357.9, -50.0, 58.0, 1e-2); // floats at other places
  EXPECT_FALSE(regional->Sample(2e6 * Direction(30.0, 0.0)).valid);
  EXPECT_FALSE(regional->Sample(2e6 * Direction(100.0, 70.0)).valid);
  EXPECT_FALSE(regional->Intersect(2e6 * Direction(30.0, 0.0), -Direction(30.0, 0.0), 5e5).hit);
  const Eigen::AlignedBox3d box = regional->GetBounds().scene;
  EXPECT_TRUE(box.contains(Eigen::Vector3d(regional->Sample(Direction(180.0, 0.0)).position_S)));
  EXPECT_LT(box.max().z(), 0.9 * globe.radius); // it ends at 60 degrees
}

// Its range of heights is a guess: rays must not trust it. From orbit to the ground, and nothing
// above it on the way.
TEST(StreamedDegrees, RaysFromOrbitMeetALargeRastersHighestPlace) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 2150;
  file.height = 1900;
  file.type = GDT_Float32;
  file.crs = "+proj=longlat +R=3396190 +no_defs";
  file.geotransform = std::array<double, 6>{120.0, 0.01, 0, 10.0, 0, -0.01};
  file.value = [](int c, int r, int) {
    return c == 1003 && r == 750 ? 50000.0 : 1500.0 * std::sin(0.02 * c) * std::cos(0.03 * r);
  };
  const auto terrain = StreamedTerrain::Open(file.Write(folder / "large.tif"), DegreesOnBody());
  EXPECT_FALSE(terrain->HeightRangeIsExact());
  EXPECT_LT(terrain->HeightRange()[1], 40000.0);
  const Eigen::Vector3d needle = Direction(120.0 + 1003.5 * 0.01, 10.0 - 750.5 * 0.01);
  const RayHit top = terrain->Intersect(1e7 * needle, -needle);
  ASSERT_TRUE(top.hit);
  EXPECT_NEAR(top.distance, 1e7 - 3396190.0 - 50000.0, 1e-2); // the place is a rounding aside
  const RayHit side = terrain->Intersect(
      3436190.0 * needle - 2e5 * needle.cross(Eigen::Vector3d::UnitZ()).normalized(),
      needle.cross(Eigen::Vector3d::UnitZ()), 4e5);
  EXPECT_TRUE(side.hit); // 40 km high
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    const auto place = [&] {
      return Direction(121.0 + 19.0 * unit(random), 9.0 - 17.0 * unit(random));
    };
    const Eigen::Vector3d from = 3396190.0 * (1.001 + 2.0 * unit(random) * (i % 2)) * place();
    const Eigen::Vector3d d = (3390000.0 * place() - from).normalized();
    const RayHit hit = terrain->Intersect(from, d);
    ASSERT_TRUE(hit.hit) << i;
    const SurfaceSample ground = terrain->Sample(hit.position_S);
    EXPECT_NEAR(ground.position_S.norm(), hit.position_S.norm(), 2e-6) << i;
    for (double t = 0.01; t < 0.999; t += 0.01) {
      const Eigen::Vector3d p = from + t * hit.distance * d;
      const SurfaceSample below = terrain->Sample(p);
      ASSERT_FALSE(below.valid && below.position_S.norm() > p.norm()) << i << " at " << t;
    }
  }
}

TEST(StreamedDegrees, WhatCannotStandOnABodyIsRejected) {
  const TemporaryFolder folder;
  Globe globe;
  globe.height = Bulges;
  const auto kindOf = [&](const RasterFile& file, const std::string& says) {
    try {
      StreamedTerrain::Open(file.Write(folder / "rejected.tif"), DegreesOnBody());
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
      return error.GetKind();
    }
    ADD_FAILURE() << "not rejected: " << says;
    return Error::Kind::Io;
  };
  RasterFile file = globe.File();
  file.crs = "EPSG:4326";
  EXPECT_EQ(kindOf(file, "ellipsoid"), Error::Kind::Unsupported);
  file = globe.File();
  file.crs = "+proj=stere +lat_0=60 +R=1737400 +units=m";
  EXPECT_EQ(kindOf(file, "projection of another kind"), Error::Kind::Unsupported);
  file = globe.File();
  file.crs.clear();
  file.verticalDatum.clear();
  EXPECT_EQ(kindOf(file, "no longitude"), Error::Kind::Unsupported);
  file = globe.File();
  file.geotransform = std::array<double, 6>{-180, 3.75, 0.1, 80, 0, -3};
  EXPECT_EQ(kindOf(file, "rotated"), Error::Kind::Unsupported);
  file = globe.File();
  file.geotransform = std::array<double, 6>{-180, 3.75, 0, -90, 0, 3.75};
  EXPECT_EQ(kindOf(file, "run to the north"), Error::Kind::Unsupported);
  file = globe.File();
  file.geotransform = std::array<double, 6>{-180, 5.0, 0, 90, 0, -3.75};
  EXPECT_EQ(kindOf(file, "more than once"), Error::Kind::InvalidArgument);
  StreamedTerrainOptions options = DegreesOnBody();
  options.origin = Eigen::Vector2d(0.0, 0.0);
  EXPECT_THROW(StreamedTerrain::Open(globe.File().Write(folder / "o.tif"), options), Error);
}

// Every pixel of the real grids, and places that are known.
void ExpectPixels(const StreamedTerrain& terrain, const std::string& path, double west_deg,
                  double scale) {
  GDALAllRegister();
  auto* dataset = GDALDataset::Open(path.c_str(), GDAL_OF_RASTER);
  ASSERT_NE(dataset, nullptr);
  const int width = dataset->GetRasterXSize();
  const int height = dataset->GetRasterYSize();
  std::vector<double> values(std::size_t(width) * height);
  ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, height, values.data(), width,
                                                height, GDT_Float64, 0, 0, nullptr),
            CE_None);
  int none = 0;
  const double noData = dataset->GetRasterBand(1)->GetNoDataValue(&none);
  GDALClose(dataset);
  Rows3 points(Eigen::Index(values.size()), 3);
  for (int r = 0; r < height; ++r) {
    for (int c = 0; c < width; ++c) {
      points.row(Eigen::Index(r) * width + c) =
          2e6 * Direction(west_deg + (c + 0.5) * 360.0 / width, 90.0 - (r + 0.5) * 180.0 / height);
    }
  }
  Eigen::VectorXd heights(points.rows());
  terrain.Heights(points, heights);
  int wrong = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double h = heights[Eigen::Index(i)];
    wrong +=
        none && values[i] == noData ? !std::isnan(h) : !(std::abs(h - values[i] * scale) < 2e-3);
  }
  EXPECT_EQ(wrong, 0) << path;
}

TEST(StreamedDegrees, WholeMarsIsMola) {
  DSPACE_REAL_DATA(path, "terrain/mars_mola_megt90n000cb_4ppd_m.tif");
  StreamedTerrainOptions options = DegreesOnBody();
  options.elevation.verticalDatum = VerticalDatum::FromText("areoid");
  const auto terrain = StreamedTerrain::Open(path, options);
  ExpectPixels(*terrain, path, 0.0, 1.0);
  EXPECT_EQ(terrain->HeightRange()[0], -8068.0);
  EXPECT_EQ(terrain->HeightRange()[1], 21134.0);
  const auto at = [&](double lon, double lat) {
    return terrain->Sample(Direction(lon, lat)).height;
  };
  // shared/data/README.md: 20009, -6151 and -2478 m; by the cell where each is read off.
  EXPECT_NEAR(at(-133.8, 18.65), 20009.0, 300.0); // Olympus Mons
  EXPECT_NEAR(at(70.5, -42.4), -6151.0, 100.0);   // Hellas
  EXPECT_NEAR(at(77.58, 18.38), -2478.0, 200.0);  // Jezero
  bool bounded = false;
  for (const std::string& warning : terrain->GetWarnings()) {
    bounded = bounded || warning.find("areoid") != std::string::npos;
  }
  EXPECT_TRUE(bounded);
  // Down from orbit onto Olympus Mons, which the sphere alone would let pass 20 km lower.
  const Eigen::Vector3d up = Direction(-133.8, 18.65);
  const RayHit hit = terrain->Intersect(1e7 * up, -up);
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(hit.distance, 1e7 - 3396190.0 - at(-133.8, 18.65), 1e-3);
}

TEST(StreamedDegrees, WholeMoonIsLola) {
  DSPACE_REAL_DATA(km, "terrain/moon_lola_global_4ppd_km.tif");
  DSPACE_REAL_DATA(cube, "terrain/moon_lola_ldem4_reduced.cub");
  StreamedTerrainOptions options = DegreesOnBody();
  options.elevation.verticalScale = 1000.0;
  options.elevation.verticalDatum = VerticalDatum::FromText("sphere:1737400");
  const auto fine = StreamedTerrain::Open(km, options);
  ExpectPixels(*fine, km, -180.0, 1000.0);
  EXPECT_NEAR(fine->HeightRange()[0], -8878.0, 1.0);
  EXPECT_NEAR(fine->HeightRange()[1], 10504.0, 1.0);
  const auto coarse = StreamedTerrain::Open(cube, DegreesOnBody());
  EXPECT_TRUE(coarse->Pyramid()->Lattice().periodic);
  ExpectPixels(*coarse, cube, 0.0, 0.5);
  EXPECT_EQ(coarse->Placement().Radius(), 1737400.0);
  // Two grids of one ground, in kilometres from -180 and as radii in metres from 0: 25 m rms apart
  // after averaging over the coarser one's pixels.
  double sum = 0.0;
  double mirrored = 0.0;
  int count = 0;
  for (int r = 4; r < 236; r += 3) {
    for (int c = 0; c < 480; c += 3) {
      const double lon = (c + 0.5) * 0.75;
      const double lat = 90.0 - (r + 0.5) * 0.75;
      double mean = 0.0;
      for (const double east : {-0.25, 0.0, 0.25}) {
        for (const double north : {-0.25, 0.0, 0.25}) {
          mean += fine->Sample(Direction(lon + east, lat + north)).height / 9.0;
        }
      }
      const double h = coarse->Sample(Direction(lon, lat)).height;
      if (!std::isnan(h)) {
        sum += (h - mean) * (h - mean);
        mirrored += std::pow(coarse->Sample(Direction(-lon, lat)).height - mean, 2);
        ++count;
      }
    }
  }
  EXPECT_GT(count, 10000);
  EXPECT_LT(std::sqrt(sum / count), 60.0);
  EXPECT_GT(std::sqrt(mirrored / count), 1000.0); // the check can fail
}

} // namespace
