// Shapes painted on a plane: coverage in closed form, widths, places, rejections.
#include <cmath>

#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include "VectorTestSupport.h"
#include <dspace/crs/CrsTransform.h>

namespace dspace::testing {
namespace {

double AreaOf(const std::vector<Eigen::Vector2d>& ring) {
  double twice = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

std::string Text(const std::vector<Eigen::Vector2d>& ring) {
  std::string text = "[";
  for (std::size_t i = 0; i <= ring.size(); ++i) {
    const Eigen::Vector2d& p = ring[i % ring.size()];
    text += (i > 0 ? ",[" : "[") + std::to_string(p.x()) + "," + std::to_string(p.y()) + "]";
  }
  return text + "]";
}

// A third of a texel's side is no multiple of cairo's steps (1/256 across, 1/15 down).
TEST(VectorLayer, AnAreaCoversWhatItCoversAndItsHoleStays) {
  const TemporaryFolder folder;
  const PlaneChart chart;
  const std::vector<Eigen::Vector2d> outer = {
      {1101.3, 4950.7}, {1450.2, 4801.9}, {1390.5, 4600.1}, {1150.4, 4555.8}};
  const std::vector<Eigen::Vector2d> hole = {
      {1200.3, 4800.3}, {1300.3, 4800.3}, {1300.3, 4700.7}, {1200.3, 4700.7}};
  const auto layer = OpenVectorLayer(
      Write(folder / "a.json", Feature("Polygon", "[" + Text(outer) + "," + Text(hole) + "]")),
      chart.place, FillOnly(0.5));
  EXPECT_EQ(layer->Warnings().size(), 1U); // no CRS: the terrain's map coordinates
  const double area = AreaOf(outer) - AreaOf(hole);
  for (const int zoom : {0, 1, 2, 3}) { // texels of 4 m to 0.5 m
    const double texel = std::ldexp(4.0, -zoom);
    const Painted painted(*layer, chart.grid, {zoom, 0, 0, 256 << zoom, 256 << zoom});
    // Coverage of a texel at an edge is right to about 1/30, by chance either way.
    EXPECT_NEAR(painted.Sum() * texel * texel / area, 128.0 / 255.0, 1e-3) << zoom;
  }
  const Painted painted(*layer, chart.grid, {2, 0, 0, 1024, 1024}); // 1 m: (x - 1000, 5000 - y)
  const auto opacity = [&](double x, double y) {
    return painted.At(int(x - 1000.0), int(5000.0 - y))[3];
  };
  EXPECT_EQ(opacity(1250.5, 4750.5), 0);   // in the hole
  EXPECT_EQ(opacity(1250.5, 4850.5), 128); // in the area
  EXPECT_EQ(opacity(1050.5, 4750.5), 0);
  // The hole's edges: west of x 1200.3 and north of 4800.3, below which 0.3 of a texel is of it.
  EXPECT_NEAR(opacity(1200.5, 4750.5), 128 * 0.3, 2);
  EXPECT_NEAR(opacity(1300.5, 4750.5), 128 * 0.7, 2);
  EXPECT_NEAR(opacity(1250.5, 4800.5), 128 * 0.7, 5);
  EXPECT_NEAR(opacity(1250.5, 4700.5), 128 * 0.7, 5);
  const std::uint8_t* texel = painted.At(250, 150);
  EXPECT_EQ(texel[0], 255); // straight colour
  EXPECT_EQ(texel[1], 0);
}

TEST(VectorLayer, TilesFitTogether) {
  const TemporaryFolder folder;
  const PlaneChart chart;
  VectorLayerOptions options;
  options.width = 7.3;
  const auto layer = OpenVectorLayer(
      Write(folder / "a.json",
            Feature("Polygon", "[[[1101.3,4950.7],[1850.2,4101.9],[1390.5,4000.1],[1101.3,4950.7]],"
                               "[[1250,4650],[1300,4650],[1300,4600],[1250,4650]]]") +
                "," + Feature("LineString", "[[900,4800],[1512,4501],[1518,4700],[2300,4100]]") +
                "," + Feature("Point", "[1511.7,4487.2]")),
      chart.place, options);
  const Painted whole(*layer, chart.grid, {2, 0, 0, 1024, 1024});
  double sum = 0.0;
  for (const int row : {0, 256, 512}) {
    for (const int column : {0, 256, 512}) {
      const Painted tile(*layer, chart.grid, {2, column - 1, row - 1, 258, 258});
      for (int y = row == 0 ? 1 : 0; y < 258; ++y) {
        for (int x = column == 0 ? 1 : 0; x < 258; ++x) {
          const int difference = tile.At(x, y)[3] - whole.At(column + x - 1, row + y - 1)[3];
          // Lines are cut outside of a tile, at places of 1/256 of a texel: a step of the fifteen
          // down may come or go.
          ASSERT_LE(std::abs(difference), 18);
          sum += std::abs(difference);
        }
      }
    }
  }
  EXPECT_LT(sum, 0.01 * 9 * 258 * 258);
}

TEST(VectorLayer, LinesAreAsWideAsStated) {
  const TemporaryFolder folder;
  const PlaneChart chart;
  const std::string path = Write(
      folder / "line.json", Feature("LineString", "[[1000,4800.4],[2100,4800.4]]") + "," +
                                Feature("LineString", "[[1100,4700],[1400,4300],[1100,4300]]"));
  VectorLayerOptions options;
  options.width = 11.0;
  const auto metres = OpenVectorLayer(path, chart.place, options);
  options.width.reset();
  options.pixels = 3.0;
  const auto pixels = OpenVectorLayer(path, chart.place, options);
  for (const int zoom : {1, 2, 3}) {
    const double texel = std::ldexp(4.0, -zoom); // [m]
    const auto across = [&](const ColorLayer& layer, double x) {
      const auto row = std::int64_t((5000.0 - 4900.0) / texel);
      const int height = int(200.0 / texel);
      const Painted column(layer, chart.grid,
                           {zoom, std::int64_t((x - 1000.0) / texel), row, 1, height});
      double sum = 0.0, first = 0.0;
      for (int y = 0; y < height; ++y) {
        sum += column.Opacity(0, y);
        first += column.Opacity(0, y) * (5000.0 - (double(row) + y + 0.5) * texel);
      }
      EXPECT_NEAR(first / sum, 4800.4, 0.05 * texel);
      return sum * texel;
    };
    EXPECT_NEAR(across(*metres, 1600.0), 11.0, 0.08 * texel) << zoom;
    EXPECT_NEAR(across(*pixels, 1600.0), 3.0 * texel, 0.08 * texel) << zoom;
  }
  // Aslant: the area of a length of 500 m and of the round ends and the round corner, which have
  // the area of a disc together, about.
  const Painted slant(*metres, chart.grid, {2, 50, 250, 400, 500}); // below the other line
  const double corner = std::atan2(400.0, 300.0);                   // between the two parts
  const double overlap = 5.5 * 5.5 / std::tan(0.5 * corner);        // counted twice by the parts
  const double wedge = 5.5 * 5.5 * 0.5 * (M_PI - corner);           // round, outside of the corner
  const double expected = (500.0 + 300.0) * 11.0 + M_PI * 5.5 * 5.5 - overlap + wedge;
  EXPECT_NEAR(slant.Sum() / expected, 1.0, 2e-3);
}

TEST(VectorLayer, APointIsADiscAtItsPlace) {
  const TemporaryFolder folder;
  const PlaneChart chart;
  VectorLayerOptions options;
  options.point = 9.0;
  const std::string path = Write(folder / "p.json", Feature("Point", "[1203.37,4703.81]"));
  const auto layer = OpenVectorLayer(path, chart.place, options);
  options.width = 2.0; // 18 m
  const auto wide = OpenVectorLayer(path, chart.place, options);
  for (const int zoom : {1, 2, 3}) {
    const double texel = std::ldexp(4.0, -zoom);
    for (const auto& [one, radius] : {std::pair(layer, 4.5), std::pair(wide, 9.0 / texel)}) {
      const ColorBlock block{zoom, std::int64_t(160.0 / texel), std::int64_t(250.0 / texel),
                             int(90.0 / texel), int(90.0 / texel)};
      const Painted painted(*one, chart.grid, block);
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      for (int y = 0; y < block.height; ++y) {
        for (int x = 0; x < block.width; ++x) {
          sum += painted.Opacity(x, y) * Eigen::Vector2d(x + 0.5, y + 0.5);
        }
      }
      const Eigen::Vector2d middle =
          sum / painted.Sum() + Eigen::Vector2d(double(block.column), double(block.row));
      EXPECT_NEAR(middle.x(), 203.37 / texel, 0.05);
      EXPECT_NEAR(middle.y(), 296.19 / texel, 0.05);
      EXPECT_NEAR(painted.Sum() / (M_PI * radius * radius), 1.0, 0.02);
    }
  }
}

// Longitude and latitude on a stereographic plane, where a parallel is an arc.
TEST(VectorLayer, EdgesFollowTheirOwnCrs) {
  const TemporaryFolder folder;
  const PlaneChart chart("+proj=stere +lat_0=60 +lon_0=30 +R=3396190 +no_defs", -500.0, 500.0);
  const CrsTransform toMap(Crs::FromText(Degrees()), chart.place.crs);
  // Along a parallel, from far outside to far outside: its chord passes hundreds of metres beside.
  const std::string path =
      Write(folder / "arc.json", Feature("LineString", "[[26.5,60.001],[33.5,60.001]]"));
  VectorLayerOptions options;
  options.pixels = 3.0;
  const auto layer = OpenVectorLayer(path, chart.place, options);
  ASSERT_EQ(layer->Warnings().size(), 1U);
  EXPECT_NE(layer->Warnings()[0].find("longitude and latitude"), std::string::npos);
  const Eigen::Vector2d a = toMap.Apply({26.5, 60.001}), b = toMap.Apply({33.5, 60.001});
  EXPECT_GT((0.5 * (a + b) - toMap.Apply({30.0, 60.001})).norm(), 500.0);
  const int zoom = 4; // texels of 0.25 m
  const Eigen::Affine2d toTexel = chart.grid.TexelToMap(zoom).inverse();
  for (const double lon : {29.9920, 29.9971, 30.0, 30.0033, 30.0081}) {
    const Eigen::Vector2d texel = toTexel * toMap.Apply({lon, 60.001});
    // The line runs to the east here: a column across it.
    const ColorBlock block{zoom, std::int64_t(std::floor(texel.x())),
                           std::int64_t(std::floor(texel.y())) - 10, 1, 21};
    const Painted painted(*layer, chart.grid, block);
    double sum = 0.0, first = 0.0;
    for (int y = 0; y < block.height; ++y) {
      sum += painted.Opacity(0, y);
      first += painted.Opacity(0, y) * (double(block.row) + y + 0.5);
    }
    EXPECT_NEAR(sum, 3.0, 0.1) << lon;
    EXPECT_NEAR(first / sum, texel.y(), 0.25 + 0.05) << lon;
  }
  // Stated otherwise, the same numbers are metres: far from the raster's middle, but on it.
  options.crs = "+proj=stere +lat_0=60 +lon_0=30 +R=3396190 +no_defs";
  const auto metres = OpenVectorLayer(path, chart.place, options);
  EXPECT_TRUE(metres->Warnings().empty());
  EXPECT_GT(OpacityAt(*metres, chart.grid, 2, {30.0, 60.001}), 0.9);
}

TEST(VectorLayer, FeaturesHaveLooksOfTheirOwn) {
  const TemporaryFolder folder;
  const PlaneChart chart;
  const std::string square = "[[[1100,4900],[1200,4900],[1200,4800],[1100,4800],[1100,4900]]]";
  const std::string beside = "[[[1300,4900],[1400,4900],[1400,4800],[1300,4800],[1300,4900]]]";
  const auto layer = OpenVectorLayer(
      Write(folder / "s.json",
            Feature("Polygon", square,
                    R"("fill":"#00f","fill-opacity":1,"stroke":"00ff00","stroke-width":8)") +
                "," + Feature("Polygon", beside, R"("fill":"blue")") + "," +
                Feature("Polygon", square, R"("fill":"#ff0000","fill-opacity":0.5,
                    "stroke-opacity":0)") +
                "," + Feature("Point", "[1450,4850]", R"("marker-color":"#808080")")),
      chart.place, FillOnly(0.25));
  const Painted painted(*layer, chart.grid, {2, 0, 0, 512, 512});
  const auto expect = [&](int x, int y, std::array<int, 4> color) {
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(painted.At(x, y)[k], color[std::size_t(k)], 1) << x << " " << y << " " << k;
    }
  };
  expect(150, 150, {188, 0, 188, 255}); // half of red's light over blue: 0.5 is 188
  expect(98, 150, {0, 255, 0, 255});    // outside of the square: half of its line
  expect(350, 150, {255, 0, 0, 64});    // "blue" is not #rrggbb: the layer's fill
  expect(450, 150, {128, 128, 128, 255});
  ASSERT_EQ(layer->Warnings().size(), 2U);
  EXPECT_NE(layer->Warnings()[0].find("'blue'") & layer->Warnings()[1].find("'blue'"),
            std::string::npos);
}

TEST(VectorLayer, OtherFormatsAndSeveralLayersAreRead) {
  const TemporaryFolder folder;
  const std::string crs = "+proj=stere +lat_0=60 +lon_0=30 +R=3396190 +no_defs";
  const PlaneChart chart(crs, -500.0, 500.0);
  GDALAllRegister();
  const std::string path = folder / "two.gpkg";
  OGRSpatialReference srs;
  srs.SetFromUserInput(crs.c_str());
  GDALDataset* file = GetGDALDriverManager()->GetDriverByName("GPKG")->Create(path.c_str(), 0, 0, 0,
                                                                              GDT_Unknown, nullptr);
  ASSERT_NE(file, nullptr);
  int east = 0;
  for (const char* name : {"west", "east"}) {
    OGRLayer* layer = file->CreateLayer(name, &srs, wkbUnknown);
    OGRFeature feature(layer->GetLayerDefn());
    OGRGeometry* shape = nullptr;
    const std::string wkt =
        east ? "CURVEPOLYGON(CIRCULARSTRING(100 0,200 100,300 0,200 -100,100 0))"
             : "MULTIPOLYGON(((-300 100,-100 100,-100 -100,-300 -100,-300 100)))";
    OGRGeometryFactory::createFromWkt(wkt.c_str(), nullptr, &shape);
    feature.SetGeometryDirectly(shape);
    ASSERT_EQ(layer->CreateFeature(&feature), OGRERR_NONE);
    ++east;
  }
  GDALClose(file);
  const auto both = OpenVectorLayer(path, chart.place, FillOnly());
  EXPECT_TRUE(both->Warnings().empty());
  EXPECT_EQ(OpacityAt(*both, chart.grid, 2, {-200.5, 0.5}), 1.0);
  EXPECT_EQ(OpacityAt(*both, chart.grid, 2, {200.5, 0.5}), 1.0);
  EXPECT_EQ(OpacityAt(*both, chart.grid, 2, {0.5, 0.5}), 0.0);
  const Painted disc(*both, chart.grid, {2, 550, 350, 300, 300}); // 1 m
  EXPECT_NEAR(disc.Sum() / (M_PI * 100.0 * 100.0), 1.0, 0.002);   // arcs are chords of 4 degrees
  VectorLayerOptions options = FillOnly();
  options.layer = "west";
  const auto west = OpenVectorLayer(path, chart.place, options);
  EXPECT_EQ(OpacityAt(*west, chart.grid, 2, {-200.5, 0.5}), 1.0);
  EXPECT_EQ(OpacityAt(*west, chart.grid, 2, {200.5, 0.5}), 0.0);
  options.layer = "north";
  try {
    OpenVectorLayer(path, chart.place, options);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::NotFound);
    EXPECT_NE(std::string(error.what()).find("'west', 'east'"), std::string::npos) << error.what();
  }
}

TEST(VectorLayer, PixelSizeIsFineEnoughForItsShapes) {
  const TemporaryFolder folder;
  const PlaneChart chart; // pixels of 2 m
  const auto size = [&](const std::string& features, std::optional<double> width) {
    VectorLayerOptions options;
    options.width = width;
    return OpenVectorLayer(Write(folder / "s.json", features), chart.place, options)->PixelSize();
  };
  const std::string line = Feature("LineString", "[[1100,4700],[1400,4300]]"); // 500 m
  EXPECT_NEAR(size(line, std::nullopt), 0.5, 1e-12);
  EXPECT_NEAR(size(line, 1.0), 0.25, 1e-12);
  EXPECT_NEAR(size(Feature("Point", "[1200,4800]"), std::nullopt), 2.0, 1e-12);
  const std::string small = Feature("LineString", "[[1100,4700],[1103.84,4700]]"); // 3.84 m
  EXPECT_NEAR(size(line + "," + small, std::nullopt), 0.06, 1e-12);
}

void Rejected(Error::Kind kind, const std::string& told, const std::string& path,
              const RasterPlace& place, const VectorLayerOptions& options = {}) {
  try {
    OpenVectorLayer(path, place, options);
    ADD_FAILURE() << told;
  } catch (const Error& error) {
    EXPECT_EQ(int(error.GetKind()), int(kind)) << error.what();
    EXPECT_NE(std::string(error.what()).find(told), std::string::npos) << error.what();
    EXPECT_NE(error.GetObjectName().find(path), std::string::npos) << error.what();
  }
}

TEST(VectorLayer, WhatCannotBePaintedIsRejected) {
  using Kind = Error::Kind;
  const TemporaryFolder folder;
  const PlaneChart plain;
  const PlaneChart mars("+proj=stere +lat_0=60 +lon_0=30 +R=3396190 +no_defs", -500.0, 500.0);
  const std::string line = Feature("LineString", "[[1100,4700],[1400,4300]]");
  Rejected(Kind::NotFound, "no such file", folder / "nowhere.json", plain.place);
  std::ofstream(folder / "broken.json") << R"({"type":"FeatureCollection","features":[{"ty)";
  Rejected(Kind::Corrupt, "", folder / "broken.json", plain.place);
  std::ofstream(folder / "text.json") << "no shapes at all";
  Rejected(Kind::Corrupt, "", folder / "text.json", plain.place);
  Rejected(Kind::InvalidArgument, "no features", Write(folder / "none.json", ""), plain.place);
  Rejected(Kind::InvalidArgument, "overlaps terrain 'plane'",
           Write(folder / "far.json", Feature("Point", "[0,0]")), plain.place);
  const std::string path = Write(folder / "line.json", line);
  VectorLayerOptions options;
  options.mostVertices = 1;
  Rejected(Kind::Resource, "more than 1 vertices", path, plain.place, options);
  options.mostVertices = 50; // long edges are divided
  Rejected(Kind::Resource, "more than 50 vertices",
           Write(folder / "long.json", Feature("LineString", "[[-180,60],[180,60]]")), mars.place,
           options);
  options = {};
  options.crs = "EPSG:4326"; // of the Earth
  Rejected(Kind::Unsupported, "body", Write(folder / "earth.json", Feature("Point", "[30,60]")),
           mars.place, options);
  options.crs = "EPSG:4326";
  Rejected(Kind::Unsupported, "no CRS", Write(folder / "e2.json", Feature("Point", "[30,60]")),
           plain.place, options);
  // Metres that are taken for degrees.
  Rejected(Kind::InvalidArgument, "not a longitude and latitude", path, mars.place);
  const auto bad = [&](auto change, const std::string& told) {
    VectorLayerOptions changed;
    change(changed);
    Rejected(Kind::InvalidArgument, told, path, plain.place, changed);
  };
  bad([](auto& o) { o.width = 0.0; }, "width");
  bad([](auto& o) { o.pixels = 65.0; }, "width in pixels");
  bad([](auto& o) { o.pixels = std::nan(""); }, "width in pixels");
  bad([](auto& o) { o.point = 0.0; }, "points");
  bad([](auto& o) { o.line[2] = 1.1; }, "colour");
  bad([](auto& o) { o.fill[3] = -0.1; }, "colour");
}

} // namespace
} // namespace dspace::testing
