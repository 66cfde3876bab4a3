// Wheel tracks on a raster: what is answered, what is drawn after it, and files of tracks.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/surface/StreamedTerrain.h>
#include <dspace/tracks/TrackPosts.h>

#include "RasterFile.h"

namespace {

using namespace dspace;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

// 40 m x 40 m of pixels 0.2 m apart, a slope of 1 in 10 eastwards that a plane fits exactly.
struct StreamedTracks : ::testing::Test {
  TemporaryFolder folder;
  std::shared_ptr<StreamedTerrain> terrain;
  StreamedTerrainOptions options;

  void Open(double east = 500000.0) {
    RasterFile file;
    file.width = 201;
    file.height = 201;
    file.type = GDT_Float32;
    file.crs = "EPSG:32633";
    file.geotransform = {east, 0.2, 0.0, 4200000.0, 0.0, -0.2};
    file.value = [](int c, int, int) { return 0.02 * (c - 100); };
    options.subdivisions = 3; // 2.5 cm
    terrain = StreamedTerrain::Open(file.Write(folder / "slope.tif"), options);
  }
  void SetUp() override { Open(); }
  static double Before(double x) { return 0.1 * x; }
  static TrackAddition Straight(double sinkage = 0.06) { // along X from -5 to 5, at y = 2
    TrackAddition stroke;
    stroke.name = "wheel";
    stroke.profile.width = 0.3;
    stroke.profile.wall = 0.05;
    stroke.contacts = {{{-5.0, 2.0}, sinkage}, {{5.0, 2.0}, sinkage}};
    return stroke;
  }
  double Height(const StreamedTerrain& of, double x, double y) const {
    return of.Sample(Eigen::Vector3d(x, y, 0.0)).height;
  }
};

TEST_F(StreamedTracks, QueriesSeeTheRutsAndTheGroundBeforeThem) {
  EXPECT_NEAR(Height(*terrain, 1.03, 2.01), Before(1.03), 1e-6);
  const Eigen::Vector3d above(1.03, 2.01, 5.0);
  const Eigen::Vector3d down(0.0, 0.0, -1.0);
  EXPECT_NEAR(terrain->Intersect(above, down, 100.0).distance, 5.0 - Before(1.03), 1e-6);
  terrain->AddTracks({Straight()});
  for (const double y : {1.87, 2.0, 2.12}) { // posts to either side are on the floor
    EXPECT_NEAR(Height(*terrain, 1.03, y), Before(1.03) - 0.06, 1e-6) << y;
  }
  EXPECT_NEAR(Height(*terrain, 1.03, 2.25), Before(1.03), 1e-6);
  EXPECT_NEAR(terrain->Intersect(above, down, 100.0).distance, 5.0 - Before(1.03) + 0.06, 1e-6);
  // Along the rut, below the ground as it was, and onto its end.
  const RayHit along = terrain->Intersect({-4.0, 2.0, Before(-4.0) - 0.03}, {1.0, 0.0, 0.1}, 100.0);
  ASSERT_TRUE(along.hit);
  EXPECT_GT(along.position_S.x(), 5.0);
  EXPECT_LT(along.position_S.x(), 5.0 + 0.15 + 0.05);
  Rows3 points(2, 3);
  points << 1.03, 2.0, 0.0, 1.03, 3.0, 0.0;
  Eigen::VectorXd heights(2);
  terrain->Heights(points, heights);
  EXPECT_NEAR(heights[0], Before(1.03) - 0.06, 1e-6);
  EXPECT_NEAR(heights[1], Before(1.03), 1e-6);

  TrackAddition deeper = Straight(0.1); // a ray's tiles must go with the change
  deeper.name = "another";
  terrain->AddTracks({deeper});
  EXPECT_NEAR(terrain->Intersect(above, down, 100.0).distance, 5.0 - Before(1.03) + 0.1, 1e-6);

  const StreamedTerrain& before = terrain->Undisturbed();
  EXPECT_NEAR(Height(before, 1.03, 2.0), Before(1.03), 1e-6);
  EXPECT_NEAR(before.Intersect(above, down, 100.0).distance, 5.0 - Before(1.03), 1e-6);
  EXPECT_EQ(before.Frame().GetOrigin(), terrain->Frame().GetOrigin());

  terrain->ClearTracks();
  EXPECT_NEAR(Height(*terrain, 1.03, 2.0), Before(1.03), 1e-6);
  EXPECT_NEAR(terrain->Intersect(above, down, 100.0).distance, 5.0 - Before(1.03), 1e-6);
}

TEST_F(StreamedTracks, ARutBelowTheLowestGroundIsHit) {
  TrackAddition deep = Straight(0.9);
  deep.contacts = {{{-19.0, 2.0}, 0.9}, {{-15.0, 2.0}, 0.9}};
  terrain->AddTracks({deep}); // the least height is -2 m, at x = -20
  const RayHit hit = terrain->Intersect({-18.0, 2.0, 5.0}, {0.0, 0.0, -1.0}, 100.0);
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(hit.position_S.z(), -1.8 - 0.9, 1e-6);
  EXPECT_LE(terrain->DrawnHeights()[0], -2.9);
}

TEST_F(StreamedTracks, SavedAndLoadedTheyAreTheSame) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<TrackAddition> additions;
  for (int n = 0; n < 5; ++n) {
    TrackAddition stroke = Straight();
    stroke.name = "wheel " + std::to_string(n) + " \"left\" \xc3\xa4";
    stroke.profile.treadPitch = n == 3 ? 0.0 : 0.21;
    stroke.profile.treadDepth = 0.011;
    stroke.profile.rimWidth = 0.07;
    stroke.profile.rimHeight = 0.013;
    stroke.contacts.clear();
    Eigen::Vector2d p(10.0 * unit(random), 10.0 * unit(random));
    for (int i = 0; i < (n == 4 ? 1 : 40); ++i) {
      p += Eigen::Vector2d(0.2, 0.2 * unit(random));
      TrackContact contact;
      contact.place = p;
      contact.sinkage = 0.05 + 0.04 * unit(random);
      contact.heading = n == 2 ? TrackContact::Unknown : unit(random);
      contact.rolled = 0.3 * i;
      stroke.contacts.push_back(contact);
    }
    additions.push_back(stroke);
  }
  terrain->AddTracks(additions);
  const std::vector<TrackStroke> before = terrain->Tracks().Strokes();
  const std::string path = folder / "tracks.geojson";
  terrain->SaveTracks(path);
  terrain->SaveTracks(path); // over what is there
  terrain->ClearTracks();
  terrain->LoadTracks(path);
  const std::vector<TrackStroke> after = terrain->Tracks().Strokes();
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t n = 0; n < before.size(); ++n) {
    EXPECT_EQ(before[n].name, after[n].name);
    EXPECT_TRUE(before[n].profile == after[n].profile);
    ASSERT_EQ(before[n].contacts.size(), after[n].contacts.size()) << n;
    for (std::size_t i = 0; i < before[n].contacts.size(); ++i) {
      const TrackContact& a = before[n].contacts[i];
      const TrackContact& b = after[n].contacts[i];
      EXPECT_LE((a.place - b.place).norm(), 2e-9); // map coordinates of 4e6 m
      EXPECT_NEAR(a.sinkage, b.sinkage, 1e-8);
      EXPECT_NEAR(a.rolled, b.rolled, 1e-12);
      EXPECT_EQ(std::isnan(a.heading), std::isnan(b.heading));
      EXPECT_TRUE(std::isnan(a.heading) || std::abs(a.heading - b.heading) < 1e-6);
    }
  }
}

// Pixels are 8 posts apart: each counts as the ground is where it stands, not as its cell's mean.
TEST_F(StreamedTracks, RoughnessIsOfThePixelsAsTheyAreInTheRuts) {
  TrackAddition rut = Straight();
  rut.profile.treadPitch = 0.17;
  rut.profile.treadDepth = 0.02;
  rut.profile.rimWidth = 0.2;
  rut.profile.rimHeight = 0.03;
  terrain->AddTracks({rut});
  Rows3 points(3, 3);
  points << 0.03, 2.05, 0.0, 4.9, 2.3, 0.0, -12.0, -9.0, 0.0; // in it, at its end, far from it
  Eigen::VectorXd roughness(3);
  const double radius = 1.1;
  terrain->Roughness(points, radius, roughness);
  Eigen::VectorXd bare(3);
  terrain->Undisturbed().Roughness(points, radius, bare);
  for (int i = 0; i < 3; ++i) {
    std::vector<Eigen::Vector3d> pixels;
    for (int r = 0; r < 201; ++r) {
      for (int c = 0; c < 201; ++c) {
        const Eigen::Vector2d place(-20.0 + 0.2 * c, 20.0 - 0.2 * r);
        if ((place - points.row(i).head<2>().transpose()).norm() <= radius) {
          pixels.emplace_back(place.x(), place.y(), Height(*terrain, place.x(), place.y()));
        }
      }
    }
    ASSERT_GT(pixels.size(), 80u);
    Eigen::MatrixXd design(pixels.size(), 3);
    Eigen::VectorXd heights(pixels.size());
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      design.row(Eigen::Index(k)) << 1.0, pixels[k].x(), pixels[k].y();
      heights[Eigen::Index(k)] = pixels[k].z();
    }
    const Eigen::VectorXd plane = design.colPivHouseholderQr().solve(heights);
    const double direct = std::sqrt((heights - design * plane).squaredNorm() / pixels.size());
    EXPECT_NEAR(roughness[i], direct, 1e-6) << i; // heights are floats about 1 m
    EXPECT_LT(bare[i], 1e-6) << i;
  }
  EXPECT_GT(roughness[0], 0.02);
  EXPECT_GT(roughness[1], 0.01);
  EXPECT_LT(roughness[2], 1e-6);
}

// Thousands of lines are told to the pyramid as a few rectangles, and no tile keeps old posts.
TEST_F(StreamedTracks, ManyAtOnceAreThoseAddedOneByOne) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<TrackAddition> additions;
  for (int n = 0; n < 6; ++n) {
    TrackAddition stroke = Straight();
    stroke.name = "wheel " + std::to_string(n);
    stroke.contacts.clear();
    Eigen::Vector2d p(15.0 * unit(random), 15.0 * unit(random));
    double course = 3.0 * unit(random);
    for (int i = 0; i < 500; ++i) {
      course += 0.3 * unit(random) - (p.norm() > 15.0 ? 0.2 : 0.0);
      p += 0.06 * Eigen::Vector2d(std::cos(course), std::sin(course));
      stroke.contacts.push_back({p, 0.05 + 0.04 * unit(random)});
    }
    additions.push_back(stroke);
  }
  terrain->AddTracks(additions);
  const std::string path = folder / "tracks.geojson";
  terrain->SaveTracks(path);

  const PostLattice& lattice = terrain->Pyramid()->Lattice();
  const auto all = [&lattice](const StreamedTerrain& of, int level) {
    const int columns = int(lattice.ColumnsAt(level));
    const int rows = int(lattice.RowsAt(level));
    std::vector<float> planes(2 * std::size_t(columns) * rows);
    of.Pyramid()->Read({level, 0, 0, columns, rows}, planes.data(),
                       planes.data() + std::size_t(columns) * rows, 60.0);
    return planes;
  };
  const auto loaded = StreamedTerrain::Open(folder / "slope.tif", options);
  const auto grown = StreamedTerrain::Open(folder / "slope.tif", options);
  std::vector<std::vector<float>> before;
  for (int level = 0; level < lattice.levels; ++level) { // tiles that must change are there
    before.push_back(all(*loaded, level));
    all(*grown, level);
  }
  const std::uint64_t stamp = loaded->Pyramid()->Changes(0).stamp;
  loaded->LoadTracks(path);
  EXPECT_GE(loaded->Tracks().Statistics().contacts, 2500u);
  const std::size_t told = loaded->Pyramid()->Changes(stamp).rectangles.size();
  EXPECT_GT(told, 0u);
  EXPECT_LE(told, 256u);
  for (const TrackStroke& stroke : loaded->Tracks().Strokes()) { // as they came from the file
    for (std::size_t i = 0; i < stroke.contacts.size(); ++i) {
      TrackAddition one;
      one.name = stroke.name;
      one.profile = stroke.profile;
      one.contacts = {stroke.contacts[i]};
      one.exact = true;
      grown->AddTracks({one});
    }
  }
  EXPECT_GE(grown->Pyramid()->Changes(0).stamp, 2500u);
  for (int level = 0; level < lattice.levels; ++level) {
    const std::vector<float> a = all(*loaded, level);
    const std::vector<float> b = all(*grown, level);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0) << level;
    if (level < 4) {
      EXPECT_NE(std::memcmp(a.data(), before[std::size_t(level)].data(), a.size() * sizeof(float)),
                0);
    }
  }
  for (int i = 0; i < 200; ++i) {
    const double x = 15.0 * unit(random);
    const double y = 15.0 * unit(random);
    EXPECT_EQ(Height(*loaded, x, y), Height(*grown, x, y));
  }
}

// Written here by hand, with a place of its own in the map: (500030.1, 4199970.0) is 10 m east and
// 9.9 m south of the middle.
TEST_F(StreamedTracks, AFileWrittenByHandIsWhatItSays) {
  const std::string path = folder / "by_hand.geojson";
  std::ofstream(path) << R"({"type": "FeatureCollection", "features": [
    {"type": "Feature", "properties": {"wheel": "rear", "width": 0.3, "wall": 0.05, "sinkage": 0.04},
     "geometry": {"type": "LineString", "coordinates": [[500030.1, 4199970.0], [500034.1, 4199970.0]]}},
    {"type": "Feature", "properties": {"wheel": "front", "width": 0.4, "sinkage": [0.02, 0.06],
       "tread_pitch": 0.5, "tread_depth": 0.1, "rolled": [0, 0]},
     "geometry": {"type": "LineString", "coordinates": [[500010.1, 4199990.0], [500014.1, 4199990.0]]}}
  ]})";
  terrain->LoadTracks(path);
  EXPECT_EQ(terrain->Tracks().Statistics().strokes, 2u);
  EXPECT_NEAR(Height(*terrain, 12.0, -9.9), Before(12.0) - 0.04, 1e-6);
  EXPECT_NEAR(Height(*terrain, 12.0, -9.65), Before(12.0), 1e-6);
  // Half way; it does not turn, so that its tread's bars stay at depth 0.
  EXPECT_NEAR(Height(*terrain, -8.0, 10.1), Before(-8.0) - 0.04, 1e-6);
}

TEST_F(StreamedTracks, FilesThatAreNoTracksAreRejectedAndChangeNothing) {
  const auto rejected = [this](const std::string& text, Error::Kind kind, const std::string& part) {
    const std::string path = folder / "bad.geojson";
    std::ofstream(path) << text;
    try {
      terrain->LoadTracks(path);
      ADD_FAILURE() << text << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), kind) << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
    EXPECT_TRUE(terrain->Tracks().Empty());
  };
  const std::string head = R"({"type": "FeatureCollection", "features": [{"type": "Feature", )";
  const std::string line =
      R"("geometry": {"type": "LineString", "coordinates": [[500010, 4199990], [500012, 4199990]]}}]})";
  rejected("", Error::Kind::Corrupt, "bad.geojson");
  rejected("no tracks at all", Error::Kind::Corrupt, "bad.geojson");
  rejected(head + R"("properties": {"sinkage": [0.1, 0.1, 0.1]}, )" + line, Error::Kind::Corrupt,
           "3 numbers");
  rejected(head + R"("properties": {"width": 0.1}, )" + line, Error::Kind::Corrupt, "sinkage");
  rejected(head + R"("properties": {"sinkage": "deep"}, )" + line, Error::Kind::Corrupt, "sinkage");
  rejected(head + R"("properties": {"sinkage": -1.0}, )" + line, Error::Kind::InvalidArgument,
           "sinkage");
  rejected(head + R"("properties": {"sinkage": 0.1, "crs": "EPSG:32634"}, )" + line,
           Error::Kind::InvalidArgument, "34N");
  rejected(head + R"("properties": {"sinkage": 0.1}, "geometry": {"type": "Point",
      "coordinates": [500010, 4199990]}}]})",
           Error::Kind::Corrupt, "POINT");
  EXPECT_THROW(terrain->LoadTracks(folder / "absent.geojson"), Error);
  EXPECT_THROW(terrain->SaveTracks(folder / "no/such/folder.geojson"), Error);
}

TEST_F(StreamedTracks, SubdivisionsOutOfRangeAreRejected) {
  RasterFile file;
  file.width = 64;
  file.height = 32;
  file.crs = "IAU_2015:30100";
  file.geotransform = {-180.0, 360.0 / 64, 0.0, 90.0, 0.0, -180.0 / 32};
  file.value = [](int, int, int) { return 0.0; };
  const std::string path = file.Write(folder / "moon.tif");
  StreamedTerrainOptions body;
  body.onBody = true;
  for (const int wrong : {-1, 25}) {
    body.subdivisions = wrong;
    EXPECT_THROW(StreamedTerrain::Open(path, body), Error);
  }
  body.subdivisions = 1; // fewer than the body's size asks
  EXPECT_GT(StreamedTerrain::Open(path, body)->Subdivisions(), 8);
  options.subdivisions = 13;
  EXPECT_THROW(StreamedTerrain::Open(folder / "slope.tif", options), Error);
}

} // namespace
