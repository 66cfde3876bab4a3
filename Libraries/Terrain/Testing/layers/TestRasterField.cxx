// Values of co-registered rasters against GDAL's and PROJ's own.
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <thread>

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <proj.h>

#include <dspace/Error.h>
#include <dspace/layers/raster/RasterField.h>

#include "RasterFile.h"
#include "TestData.h"

namespace {

using dspace::Crs;
using dspace::Error;
using dspace::RasterField;
using dspace::RasterFieldOptions;
using dspace::RasterPlace;
using dspace::testing::RasterFile;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

// A raster as GDAL reads it, whole.
struct Whole {
  explicit Whole(const std::string& path) {
    GDALAllRegister();
    this->dataset = GDALDataset::Open(path.c_str(), GDAL_OF_RASTER);
    this->width = this->dataset->GetRasterXSize();
    this->height = this->dataset->GetRasterYSize();
    this->dataset->GetGeoTransform(this->geo);
    this->values = this->Read(1, nullptr);
  }
  ~Whole() { GDALClose(this->dataset); }
  // `factor` x `factor` values a pixel.
  std::vector<double> Read(int factor, const char* resampling) const {
    std::vector<double> all(std::size_t(this->width) * this->height * factor * factor);
    GDALRasterIOExtraArg how;
    INIT_RASTERIO_EXTRA_ARG(how);
    how.eResampleAlg = resampling ? GRIORA_Bilinear : GRIORA_NearestNeighbour;
    EXPECT_EQ(this->dataset->GetRasterBand(1)->RasterIO(
                  GF_Read, 0, 0, this->width, this->height, all.data(), this->width * factor,
                  this->height * factor, GDT_Float64, 0, 0, &how),
              CE_None);
    return all;
  }
  Eigen::Vector2d Map(double x, double y) const {
    return {this->geo[0] + x * this->geo[1], this->geo[3] + y * this->geo[5]};
  }
  RasterPlace Place(const Crs& crs) const {
    RasterPlace place;
    place.name = "terrain 'ground'";
    place.crs = crs;
    place.pixelToMap.linear() << this->geo[1], 0.0, 0.0, this->geo[5];
    place.pixelToMap.translation() << this->geo[0], this->geo[3];
    place.columns = this->width;
    place.rows = this->height;
    return place;
  }
  GDALDataset* dataset = nullptr;
  int width = 0;
  int height = 0;
  double geo[6] = {};
  std::vector<double> values;
};

// The bilinear value at pixel coordinates of a raster without holes.
double ByHand(const Whole& raster, double x, double y) {
  const double c = std::clamp(x - 0.5, 0.0, raster.width - 1.0);
  const double r = std::clamp(y - 0.5, 0.0, raster.height - 1.0);
  const int i = std::min(int(c), raster.width - 2);
  const int j = std::min(int(r), raster.height - 2);
  const double* p = &raster.values[std::size_t(j) * raster.width + i];
  const double above = p[0] + (c - i) * (p[1] - p[0]);
  const double below = p[raster.width] + (c - i) * (p[raster.width + 1] - p[raster.width]);
  return above + (r - j) * (below - above);
}

class Field : public ::testing::Test {
protected:
  Field() {
    this->Place.name = "terrain 'ground'";
    this->Place.pixelToMap.linear() << 1.0, 0.0, 0.0, -1.0;
    this->Place.pixelToMap.translation() << 0.0, 40.0;
    this->Place.columns = this->Place.rows = 40;
  }
  std::string Write(const char* name, const std::function<double(int, int)>& value,
                    std::function<void(RasterFile&)> change = {}, int side = 40) {
    RasterFile file;
    file.width = file.height = side;
    file.type = GDT_Float32;
    file.value = [value](int c, int r, int) { return value(c, r); };
    file.geotransform = {{0.0, 1.0, 0.0, double(side), 0.0, -1.0}};
    if (change) {
      change(file);
    }
    return file.Write(this->Folder / name);
  }
  static double At(const RasterField& field, double x, double y) {
    return field.Values(Eigen::Vector2d(x, y))[0];
  }

  dspace::testing::TemporaryFolder Folder;
  RasterPlace Place;
};

std::string MessageOf(const std::function<void()>& call, Error::Kind kind) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), kind) << error.what();
    return error.what();
  }
  return "nothing was thrown";
}

} // namespace

// Sixteen values a pixel, of every third row of them, of the whole Moon at 4 pixels a degree:
// GDAL's own bilinear values, except beside the seam, which GDAL does not know.
TEST_F(Field, BilinearValuesAreGdals) {
  DSPACE_REAL_DATA(path, "terrain/moon_lola_global_4ppd_km.tif");
  const Whole raster(path);
  const RasterField field("height", path,
                          raster.Place(Crs::FromOgr(*raster.dataset->GetSpatialRef())));
  const int factor = 4;
  const std::vector<double> expected = raster.Read(factor, "bilinear");
  const int columns = raster.width * factor;
  const int rows = raster.height * factor;
  double worst = 0.0;
  std::int64_t compared = 0;
  for (int r = 0; r < rows; r += 3) {
    Eigen::Matrix2Xd places(2, columns);
    for (int c = 0; c < columns; ++c) {
      places.col(c) = raster.Map((c + 0.5) / factor, (r + 0.5) / factor);
    }
    const Eigen::VectorXd values = field.Values(places);
    for (int c = factor; c < columns - factor; ++c) {
      worst = std::max(worst, std::abs(values[c] - expected[std::size_t(r) * columns + c]));
      ++compared;
    }
  }
  EXPECT_GT(compared, 5000000);
  EXPECT_LT(worst, 2e-6); // km; GDAL computes them with floats of up to 10
  RasterFieldOptions nearest;
  nearest.nearest = true;
  const RasterField pixels("pixels", path,
                           raster.Place(Crs::FromOgr(*raster.dataset->GetSpatialRef())), nearest);
  for (int i = 0; i < 1000; ++i) {
    const int c = i * 37 % raster.width;
    const int r = i * 53 % raster.height;
    const Eigen::Vector2d map = raster.Map(c + 0.999, r + 0.001);
    EXPECT_EQ(At(pixels, map.x(), map.y()), raster.values[std::size_t(r) * raster.width + c]);
  }
}

// A polar stereographic raster on a plate carree of the Moon; places go through PROJ directly.
TEST_F(Field, ValuesAcrossProjections) {
  DSPACE_REAL_DATA(path, "terrain/moon_npole_stereo_33.tif");
  DSPACE_REAL_DATA(globe, "terrain/moon_lola_global_4ppd_km.tif");
  const Whole raster(path);
  const Whole ground(globe);
  const RasterField field("pole", path,
                          ground.Place(Crs::FromOgr(*ground.dataset->GetSpatialRef())));
  EXPECT_NEAR(field.PixelSize(), std::abs(raster.geo[1]), 0.01);
  char* text = nullptr;
  raster.dataset->GetSpatialRef()->exportToProj4(&text);
  PJ* projection = proj_create(PJ_DEFAULT_CTX, text);
  ASSERT_NE(projection, nullptr) << text;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> inside(0.0, raster.width);
  Eigen::Matrix2Xd degrees(2, 2000);
  std::vector<double> expected;
  for (Eigen::Index i = 0; i < degrees.cols(); ++i) {
    const double x = inside(random);
    const double y = inside(random);
    const Eigen::Vector2d map = raster.Map(x, y);
    const PJ_COORD p = proj_trans(projection, PJ_INV, proj_coord(map.x(), map.y(), 0.0, 0.0));
    degrees.col(i) << proj_todeg(p.lp.lam), proj_todeg(p.lp.phi);
    expected.push_back(ByHand(raster, x, y));
  }
  proj_destroy(projection);
  CPLFree(text);
  const Eigen::VectorXd values = field.Values(degrees);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    EXPECT_NEAR(values[i], expected[std::size_t(i)], 1e-5); // m; 1e-13 degrees are 3e-9 m
  }
  EXPECT_TRUE(std::isnan(At(field, 10.0, 0.0))); // far from it
}

TEST_F(Field, ScaleOffsetUnitAndBandOfADouble) {
  const auto value = [](int c, int r) { return 1e9 + c + 100.0 * r; }; // more than a float holds
  const std::string path = this->Write("scaled.tif", value, [](RasterFile& file) {
    file.type = GDT_Float64;
    file.scale = 0.5;
    file.offset = -3.0;
    file.unit = "K";
    file.bands = 2;
    file.value = [](int c, int r, int band) { return 1e9 + c + 100.0 * r + 1e6 * band; };
  });
  RasterFieldOptions second;
  second.band = 2;
  const RasterField field("temperature", path, this->Place, second);
  EXPECT_EQ(field.Units(), "K");
  EXPECT_DOUBLE_EQ(At(field, 7.5, 40.0 - 3.5), 0.5 * (1e9 + 7.0 + 300.0 + 1e6) - 3.0);
  EXPECT_DOUBLE_EQ(At(field, 7.75, 40.0 - 3.5), 0.5 * (1e9 + 7.25 + 300.0 + 1e6) - 3.0);
  second.units = "degC";
  EXPECT_EQ(RasterField("temperature", path, this->Place, second).Units(), "degC");
}

// A bilinear value leaves holes out; it is none where its own pixel is one.
TEST_F(Field, NoDataIsLeftOutOrNaN) {
  const auto value = [](int c, int r) { return c == 10 && r == 20 ? -99.0 : 2.0 * c + 3.0 * r; };
  const std::string path =
      this->Write("hole.tif", value, [](RasterFile& file) { file.noData = -99.0; });
  const RasterField field("hole", path, this->Place);
  const auto at = [&](double x, double y) { return At(field, x, 40.0 - y); };
  EXPECT_TRUE(std::isnan(at(10.5, 20.5)));
  EXPECT_TRUE(std::isnan(at(10.01, 20.99)));
  EXPECT_DOUBLE_EQ(at(9.5, 20.5), 18.0 + 60.0);
  EXPECT_DOUBLE_EQ(at(9.9, 20.5), 18.0 + 60.0); // of one neighbour alone
  // Above the hole, between (9, 19), (10, 19), (9, 20): weights 0.3, 0.3, 0.2 of 0.8.
  EXPECT_NEAR(at(10.0, 19.9), (0.3 * 75.0 + 0.3 * 77.0 + 0.2 * 78.0) / 0.8, 1e-12);
  EXPECT_DOUBLE_EQ(at(0.0, 0.0), 0.0); // beyond the centres of the outermost pixels
  EXPECT_DOUBLE_EQ(at(40.0, 40.0), 2.0 * 39.0 + 3.0 * 39.0);
  EXPECT_TRUE(std::isnan(at(40.01, 10.0)));
  EXPECT_TRUE(std::isnan(at(-0.01, 10.0)));
  EXPECT_TRUE(std::isnan(at(10.0, 40.01)));
}

TEST_F(Field, ValuesMeetAtTheSeam) {
  const int width = 360;
  const auto value = [](int c, int) { return std::sin((c + 0.5) * M_PI / 180.0); };
  RasterFile file;
  file.width = width;
  file.height = 180;
  file.type = GDT_Float64;
  file.value = [value](int c, int r, int) { return value(c, r); };
  file.geotransform = {{0.0, 1.0, 0.0, 90.0, 0.0, -1.0}};
  file.crs = "+proj=longlat +R=1737400 +no_defs";
  const std::string path = file.Write(this->Folder / "turn.tif");
  RasterPlace globe;
  globe.name = "terrain 'globe'";
  globe.crs = Crs::FromText(file.crs);
  globe.pixelToMap.linear() << 1.0, 0.0, 0.0, -1.0;
  globe.pixelToMap.translation() << -180.0, 90.0; // its seam is elsewhere
  globe.columns = 360;
  globe.rows = 180;
  const RasterField field("turn", path, globe);
  for (double longitude = -180.0; longitude <= 180.0; longitude += 0.125) {
    const double c = longitude - 0.5 - 360.0 * std::floor((longitude - 0.5) / 360.0);
    const double part = c - std::floor(c);
    const double expected = (1.0 - part) * value(int(c), 0) + part * value((int(c) + 1) % width, 0);
    EXPECT_NEAR(At(field, longitude, 12.3), expected, 1e-12) << longitude;
  }
}

TEST_F(Field, RejectsByName) {
  using Kind = Error::Kind;
  const auto plain = [](int, int) { return 1.0; };
  const std::string far = this->Write("far.tif", plain, [](RasterFile& file) {
    file.geotransform = {{1000.0, 1.0, 0.0, 40.0, 0.0, -1.0}};
  });
  std::string text =
      MessageOf([&] { RasterField("soil", far, this->Place); }, Kind::InvalidArgument);
  EXPECT_NE(text.find("field 'soil'"), std::string::npos) << text;
  EXPECT_NE(text.find("does not overlap terrain 'ground'"), std::string::npos) << text;
  const std::string mars = this->Write("mars.tif", plain, [](RasterFile& file) {
    file.crs = "+proj=longlat +R=3396190 +no_defs";
    file.geotransform = {{0.0, 0.1, 0.0, 4.0, 0.0, -0.1}};
  });
  RasterPlace moon = this->Place;
  moon.crs = Crs::FromText("+proj=longlat +R=1737400 +no_defs");
  text = MessageOf([&] { RasterField("soil", mars, moon); }, Kind::Unsupported);
  EXPECT_NE(text.find("another body"), std::string::npos) << text;
  RasterFieldOptions third;
  third.band = 3;
  MessageOf([&] { RasterField("soil", far, this->Place, third); }, Kind::InvalidArgument);
  MessageOf([&] { RasterField("soil", this->Folder / "absent.tif", this->Place); }, Kind::NotFound);
}

// Tiles come and go under a budget of four of them, in eight threads at once.
TEST_F(Field, ThreadsAndBudget) {
  const int side = 1024;
  const auto value = [](int c, int r) { return c + 2000.0 * r; };
  const std::string path = this->Write("large.tif", value, {}, side);
  RasterPlace place = this->Place;
  place.columns = place.rows = side;
  place.pixelToMap.translation() << 0.0, side;
  RasterFieldOptions small;
  small.byteBudget = 1;
  const RasterField field("large", path, place, small);
  std::vector<std::thread> threads;
  std::vector<int> wrong(8, -1);
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&, t] {
      std::mt19937 random(t);
      std::uniform_real_distribution<double> inside(0.5, side - 0.5);
      Eigen::Matrix2Xd places(2, 5000);
      for (Eigen::Index i = 0; i < places.size(); ++i) {
        places.data()[i] = inside(random);
      }
      const Eigen::VectorXd values = field.Values(places);
      wrong[t] = 0;
      for (Eigen::Index i = 0; i < places.cols(); ++i) {
        const double expected = places(0, i) - 0.5 + 2000.0 * (side - places(1, i) - 0.5);
        wrong[t] += std::abs(values[i] - expected) > 1e-6 ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(wrong, std::vector<int>(8, 0));
  EXPECT_LE(field.Bytes(), std::size_t(600000));
  EXPECT_GT(field.Bytes(), std::size_t(0));
}
