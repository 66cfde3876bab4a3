// Rasters that GDAL opens: scale, offset, unit, no-data, place; and those that are rejected.
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/Utf8.h>
#include <dspace/raster/ElevationSource.h>
#include <dspace/surface/GridTerrain.h>

#include "RasterFile.h"
#include "TestData.h"

namespace {

using dspace::Crs;
using dspace::ElevationOptions;
using dspace::ElevationSource;
using dspace::Error;
using dspace::GridTerrain;
using dspace::GridTerrainOptions;
using dspace::VerticalDatum;
using dspace::testing::RasterFile;

const double NaN = std::numeric_limits<double>::quiet_NaN();

class Raster : public ::testing::Test {
protected:
  RasterFile File(int width = 8, int height = 6) const {
    RasterFile file;
    file.width = width;
    file.height = height;
    file.value = [](int c, int r, int) { return 10.0 * c + r; };
    file.geotransform = {{100.0, 2.0, 0.0, 500.0, 0.0, -2.0}};
    file.crs = "+proj=eqc +R=1737400 +type=crs";
    return file;
  }

  // Expects GridTerrain::Load to reject `path` with `kind`, naming the file and `words`, saying
  // nothing on stderr.
  void Rejected(const std::string& path, Error::Kind kind, const std::string& words,
                const GridTerrainOptions& options = {}) {
    ::testing::internal::CaptureStderr();
    std::string message;
    try {
      GridTerrain::Load(path, options);
      message = "was accepted";
    } catch (const Error& error) {
      message = error.what();
      EXPECT_EQ(static_cast<int>(error.GetKind()), static_cast<int>(kind)) << message;
      EXPECT_NE(message.find(path), std::string::npos) << message;
    }
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  }

  bool Warns(const ElevationSource& source, const std::string& words) {
    for (const std::string& warning : source.Info().warnings)
      if (warning.find(words) != std::string::npos)
        return true;
    return false;
  }

  dspace::testing::TemporaryFolder Folder;
};

} // namespace

TEST_F(Raster, TextOfAnotherEncodingBecomesUtf8) {
  RasterFile file = this->File();
  file.crs = "PROJCS[\"Sch\xF6"
             "fthal\",GEOGCS[\"Mond \xE4\",DATUM[\"D_\xFC\",SPHEROID[\"S\","
             "1737400,0]],PRIMEM[\"Reference_Meridian\",0],UNIT[\"Degree\",0.0174532925199433]],"
             "PROJECTION[\"Equirectangular\"],PARAMETER[\"standard_parallel_1\",0],"
             "PARAMETER[\"central_meridian\",0],UNIT[\"metre\",1]]";
  const std::string path = file.Write(this->Folder / "latin.tif");
  // GDAL writes the name as it is: the file does hold Latin-1.
  std::ifstream in(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  ASSERT_NE(bytes.find("Sch\xF6"
                       "fthal"),
            std::string::npos);
  const ElevationSource source(path);
  EXPECT_EQ(source.Info().crs.GetName(), "Sch\xC3\xB6"
                                         "fthal");
  EXPECT_TRUE(dspace::IsUtf8(source.Info().crs.GetWkt()));
  for (const std::string& warning : source.Info().warnings)
    EXPECT_TRUE(dspace::IsUtf8(warning)) << warning;
  file.unit = "\xE4";
  this->Rejected(file.Write(this->Folder / "unit.tif"), Error::Kind::Unsupported,
                 "heights in unit '\xC3\xA4'");
}

TEST_F(Raster, ReadsValuesByScaleOffsetAndUnit) {
  RasterFile file = this->File();
  file.type = GDT_Int16;
  file.scale = 0.5;
  file.offset = 3.0;
  file.unit = "km";
  const ElevationSource source(file.Write(this->Folder / "a.tif"));
  const std::vector<double> h = source.Read();
  ASSERT_EQ(h.size(), 48u);
  EXPECT_DOUBLE_EQ(h[0], 3000.0);
  EXPECT_DOUBLE_EQ(h[5 * 8 + 7], 1000.0 * (0.5 * 75.0 + 3.0));
  EXPECT_EQ(source.Info().unit, "km");
  EXPECT_EQ(source.Info().dataType, "Int16");
  EXPECT_EQ(source.Info().pixelToMap * Eigen::Vector2d(0.5, 0.5), Eigen::Vector2d(101.0, 499.0));
}

TEST_F(Raster, HandGivenScaleReplacesTheFiles) {
  RasterFile file = this->File();
  file.scale = 0.5;
  file.offset = 3.0;
  file.unit = "parsec";
  const std::string path = file.Write(this->Folder / "a.tif");
  this->Rejected(path, Error::Kind::Unsupported, "parsec");
  ElevationOptions options;
  options.verticalScale = 2.0;
  EXPECT_DOUBLE_EQ(ElevationSource(path, options).Read()[1], 20.0);
  options.verticalOffset = -1.0;
  EXPECT_DOUBLE_EQ(ElevationSource(path, options).Read()[1], 19.0);
  GridTerrainOptions bad;
  bad.elevation.verticalScale = 0.0;
  this->Rejected(path, Error::Kind::InvalidArgument, "vertical scale 0", bad);
  bad.elevation.verticalScale = NaN;
  this->Rejected(path, Error::Kind::InvalidArgument, "vertical scale", bad);
  bad.elevation.verticalScale = 1.0;
  bad.elevation.verticalOffset = INFINITY;
  this->Rejected(path, Error::Kind::InvalidArgument, "vertical offset", bad);
}

TEST_F(Raster, NoDataAndNaNAreHoles) {
  RasterFile file = this->File();
  file.noData = -9999.0;
  file.value = [](int c, int r, int) { return c == 2 ? -9999.0 : r == 3 ? NaN : 1.0 * c; };
  const std::vector<double> h = ElevationSource(file.Write(this->Folder / "a.tif")).Read();
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 8; ++c)
      if (c == 2 || r == 3)
        EXPECT_TRUE(std::isnan(h[r * 8 + c]));
      else
        EXPECT_EQ(h[r * 8 + c], c);
}

TEST_F(Raster, NoDataGivenByHandAreHolesToo) {
  RasterFile file = this->File();
  file.noData = -1.0;
  file.value = [](int c, int r, int) { return c == 2 ? -9999.0 : r == 3 ? -1.0 : 1.0 * c; };
  ElevationOptions options;
  options.noData = -9999.0;
  const std::string path = file.Write(this->Folder / "a.tif");
  const std::vector<double> h = ElevationSource(path, options).Read();
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 8; ++c)
      if (c == 2 || r == 3)
        EXPECT_TRUE(std::isnan(h[r * 8 + c]));
      else
        EXPECT_EQ(h[r * 8 + c], c);
  EXPECT_NE(ElevationSource(path, options).Identity(), ElevationSource(path).Identity());
  options.noData = NaN;
  EXPECT_THROW(ElevationSource(path, options), Error);
  // A value that float32 does not hold exactly.
  file.type = GDT_Float32;
  file.noData.reset();
  file.value = [](int c, int, int) { return c == 2 ? -3.4e38 : 1.0 * c; };
  options.noData = -3.4e38;
  EXPECT_TRUE(std::isnan(ElevationSource(file.Write(this->Folder / "b.tif"), options).Read()[2]));
}

TEST_F(Raster, NoDataGivenByHandIsNotMixedIntoReducedHeights) {
  RasterFile file = this->File(64, 32);
  file.value = [](int c, int r, int) { return (c + r) % 3 == 0 ? -9999.0 : 100.0 + c; };
  const std::string path = file.Write(this->Folder / "a.tif");
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(path.c_str(), GA_Update));
  int factors[] = {2, 4};
  ASSERT_EQ(dataset->BuildOverviews("AVERAGE", 2, factors, 0, nullptr, nullptr, nullptr), CE_None);
  GDALClose(dataset);
  ElevationOptions options;
  const auto least = [&](int width, int height) {
    const ElevationSource source(path, options);
    double found = 1e9;
    for (const double h : source.ReadReduced({0, 0, width, height}, 4))
      found = std::isnan(h) ? found : std::min(found, h);
    return found;
  };
  EXPECT_LT(least(64, 32), 0.0); // the means of the file's overviews
  options.noData = -9999.0;
  EXPECT_EQ(ElevationSource(path, options).Info().overviews, 0);
  for (const int width : {64, 63, 61})
    for (const int height : {32, 29}) {
      EXPECT_GE(least(width, height), 100.0);
      EXPECT_LE(least(width, height), 103.0); // of the first columns
    }
}

TEST_F(Raster, ValuesThatLookLikeNoDataAreReported) {
  const auto told = [&](const std::function<double(int, int, int)>& value,
                        std::optional<double> noData = {}, std::optional<double> scale = {}) {
    RasterFile file = this->File(40, 30);
    file.value = value;
    GridTerrainOptions options;
    options.elevation.noData = noData;
    options.elevation.verticalScale = scale;
    const auto terrain = GridTerrain::Load(file.Write(this->Folder / "a.tif"), options);
    for (const std::string& warning : terrain->GetWarnings()) {
      const std::size_t at = warning.find("state no_data=");
      if (at != std::string::npos)
        return warning.substr(at + 14);
    }
    return std::string();
  };
  const auto with = [](double fill, int pixels) {
    return [=](int c, int r, int) { return r == 5 && c < pixels ? fill : 10.0 * std::sin(c + r); };
  };
  EXPECT_EQ(told(with(-32768, 1)), "-32768");
  EXPECT_EQ(told(with(-9999, 30)), "-9999");
  EXPECT_EQ(told(with(-32768, 9), -32768.0), "");                   // what it asks for cures it
  EXPECT_EQ(told(with(-32768, 9), {}, 0.1).substr(0, 6), "-32768"); // as the file stores it
  EXPECT_EQ(told(with(-500, 5)).substr(0, 4), "-500");              // no usual value, but far away
  EXPECT_EQ(told(with(-500, 2)), ""); // two pixels: a hole in the ground
  EXPECT_EQ(told(with(30, 9)), "");   // near the others
  EXPECT_EQ(told(with(1e8, 9)).substr(0, 5), "10000");
  EXPECT_EQ(told([](int, int, int) { return -9999.0; }), ""); // level ground
  EXPECT_EQ(told([](int c, int, int) { return -9999.0 + 100.0 * c; }),
            ""); // ground that begins there
}

TEST_F(Raster, WindowIsItsOwnRaster) {
  const std::string path = this->File().Write(this->Folder / "a.tif");
  ElevationOptions options;
  options.window = {3, 2, 4, 3};
  const ElevationSource source(path, options);
  const std::vector<double> h = source.Read();
  ASSERT_EQ(h.size(), 12u);
  EXPECT_EQ(h[0], 32.0);
  EXPECT_EQ(h[11], 64.0);
  EXPECT_EQ(source.Info().pixelToMap * Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(106.0, 496.0));
  EXPECT_EQ(source.Read({1, 1, 1, 1})[0], 43.0);
  EXPECT_THROW(source.Read({3, 0, 2, 1}), Error);
  GridTerrainOptions bad;
  for (const dspace::RasterWindow window :
       {dspace::RasterWindow{-1, 0, 2, 2}, {0, 0, 0, 2}, {6, 0, 3, 2}, {0, 0, 2, 2147483647}}) {
    bad.elevation.window = window;
    this->Rejected(path, Error::Kind::InvalidArgument, "does not lie within", bad);
  }
}

TEST_F(Raster, WithoutGeoreferenceHasUnitPixelsAndAWarning) {
  RasterFile file = this->File();
  file.geotransform.reset();
  file.crs.clear();
  const std::string path = file.Write(this->Folder / "a.tif");
  const ElevationSource source(path);
  EXPECT_FALSE(source.Info().georeferenced);
  EXPECT_TRUE(this->Warns(source, "no georeference"));
  EXPECT_TRUE(this->Warns(source, "unit of height"));
  EXPECT_EQ(source.Info().pixelToMap * Eigen::Vector2d(8.0, 6.0), Eigen::Vector2d(8.0, 0.0));
  ElevationOptions options;
  options.pixelSize = 2.5;
  const ElevationSource sized(path, options);
  EXPECT_FALSE(this->Warns(sized, "no georeference"));
  EXPECT_EQ(sized.Info().pixelToMap * Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.0, 15.0));
  GridTerrainOptions bad;
  bad.elevation.pixelSize = -1.0;
  this->Rejected(path, Error::Kind::InvalidArgument, "pixel size", bad);
  bad = {};
  bad.elevation.crs = "EPSG:4326";
  this->Rejected(path, Error::Kind::InvalidArgument, "geographic", bad);
  // A terrain of it answers, without longitude and latitude.
  const auto terrain = GridTerrain::Load(path);
  EXPECT_EQ(terrain->SampleMap({0.5, 5.5}).height, 0.0);
  EXPECT_THROW(terrain->MapToGeographic({0.5, 5.5, 0.0}), Error);
}

TEST_F(Raster, RejectsFilesThatAreNoRasters) {
  this->Rejected(this->Folder / "absent.tif", Error::Kind::NotFound, "absent.tif");
  this->Rejected("", Error::Kind::NotFound, "");
  this->Rejected(std::filesystem::path(this->Folder / "x").parent_path().string(),
                 Error::Kind::Unsupported, "folder");
  const std::string empty = this->Folder / "empty.tif";
  std::ofstream(empty).close();
  this->Rejected(empty, Error::Kind::Corrupt, "empty");
  const std::string text = this->Folder / "text.tif";
  std::ofstream(text) << "this is no raster, whatever its name says\n";
  this->Rejected(text, Error::Kind::Unsupported, "not recognized");
}

TEST_F(Raster, RejectsTruncatedFiles) {
  RasterFile file = this->File(200, 200);
  const std::string path = file.Write(this->Folder / "whole.tif");
  const auto size = std::filesystem::file_size(path);
  for (double part : {0.9, 0.5, 0.1, 0.01, 0.0001}) {
    const std::string cut = this->Folder / "cut.tif";
    std::filesystem::copy_file(path, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut,
                                 static_cast<std::uintmax_t>(static_cast<double>(size) * part));
    ::testing::internal::CaptureStderr();
    EXPECT_THROW(GridTerrain::Load(cut), Error) << part;
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  }
}

TEST_F(Raster, RejectsWhatIsNoSurface) {
  RasterFile file = this->File();
  file.noData = 5.0;
  file.value = [](int c, int, int) { return c % 2 ? 5.0 : NaN; };
  this->Rejected(file.Write(this->Folder / "nodata.tif"), Error::Kind::InvalidArgument,
                 "without data");
  this->Rejected(this->File(1, 1).Write(this->Folder / "1x1.tif"), Error::Kind::InvalidArgument,
                 "1 x 1 posts");
  this->Rejected(this->File(9, 1).Write(this->Folder / "9x1.tif"), Error::Kind::InvalidArgument,
                 "9 x 1 posts");
  file = this->File();
  file.type = GDT_CFloat64;
  this->Rejected(file.Write(this->Folder / "complex.tif"), Error::Kind::Unsupported, "complex");
  file = this->File();
  file.bands = 2;
  const std::string two = file.Write(this->Folder / "two.tif");
  GridTerrainOptions options;
  for (int band : {0, 3, -1}) {
    options.elevation.band = band;
    this->Rejected(two, Error::Kind::InvalidArgument, "accepted are 1 to 2", options);
  }
  options = {};
  options.maximumPosts = 47;
  this->Rejected(two, Error::Kind::Resource, "47", options);
}

TEST_F(Raster, RejectsAWrongPlace) {
  RasterFile file = this->File();
  file.geotransform = {{0.0, 1.0, 2.0, 0.0, 0.5, 1.0}}; // parallel pixel vectors
  this->Rejected(file.Write(this->Folder / "flat.tif"), Error::Kind::InvalidArgument, "degenerate");
  file = this->File();
  file.crs = "IAU_2015:30100";
  file.geotransform = {{0.0, 1.0, 0.0, 100.0, 0.0, -1.0}}; // latitude 99.5
  this->Rejected(file.Write(this->Folder / "pole.tif"), Error::Kind::InvalidArgument, "99.5");
  GridTerrainOptions options;
  options.elevation.crs = "EPSG:4978";
  EXPECT_THROW(GridTerrain::Load(this->File().Write(this->Folder / "a.tif"), options), Error);
  options.elevation.crs = "rubbish";
  EXPECT_THROW(GridTerrain::Load(this->Folder / "a.tif", options), Error);
}

TEST_F(Raster, AnUnknownOrAnotherBodysCrsIsTold) {
  RasterFile file = this->File();
  const std::string moon = file.Write(this->Folder / "moon.tif");
  ElevationOptions options;
  options.crs = "+proj=eqc +lat_ts=10 +R=1737400 +type=crs"; // of the same body
  EXPECT_FALSE(this->Warns(ElevationSource(moon, options), "of a body of radius"));
  options.crs = "+proj=eqc +R=3396190 +type=crs";
  const ElevationSource given(moon, options);
  EXPECT_EQ(given.Info().crs.GetAxes().semiMajor, 3396190.0); // what is given by hand holds
  EXPECT_TRUE(this->Warns(given, "of a body of radius 3396190"));
  EXPECT_TRUE(this->Warns(given, "of one of 1737400"));
  file.crs.clear();
  const std::string unknown = file.Write(this->Folder / "unknown.tif");
  EXPECT_TRUE(this->Warns(ElevationSource(unknown), "no CRS"));
  EXPECT_FALSE(this->Warns(ElevationSource(unknown, options), "no CRS"));
  EXPECT_FALSE(this->Warns(ElevationSource(unknown, options), "of a body of radius"));
}

TEST_F(Raster, RejectsHeightsThatNothingHas) {
  RasterFile file = this->File();
  const auto value = file.value;
  file.value = [value](int c, int r, int b) { return c == 3 && r == 2 ? 1e30 : value(c, r, b); };
  const std::string path = file.Write(this->Folder / "high.tif");
  this->Rejected(path, Error::Kind::InvalidArgument, "high.tif");
  this->Rejected(path, Error::Kind::InvalidArgument, "column 3, row 2 has the height");
  file.noData = 1e30; // where the file says what it means, it is a hole
  EXPECT_NO_THROW(GridTerrain::Load(file.Write(this->Folder / "hole.tif")));
}

TEST_F(Raster, WritesNothingBesideTheFile) {
  const std::string path = this->File().Write(this->Folder / "only.tif");
  GridTerrain::Load(path);
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(path).parent_path()))
    files += entry.is_regular_file();
  EXPECT_EQ(files, 1);
}

TEST_F(Raster, CompoundCrsNamesTheGeoid) {
  RasterFile file = this->File();
  file.crs = "EPSG:26910+5703"; // UTM 10 with NAVD88 heights
  const ElevationSource source(file.Write(this->Folder / "a.tif"));
  EXPECT_EQ(source.Info().verticalDatum.kind, VerticalDatum::Kind::Geoid);
  EXPECT_NE(source.Info().verticalDatum.name.find("NAVD88"), std::string::npos);
  EXPECT_EQ(source.Info().crs.GetKind(), Crs::Kind::Projected);
}

TEST_F(Raster, MetadataStateTheVerticalDatum) {
  RasterFile file = this->File();
  file.verticalDatum = "sphere:1737400";
  const ElevationSource stated(file.Write(this->Folder / "a.tif"));
  EXPECT_EQ(stated.Info().verticalDatum.kind, VerticalDatum::Kind::Sphere);
  EXPECT_EQ(stated.Info().verticalDatum.radius, 1737400.0);
  ElevationOptions options; // what is given by hand comes first
  options.verticalDatum = VerticalDatum::FromText("areoid");
  const ElevationSource given(this->Folder / "a.tif", options);
  EXPECT_EQ(given.Info().verticalDatum.kind, VerticalDatum::Kind::Areoid);

  file.verticalDatum = "mean sea level, roughly";
  const ElevationSource unclear(file.Write(this->Folder / "b.tif"));
  EXPECT_EQ(unclear.Info().verticalDatum.kind, VerticalDatum::Kind::Unknown);
  bool named = false;
  for (const std::string& warning : unclear.Info().warnings)
    named = named || warning.find("mean sea level, roughly") != std::string::npos;
  EXPECT_TRUE(named);
}

TEST_F(Raster, IsisCubeHoldsRadii) {
  DSPACE_REAL_DATA(path, "terrain/moon_lola_ldem4_reduced.cub");
  const ElevationSource source(path);
  EXPECT_EQ(source.Info().verticalDatum.kind, VerticalDatum::Kind::Radius);
  EXPECT_EQ(source.Info().verticalDatum.radius, 1737400.0);
  const std::vector<double> h = source.Read();
  // gdalinfo: DN -15622 to 18282; radius = 0.5 DN + 1737400.
  EXPECT_EQ(*std::min_element(h.begin(), h.end()), -7811.0);
  EXPECT_EQ(*std::max_element(h.begin(), h.end()), 9141.0);
}

TEST_F(Raster, HeightsThatNoGroundHasAreSuspected) {
  const auto warned = [&](const std::function<double(int, int, int)>& value,
                          std::optional<double> scale = {}) {
    RasterFile file = this->File();
    file.value = value;
    GridTerrainOptions options;
    options.elevation.verticalScale = scale;
    const auto terrain = GridTerrain::Load(file.Write(this->Folder / "steep.tif"), options);
    std::string all;
    for (const std::string& warning : terrain->GetWarnings())
      all += warning;
    return all.find("vertical_scale (metres per unit)") != std::string::npos;
  };
  // Planes on pixels of 2 m, below and above 60 degrees.
  const auto plane = [](double slope_deg) {
    const double rise = 2.0 * std::tan(slope_deg * M_PI / 180.0);
    return [rise](int c, int, int) { return c == 0 ? NaN : rise * c; };
  };
  EXPECT_FALSE(warned(plane(59.5)));
  EXPECT_TRUE(warned(plane(60.5)));
  EXPECT_FALSE(warned(plane(60.5), 0.9)); // what it asks for cures it
  // One needle on a plain of 14 x 10 m, below and above twice its length.
  const auto needle = [](double height) {
    return [height](int c, int r, int) { return c == 4 && r == 3 ? height : 0.0; };
  };
  EXPECT_FALSE(warned(needle(27.0)));
  EXPECT_TRUE(warned(needle(29.0)));
}

TEST_F(Raster, KilometresAreGivenByHandOrSuspected) {
  DSPACE_REAL_DATA(path, "terrain/moon_lola_global_4ppd_km.tif");
  const auto suspect = GridTerrain::Load(path);
  std::string all;
  for (const std::string& warning : suspect->GetWarnings())
    all += warning;
  EXPECT_NE(all.find("suspiciously small"), std::string::npos) << all;
  GridTerrainOptions options;
  options.elevation.verticalScale = 1000.0;
  options.elevation.verticalDatum = VerticalDatum::FromText("sphere:1737400");
  const auto terrain = GridTerrain::Load(path, options);
  EXPECT_NEAR(terrain->Grid().GetMinimum(), -8878.5, 0.01);
  EXPECT_NEAR(terrain->Grid().GetMaximum(), 10504.0, 0.01);
  EXPECT_TRUE(terrain->GetWarnings().empty());
}
