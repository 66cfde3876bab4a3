// Shapes on a whole body: across the date line, around poles, on every chart.
#include <cmath>

#include "VectorTestSupport.h"

namespace dspace::testing {
namespace {

constexpr int Zoom = 2; // texels of 180 / 1024 degrees
constexpr double Texel = 180.0 / 1024.0;

std::shared_ptr<const ColorLayer> Open(const TemporaryFolder& folder, const std::string& features,
                                       const VectorLayerOptions& options = FillOnly()) {
  return OpenVectorLayer(Write(folder / "s.json", features), BodyChart().place, options);
}

double At(const ColorLayer& layer, double lon, double lat) {
  return OpacityAt(layer, BodyChart().grid, Zoom, {lon, lat});
}

// In a pole's chart.
double AtPole(const ColorLayer& layer, bool south, double lon, double lat) {
  const ColorGrid grid = BodyChart::Pole(south);
  const double l = lon * M_PI / 180.0, p = lat * M_PI / 180.0;
  const Eigen::Vector3d at =
      Mars * Eigen::Vector3d(std::cos(p) * std::cos(l), std::cos(p) * std::sin(l), std::sin(p));
  return OpacityAt(layer, grid, Zoom, grid.postToMap * grid.placement.ToPosts(at).head<2>());
}

// In square degrees.
double Sum(const ColorLayer& layer) {
  return Painted(layer, BodyChart().grid, {Zoom, 0, 0, 2048, 1024}).Sum() * Texel * Texel;
}

TEST(VectorBody, AnAreaAcrossTheDateLineIsTheSmallOne) {
  const TemporaryFolder folder;
  for (const char* text : {"[[[179,-1],[-179,-1],[-179,1],[179,1],[179,-1]]]",
                           "[[[-179,-1],[-179,1],[179,1],[179,-1],[-179,-1]]]",
                           "[[[179,-1],[181,-1],[181,1],[179,1],[179,-1]]]",
                           "[[[-181,-1],[-179,-1],[-179,1],[-181,1],[-181,-1]]]"}) {
    const auto layer = Open(folder, Feature("Polygon", text));
    EXPECT_NEAR(Sum(*layer), 4.0, 0.01) << text;
    EXPECT_EQ(At(*layer, 179.9, 0.3), 1.0);
    EXPECT_EQ(At(*layer, -179.9, 0.3), 1.0);
    EXPECT_EQ(At(*layer, 0.1, 0.3), 0.0);
    // In any turn, and across the seam.
    const ColorGrid grid = BodyChart().grid;
    for (const std::int64_t turn : {-2048, 0, 2048, 4096}) {
      const Painted seam(*layer, grid, {Zoom, turn - 20, 500, 40, 24});
      EXPECT_NEAR(seam.Sum() * Texel * Texel, 4.0, 0.01) << turn;
    }
  }
}

TEST(VectorBody, AHoleStaysAcrossTheDateLine) {
  const TemporaryFolder folder;
  const auto layer = Open(folder, Feature("Polygon", "[[[170,-10],[-170,-10],[-170,10],[170,10],"
                                                     "[170,-10]],[[-178,-1],[-176,-1],[-176,1],"
                                                     "[-178,1],[-178,-1]]]"));
  EXPECT_NEAR(Sum(*layer), 400.0 - 4.0, 0.2);
  EXPECT_EQ(At(*layer, -177.0, 0.2), 0.0);
  EXPECT_EQ(At(*layer, 177.0, 0.2), 1.0);
}

TEST(VectorBody, ALineTakesTheShorterWay) {
  const TemporaryFolder folder;
  VectorLayerOptions options;
  const auto layer = Open(folder, Feature("LineString", "[[170,10.1],[-170,10.1]]"), options);
  EXPECT_GT(At(*layer, 175.0, 10.1), 0.9);
  EXPECT_GT(At(*layer, 179.95, 10.1), 0.9);
  EXPECT_GT(At(*layer, -175.0, 10.1), 0.9);
  EXPECT_EQ(At(*layer, 0.0, 10.1), 0.0);
  // A whole turn is a way all along.
  const auto parallel = Open(folder, Feature("LineString", "[[-180,10.1],[180,10.1]]"), options);
  EXPECT_GT(At(*parallel, 0.0, 10.1), 0.9);
  EXPECT_GT(At(*parallel, 175.0, 10.1), 0.9);
}

// A ring of latitude, without an edge along the date line; then as a frame that has one.
TEST(VectorBody, ARingAroundAPoleContainsIt) {
  const TemporaryFolder folder;
  for (const double side : {1.0, -1.0}) {
    for (const int direction : {1, -1}) {
      for (const int last : {350, 360}) { // or its first place twice, at -180 and 180
        std::string ring = "[";
        for (int lon = 0; lon <= last; lon += 10) {
          ring += "[" + std::to_string(direction * (lon - 180)) + "," +
                  std::to_string(70.0 * side) + "],";
        }
        ring += "[" + std::to_string(-180 * direction) + "," + std::to_string(70.0 * side) + "]]";
        const auto layer = Open(folder, Feature("Polygon", "[" + ring + "]"));
        EXPECT_NEAR(Sum(*layer), 360.0 * 20.0, 7.2) << side << direction << last;
        for (const double lon : {-179.9, -90.0, 0.2, 179.9}) {
          EXPECT_EQ(At(*layer, lon, 70.5 * side), 1.0);
          EXPECT_EQ(At(*layer, lon, 89.9 * side), 1.0);
          EXPECT_EQ(At(*layer, lon, 69.5 * side), 0.0);
          EXPECT_EQ(At(*layer, lon, -89.9 * side), 0.0);
          // Its edges are parallels, curved about a pole: half a degree is 1.5 texels there.
          EXPECT_EQ(AtPole(*layer, side < 0.0, lon, 70.5 * side), 1.0);
          EXPECT_EQ(AtPole(*layer, side < 0.0, lon, 69.5 * side), 0.0);
          EXPECT_EQ(AtPole(*layer, side < 0.0, lon, 89.99 * side), 1.0);
          EXPECT_EQ(AtPole(*layer, side > 0.0, lon, -70.0 * side), 0.0);
        }
      }
    }
  }
  const auto frame = Open(folder, Feature("Polygon", "[[[-180,60],[180,60],[180,90],[-180,90],"
                                                     "[-180,60]]]"));
  EXPECT_NEAR(Sum(*frame), 360.0 * 30.0, 11.0);
  EXPECT_EQ(AtPole(*frame, false, 45.0, 61.0), 1.0);
  EXPECT_EQ(AtPole(*frame, false, 45.0, 59.0), 0.0);
  const auto all = Open(folder, Feature("Polygon", "[[[-180,-90],[180,-90],[180,90],[-180,90],"
                                                   "[-180,-90]]]"));
  EXPECT_NEAR(Sum(*all), 360.0 * 180.0, 1.0);
  for (const bool south : {false, true}) {
    const Painted whole(*all, BodyChart::Pole(south), {0, 0, 0, 256, 256});
    EXPECT_EQ(whole.Sum(), 256.0 * 256.0) << south;
  }
}

// The outline of a ring around a pole is the ring alone.
TEST(VectorBody, WhatClosesARingIsNotDrawn) {
  const TemporaryFolder folder;
  VectorLayerOptions options;
  options.fill[3] = 0.0;
  const auto layer = Open(
      folder, Feature("Polygon", "[[[0,70],[60,70],[120,70],[180,70],[-120,70],[-60,70],[0,70]]]"),
      options);
  EXPECT_NEAR(Sum(*layer), 360.0 * 2.0 * Texel, 0.02 * 720.0 * Texel);
  EXPECT_EQ(At(*layer, 0.0, 75.0), 0.0);
  EXPECT_GT(At(*layer, 30.0, 70.0), 0.4);
}

// Round on the ground: in a degree grid twice as wide as high at 60 degrees.
TEST(VectorBody, WidthsAreThoseOfTheGround) {
  const TemporaryFolder folder;
  VectorLayerOptions options;
  options.width = 50000.0;
  options.point = 2.0; // 100 km
  const auto layer = Open(folder,
                          Feature("Point", "[20,60]") + "," + Feature("Point", "[179.9,-75]") +
                              "," + Feature("LineString", "[[100,10],[100,80]]"),
                          options);
  const double degree = Mars * M_PI / 180.0;
  const ColorGrid grid = BodyChart().grid;
  const auto disc = [&](int column, int row, double latitude) {
    const Painted painted(*layer, grid, {Zoom, column, row, 80, 60});
    const double area = M_PI * 50000.0 * 50000.0 / degree / degree; // square degrees of a meridian
    // Pens are told to a hundredth on either axis.
    EXPECT_NEAR(painted.Sum() * Texel * Texel * std::cos(latitude * M_PI / 180.0) / area, 1.0,
                0.03);
  };
  disc(1137 - 40, 171 - 30, 60.0); // texels from -180, 90
  disc(2047 - 40, 939 - 30, 75.0); // across the date line
  for (const double latitude : {15.0, 40.0, 62.0, 75.0}) {
    const auto row = std::int64_t((90.0 - latitude) / Texel);
    const Painted painted(*layer, grid, {Zoom, 1592 - 60, row, 120, 1});
    const double across = painted.Sum() * Texel * degree * std::cos(latitude * M_PI / 180.0);
    EXPECT_NEAR(across / 50000.0, 1.0, 0.03) << latitude;
  }
  // The same line in the pole's chart: as wide.
  const ColorGrid pole = BodyChart::Pole(false);
  const double p = 75.0 * M_PI / 180.0, l = 100.0 * M_PI / 180.0;
  const Eigen::Vector3d at =
      Mars * Eigen::Vector3d(std::cos(p) * std::cos(l), std::cos(p) * std::sin(l), std::sin(p));
  const Eigen::Vector2d texel =
      pole.TexelToPost(Zoom).inverse() * Eigen::Vector2d(pole.placement.ToPosts(at).head<2>());
  // 100 degrees east runs along the chart's rows there, 10 degrees aslant.
  const Painted painted(*layer, pole,
                        {Zoom, std::int64_t(texel.x()) - 20, std::int64_t(texel.y()), 40, 1});
  const double size = 10000.0 * 0.5 * (1.0 + std::sin(p)); // [m] of a texel there
  EXPECT_NEAR(painted.Sum() * size * std::cos(10.0 * M_PI / 180.0) / 50000.0, 1.0, 0.03);
}

// From a projected CRS around the pole onto the degree grid: closed over the pole there.
TEST(VectorBody, ARingOfAPolarCrsIsClosedOnTheDegreeGrid) {
  const TemporaryFolder folder;
  VectorLayerOptions options = FillOnly();
  options.crs = "+proj=stere +lat_0=90 +lon_0=0 +R=3396190 +no_defs";
  // A square of 1000 km a side about the pole: latitude along an axis by the projection's formula.
  const auto layer = Open(folder,
                          Feature("Polygon", "[[[-500000,-500000],[500000,-500000],[500000,500000],"
                                             "[-500000,500000],[-500000,-500000]]]"),
                          options);
  const auto latitude = [](double rho) {
    return 90.0 - 2.0 * std::atan(rho / (2.0 * Mars)) * 180.0 / M_PI;
  };
  for (const double lon : {-180.0, -90.0, 0.0, 90.0}) { // the middles of its sides
    EXPECT_EQ(At(*layer, lon + 0.1, latitude(500000.0) + 0.2), 1.0) << lon;
    EXPECT_EQ(At(*layer, lon + 0.1, latitude(500000.0) - 0.2), 0.0) << lon;
    EXPECT_EQ(At(*layer, lon + 45.1, latitude(std::sqrt(2.0) * 500000.0) + 0.2), 1.0) << lon;
    EXPECT_EQ(At(*layer, lon + 45.1, latitude(std::sqrt(2.0) * 500000.0) - 0.2), 0.0) << lon;
    EXPECT_EQ(At(*layer, lon + 0.1, 89.95), 1.0);
    EXPECT_EQ(AtPole(*layer, false, lon, 89.95), 1.0);
    EXPECT_EQ(AtPole(*layer, true, lon, -80.0), 0.0); // the other pole's chart
    EXPECT_EQ(AtPole(*layer, false, lon + 0.1, latitude(500000.0) - 0.3), 0.0) << lon;
  }
}

// So large that the other pole's chart has it as a hole in the middle.
TEST(VectorBody, APolarAreaBeyondTheEquatorEndsWhereItEnds) {
  const TemporaryFolder folder;
  VectorLayerOptions options = FillOnly();
  options.crs = "+proj=stere +lat_0=90 +lon_0=0 +R=3396190 +no_defs";
  // About 30 degrees south: 2 R tan(60 degrees) from the middle, in chords of three degrees.
  const double rho = 2.0 * Mars * std::tan(60.0 * M_PI / 180.0);
  std::string ring;
  for (int i = 0; i <= 120; ++i) {
    const double a = (i % 120) * 3.0 * M_PI / 180.0;
    ring += (i ? ",[" : "[") + std::to_string(rho * std::sin(a)) + "," +
            std::to_string(rho * std::cos(a)) + "]";
  }
  const auto layer = Open(folder, Feature("Polygon", "[[" + ring + "]]"), options);
  EXPECT_NEAR(Sum(*layer), 360.0 * 120.0, 30.0);
  for (const double lon : {-170.0, -45.0, 3.0, 120.0}) {
    EXPECT_EQ(At(*layer, lon, -29.0), 1.0);
    EXPECT_EQ(At(*layer, lon, -31.0), 0.0);
    EXPECT_EQ(AtPole(*layer, true, lon, -29.0), 1.0);
    EXPECT_EQ(AtPole(*layer, true, lon, 20.0), 1.0);
    EXPECT_EQ(AtPole(*layer, true, lon, -31.0), 0.0);
    EXPECT_EQ(AtPole(*layer, true, lon, -89.9), 0.0);
    EXPECT_EQ(AtPole(*layer, false, lon, 89.9), 1.0);
  }
}

// The frame of a whole map in an equidistant cylindrical projection.
TEST(VectorBody, AFrameInMetresCoversTheBody) {
  const TemporaryFolder folder;
  VectorLayerOptions options = FillOnly();
  options.crs = "+proj=eqc +R=3396190 +units=m +no_defs";
  const std::string x = std::to_string(M_PI * Mars), y = std::to_string(0.5 * M_PI * Mars);
  const auto layer =
      Open(folder,
           Feature("Polygon", "[[[-" + x + ",-" + y + "],[" + x + ",-" + y + "],[" + x + "," + y +
                                  "],[-" + x + "," + y + "],[-" + x + ",-" + y + "]]]"),
           options);
  EXPECT_NEAR(Sum(*layer), 360.0 * 180.0, 1.0);
  for (const bool south : {false, true}) {
    const Painted whole(*layer, BodyChart::Pole(south), {0, 0, 0, 256, 256});
    EXPECT_NEAR(whole.Sum(), 256.0 * 256.0, 0.5) << south;
  }
}

} // namespace
} // namespace dspace::testing
