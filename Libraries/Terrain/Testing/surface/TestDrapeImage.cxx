// Shaded relief by Lambert's law, and images warped to a terrain, against PROJ pixel by pixel.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <proj.h>

#include <dspace/Error.h>
#include <dspace/mesh/DrapeImage.h>
#include <dspace/mesh/ShadedRelief.h>
#include <dspace/mesh/WarpImage.h>

#include "Grids.h"
#include "RasterFile.h"
#include "TestData.h"

namespace {

using dspace::Crs;
using dspace::DrapeImage;
using dspace::DrapeSource;
using dspace::Error;
using dspace::GridTerrain;
using dspace::ShadedReliefOptions;
using dspace::testing::NorthUp;
using dspace::testing::RasterFile;
using dspace::testing::Sampled;

std::shared_ptr<const GridTerrain> FlatGround(int columns, int rows,
                                              const Eigen::Affine2d& pixelToMap, const Crs& crs) {
  return std::make_shared<GridTerrain>("flat", columns, rows,
                                       std::vector<double>(columns * rows, 1.0), pixelToMap, crs);
}

class Drape : public ::testing::Test {
protected:
  // A whole body in plate carree, 2 degrees a pixel: red by longitude, green by latitude, `left`
  // its left edge; red turns round smoothly.
  std::string Globe(double left, const std::string& crs) {
    RasterFile file;
    file.width = 180;
    file.height = 90;
    file.bands = 3;
    file.type = GDT_Byte;
    file.value = [left](int c, int r, int b) {
      const double lon = left + 2.0 * (c + 0.5), lat = 90.0 - 2.0 * (r + 0.5);
      return b == 0 ? std::round(Red(lon)) : b == 1 ? std::round(Green(lat)) : 7.0;
    };
    file.geotransform = {{left, 2.0, 0.0, 90.0, 0.0, -2.0}};
    file.crs = crs;
    return file.Write(this->Folder / "globe.tif");
  }
  static double Red(double lon) { return 127.5 + 120.0 * std::sin(lon * M_PI / 180.0); }
  static double Green(double lat) { return 127.5 + lat; }

  // Each pixel's colour against the functions above at the longitude and latitude of its middle.
  void ExpectGlobe(const GridTerrain& terrain, const DrapeImage& image, double tolerance) {
    ASSERT_EQ(image.pixels.size(), 3u * image.width * image.height);
    double worst = 0.0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const Eigen::Vector2d map =
            terrain.PixelToMap() *
            Eigen::Vector2d((x + 0.5) * terrain.Grid().GetColumns() / image.width,
                            (y + 0.5) * terrain.Grid().GetRows() / image.height);
        const Eigen::Vector3d place = terrain.MapToGeographic({map.x(), map.y(), 0.0});
        const std::uint8_t* p = &image.pixels[3 * (y * image.width + x)];
        EXPECT_EQ(image.coverage[y * image.width + x], 255) << x << " " << y;
        worst = std::max({worst, std::abs(p[0] - Red(place.x())), std::abs(p[1] - Green(place.y())),
                          std::abs(p[2] - 7.0)});
      }
    EXPECT_LT(worst, tolerance);
  }

  dspace::testing::TemporaryFolder Folder;
};

Error::Kind KindOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.GetKind();
  }
  return Error::Kind::Internal;
}

} // namespace

TEST_F(Drape, ReliefFollowsLambert) {
  // A plane that rises to the east by 1: its normal leans west. Sun in the west, 30 degrees up.
  const auto slope =
      Sampled(20, 10, NorthUp(0.0, 0.0, 1.0), [](const Eigen::Vector2d& m) { return m.x(); });
  ShadedReliefOptions options;
  options.sunAzimuth_deg = 270.0;
  options.sunElevation_deg = 30.0;
  options.ambient = 0.2;
  options.ramp = {{1.0, 0.5, 0.0}};
  const DrapeImage image = ShadedRelief(*slope, options);
  ASSERT_EQ(image.width, 20);
  ASSERT_EQ(image.height, 10);
  const double light = 0.2 + 0.8 * std::cos(15.0 * M_PI / 180.0); // 45 against 30 degrees
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    EXPECT_EQ(image.pixels[i], std::lround(255.0 * light));
    EXPECT_EQ(image.pixels[i + 1], std::lround(127.5 * light));
    EXPECT_EQ(image.pixels[i + 2], 0);
  }
  options.sunAzimuth_deg = 90.0; // behind it: only ambient light
  EXPECT_EQ(ShadedRelief(*slope, options).pixels[0], std::lround(255.0 * 0.2));
}

TEST_F(Drape, ReliefColoursByHeightFromTheTopRow) {
  const auto rise = Sampled(11, 11, NorthUp(0.0, 10.5, 1.0),
                            [](const Eigen::Vector2d& m) { return 1e-6 * m.y(); });
  ShadedReliefOptions options;
  options.sunElevation_deg = 90.0;
  options.ramp = {{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}};
  const DrapeImage image = ShadedRelief(*rise, options);
  for (int row = 0; row < 11; ++row) // north is high, and on top
    EXPECT_NEAR(image.pixels[3 * 11 * row], 255.0 * (10 - row) / 10.0, 1.0);
  options.maximumSize = 5;
  EXPECT_EQ(ShadedRelief(*rise, options).width, 5);
}

TEST_F(Drape, ReliefRejectsBadOptions) {
  const auto flat = FlatGround(4, 4, NorthUp(0.0, 0.0, 1.0), Crs());
  const auto rejected = [&](const std::function<void(ShadedReliefOptions&)>& change) {
    ShadedReliefOptions options;
    change(options);
    return KindOf([&] { ShadedRelief(*flat, options); }) == Error::Kind::InvalidArgument;
  };
  EXPECT_TRUE(rejected([](auto& o) { o.sunElevation_deg = 91.0; }));
  EXPECT_TRUE(rejected([](auto& o) { o.sunAzimuth_deg = NAN; }));
  EXPECT_TRUE(rejected([](auto& o) { o.ambient = -0.1; }));
  EXPECT_TRUE(rejected([](auto& o) { o.exaggeration = 0.0; }));
  EXPECT_TRUE(rejected([](auto& o) { o.ramp.clear(); }));
  EXPECT_TRUE(rejected([](auto& o) { o.ramp = {{2.0, 0.0, 0.0}}; }));
  EXPECT_TRUE(rejected([](auto& o) { o.rampLow = 3.0, o.rampHigh = 2.0; }));
  EXPECT_TRUE(rejected([](auto& o) { o.maximumSize = 0; }));
  EXPECT_TRUE(rejected([](auto& o) { o.maximumSize = 100000; }));
}

TEST_F(Drape, TheSameGridIsCopied) {
  RasterFile file;
  file.width = 16;
  file.height = 12;
  file.bands = 3;
  file.type = GDT_Byte;
  file.value = [](int c, int r, int b) { return (c * 37 + r * 91 + b * 53) % 256; };
  file.geotransform = {{100.0, 2.0, 0.0, 500.0, 0.0, -2.0}};
  file.crs = "+proj=eqc +R=1737400 +type=crs";
  const std::string path = file.Write(this->Folder / "same.tif");
  const auto terrain = FlatGround(16, 12, NorthUp(100.0, 500.0, 2.0), Crs::FromText(file.crs));
  const DrapeImage image = WarpImage(PlaceOf(*terrain), {path, {}, {}});
  ASSERT_EQ(image.width, 16);
  ASSERT_EQ(image.height, 12);
  int wrong = 0;
  for (int r = 0; r < 12; ++r)
    for (int c = 0; c < 16; ++c)
      for (int b = 0; b < 3; ++b)
        wrong += image.pixels[3 * (r * 16 + c) + b] != file.value(c, r, b);
  EXPECT_EQ(wrong, 0);
  EXPECT_TRUE(image.warnings.empty());
}

TEST_F(Drape, AnotherProjectionByProj) {
  const std::string path = this->Globe(-180.0, "IAU_2015:30100");
  // Around the north pole, across every meridian.
  const Crs polar = Crs::FromText("+proj=stere +lat_0=90 +lon_0=0 +R=1737400 +type=crs");
  const auto pole = FlatGround(60, 60, NorthUp(-600000.0, 600000.0, 20000.0), polar);
  const DrapeImage image = WarpImage(PlaceOf(*pole), {path, {}, {}});
  ASSERT_EQ(image.width, 60);
  // At the pole itself 180 columns meet, which bilinear interpolation does not follow: looked at
  // away from it.
  double worst = 0.0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Eigen::Vector2d map = pole->PixelToMap() * Eigen::Vector2d(x + 0.5, y + 0.5);
      if (map.norm() < 100000.0)
        continue;
      const Eigen::Vector3d place = pole->MapToGeographic({map.x(), map.y(), 0.0});
      const std::uint8_t* p = &image.pixels[3 * (y * image.width + x)];
      EXPECT_EQ(image.coverage[y * image.width + x], 255);
      worst = std::max({worst, std::abs(p[0] - Red(place.x())), std::abs(p[1] - Green(place.y()))});
    }
  EXPECT_LT(worst, 1.6);
}

TEST_F(Drape, AGlobeWhoseLeftEdgeIsElsewhere) {
  const Crs mars = Crs::FromText("IAU_2015:49900");
  for (double left : {-180.0, 0.0, 90.0}) {
    const std::string path = this->Globe(left, "IAU_2015:49900");
    for (double west : {0.0, -180.0}) { // whole body
      Eigen::Affine2d m = Eigen::Affine2d::Identity();
      m.linear() << 4.0, 0.0, 0.0, -4.0;
      m.translation() << west, 88.0;
      const auto globe = FlatGround(90, 44, m, mars);
      this->ExpectGlobe(*globe, WarpImage(PlaceOf(*globe), {path, {}, {}}), 1.6);
    }
    Eigen::Affine2d m = Eigen::Affine2d::Identity(); // a window across the seam
    m.linear() << 0.5, 0.0, 0.0, -0.5;
    m.translation() << left - 10.0, 10.0;
    const auto window = FlatGround(40, 40, m, mars);
    this->ExpectGlobe(*window, WarpImage(PlaceOf(*window), {path, {}, {}}), 1.6);
  }
}

TEST_F(Drape, PartialImagesAreMarkedAndLaidOver) {
  const std::string path = this->Globe(-180.0, "IAU_2015:49900");
  const Crs mars = Crs::FromText("IAU_2015:49900");
  const auto terrain = FlatGround(40, 20, NorthUp(0.0, 10.0, 1.0), mars);
  DrapeSource source{path, {}, {{20.0, 10.0, 60.0, -10.0}}}; // only the eastern half
  const DrapeImage part = WarpImage(PlaceOf(*terrain), source);
  ShadedReliefOptions relief;
  relief.ramp = {{0.0, 0.0, 1.0}};
  relief.sunElevation_deg = 90.0;
  const DrapeImage over = Over(part, ShadedRelief(*terrain, relief));
  for (int x = 0; x < part.width; ++x) {
    const std::size_t i = static_cast<std::size_t>(part.height / 2) * part.width + x;
    const double column = (x + 0.5) * 40.0 / part.width;
    if (column < 18.5) {
      EXPECT_EQ(part.coverage[i], 0);
      EXPECT_EQ(part.pixels[3 * i], 90);
      EXPECT_EQ(over.pixels[3 * i + 2], 255);
    } else if (column > 21.5) {
      EXPECT_EQ(part.coverage[i], 255);
      EXPECT_EQ(over.pixels[3 * i + 2], 7);
    }
  }
}

TEST_F(Drape, RejectsWhatDoesNotFit) {
  const std::string path = this->Globe(-180.0, "IAU_2015:49900");
  const auto mars = FlatGround(4, 4, NorthUp(0.0, 4.0, 1.0), Crs::FromText("IAU_2015:49900"));
  const auto moon = FlatGround(4, 4, NorthUp(0.0, 4.0, 1.0), Crs::FromText("IAU_2015:30100"));
  const auto warp = [](const GridTerrain& terrain, const DrapeSource& source, int size = 4096) {
    ::testing::internal::CaptureStderr();
    dspace::WarpOptions options;
    options.maximumSize = size;
    const Error::Kind kind = KindOf([&] { WarpImage(PlaceOf(terrain), source, options); });
    EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
    return kind;
  };
  EXPECT_EQ(warp(*moon, {path, {}, {}}), Error::Kind::Unsupported); // another body
  EXPECT_EQ(warp(*mars, {path, {}, {{200.0, 4.0, 210.0, 0.0}}}), Error::Kind::InvalidArgument);
  EXPECT_EQ(warp(*mars, {path, {}, {{0.0, 4.0, 0.0, 0.0}}}), Error::Kind::InvalidArgument);
  EXPECT_EQ(warp(*mars, {path, {}, {}}, 0), Error::Kind::InvalidArgument);
  EXPECT_EQ(warp(*mars, {this->Folder / "absent.png", {}, {}}), Error::Kind::NotFound);
  const std::string text = this->Folder / "text.png";
  std::ofstream(text) << "no picture";
  EXPECT_EQ(warp(*mars, {text, {}, {}}), Error::Kind::Unsupported);
  RasterFile file;
  file.width = file.height = 4;
  file.value = [](int, int, int) { return 1.0; };
  EXPECT_EQ(warp(*mars, {file.Write(this->Folder / "float.tif"), {}, {}}),
            Error::Kind::Unsupported);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  EXPECT_EQ(warp(*mars, {path, {}, {}}), Error::Kind::Corrupt);
}

TEST_F(Drape, RealImagesOnRealGround) {
  DSPACE_REAL_DATA(gale, "terrain/mars_gale_mola_128ppd_m.tif");
  DSPACE_REAL_DATA(hrsc, "textures/mars_gale_hrsc_color_4096.jpg");
  DSPACE_REAL_DATA(mola, "terrain/mars_mola_megt90n000cb_4ppd_m.tif");
  DSPACE_REAL_DATA(viking, "textures/mars_viking_mdim21_color_2880.jpg");
  DrapeSource source;
  source.path = hrsc;
  source.crs = "+proj=eqc +R=3396190 +type=crs";
  source.extent = {{8068200.0, -223600.0, 8268200.0, -413600.0}};
  dspace::WarpOptions options;
  options.maximumSize = 900;
  const auto terrain = GridTerrain::Load(gale);
  const DrapeImage part = WarpImage(PlaceOf(*terrain), source, options);
  double covered = 0.0;
  for (std::uint8_t v : part.coverage)
    covered += v / 255.0;
  // 3.3742 by 3.2054 degrees of 7.0078 squared.
  EXPECT_NEAR(covered / static_cast<double>(part.coverage.size()),
              3.3742 * 3.2054 / (7.0078125 * 7.0078125), 0.002);

  DrapeSource whole;
  whole.path = viking;
  whole.crs = "IAU_2015:49900";
  whole.extent = {{-180.0, 90.0, 180.0, -90.0}};
  const auto mars = GridTerrain::Load(mola);
  options.maximumSize = 1440;
  const DrapeImage all = WarpImage(PlaceOf(*mars), whole, options);
  EXPECT_EQ(std::count(all.coverage.begin(), all.coverage.end(), 255),
            static_cast<long>(all.coverage.size()));
  // Syrtis Major at 69 E, 9 N is dark; Arabia at 20 E, 20 N is bright; the grid starts at 0 E.
  const auto red = [&](double lon, double lat) {
    return all.pixels[3 * (static_cast<std::size_t>((90.0 - lat) * 4.0) * all.width +
                           static_cast<std::size_t>(lon * 4.0))];
  };
  EXPECT_LT(red(69.0, 9.0) + 30, red(20.0, 20.0));
}
