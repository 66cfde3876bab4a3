// Degree grids around a body whose columns do not halve: resampled along the parallels.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/posts/RasterPosts.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Globe.h"

namespace {

using namespace dspace;
using dspace::testing::Bulges;
using dspace::testing::ByHand;
using dspace::testing::Direction;
using dspace::testing::Globe;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

StreamedTerrainOptions OnBody() {
  StreamedTerrainOptions options;
  options.onBody = true;
  return options;
}

// Posts are a quarter of a pixel apart at most: across a kink of slope J a pixel their triangles
// cut J / 16 off. Kinks are at columns of pixels (second differences) and at diagonals (twists).
double MaximumDeparture(const Globe& globe) {
  double difference = 0.0;
  double twist = 0.0;
  for (int r = 0; r + 1 < globe.width / 2; ++r) {
    for (int c = 0; c < globe.width; ++c) {
      const auto at = [&](int i, int j) {
        return globe.height(globe.Lon(c + i), globe.Lat(r + j));
      };
      difference = std::max(difference, std::abs(at(-1, 0) - 2.0 * at(0, 0) + at(1, 0)));
      twist = std::max(twist, std::abs(at(0, 0) + at(1, 1) - at(1, 0) - at(0, 1)));
    }
  }
  return (difference + 2.0 * twist) / 16.0;
}

TEST(ResampledGlobe, HeightsAreThoseByHandWithinTheStatedDeparture) {
  const TemporaryFolder folder;
  for (const auto& [width, west, direction] :
       {std::tuple(450, -180.0, 1), {250, 0.0, 1}, {246, 180.0, -1}, {1000, 11.3, 1}}) {
    Globe globe;
    globe.width = width;
    globe.west_deg = west;
    globe.direction = direction;
    globe.height = Bulges;
    const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), OnBody());
    ASSERT_TRUE(terrain->Resampling());
    const double most = MaximumDeparture(globe) + 2e-3; // floats
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    constexpr int Count = 3000;
    Rows3 points(Count, 3);
    Rows2 map(Count, 2);
    Eigen::VectorXd heights(Count);
    Eigen::VectorXd ofMap(Count);
    std::vector<double> expected;
    const double pixel = globe.Step();
    for (int i = 0; i < Count; ++i) {
      // Quarters: anywhere, about the seam, about either pole.
      const double lon = i % 4 == 1 ? west + 2.0 * pixel * unit(random) : 180.0 * unit(random);
      const double lat =
          i % 4 < 2 ? 89.9 * unit(random)
                    : (i % 4 == 2 ? 1.0 : -1.0) * (90.0 - 2.5 * pixel * std::abs(unit(random)));
      points.row(i) = 2e6 * Direction(lon, lat);
      map.row(i) << lon, lat;
      expected.push_back(ByHand(globe, lon, lat));
    }
    terrain->Heights(points, heights);
    terrain->HeightsMap(map, ofMap);
    double greatest = 0.0;
    for (int i = 0; i < Count; ++i) {
      ASSERT_NEAR(heights[i], expected[i], most) << width << " at " << map.row(i);
      ASSERT_NEAR(heights[i], ofMap[i], 1e-3);
      greatest = std::max(greatest, std::abs(heights[i] - expected[i]));
    }
    EXPECT_LT(most, 3.0) << width; // of 7 km
    EXPECT_GT(greatest, 1e-3) << width;
  }
}

// What it states of itself: against every pixel.
TEST(ResampledGlobe, TheStatedErrorIsThatAtThePixels) {
  const TemporaryFolder folder;
  Globe globe;
  globe.width = 450;
  globe.height = [](double lon, double lat) { // as rough as a pixel lets it be
    return 300.0 * std::sin(91.0 * lon) * std::cos(37.0 * lat);
  };
  const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), OnBody());
  ASSERT_TRUE(terrain->Resampling());
  const ResamplingReport report = *terrain->Resampling();
  EXPECT_EQ(report.columns, 452); // 113 x 4
  EXPECT_EQ(report.posts, 256);
  double squares = 0.0;
  double greatest = 0.0;
  Rows3 points(Eigen::Index(globe.width) * (globe.width / 2), 3);
  std::vector<double> pixels;
  for (int r = 0; r < globe.width / 2; ++r) {
    for (int c = 0; c < globe.width; ++c) {
      points.row(Eigen::Index(pixels.size())) = 2e6 * Direction(globe.Lon(c), globe.Lat(r));
      pixels.push_back(globe.height(globe.Lon(c), globe.Lat(r)));
    }
  }
  Eigen::VectorXd heights(points.rows());
  terrain->Heights(points, heights);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double error = heights[Eigen::Index(i)] - pixels[i];
    squares += error * error;
    greatest = std::max(greatest, std::abs(error));
  }
  const double rms = std::sqrt(squares / double(pixels.size()));
  EXPECT_GT(rms, 1.0);
  EXPECT_NEAR(report.rmsError, rms, 0.25 * rms); // of 256
  EXPECT_LE(report.greatestError, greatest + 1e-2);
  EXPECT_GT(report.greatestError, 0.5 * greatest);
  EXPECT_LE(greatest, MaximumDeparture(globe) + 1e-2);
  bool told = false;
  for (const std::string& warning : terrain->GetWarnings()) {
    told = told || warning.find("resampled to 452") != std::string::npos;
  }
  EXPECT_TRUE(told);
}

// Rows and columns that are odd, and ones that do not reach the poles: against the formula.
TEST(ResampledGlobe, AnyNumberOfColumnsAndRowsIsAccepted) {
  const TemporaryFolder folder;
  for (const auto& [columns, rows, south] :
       {std::tuple(451, 225, -90.0), {1001, 333, -90.0}, {777, 200, 20.0}, {20, 700, -90.0}}) {
    RasterFile file;
    file.width = columns;
    file.height = rows;
    file.crs = "+proj=longlat +R=1737400 +no_defs";
    file.verticalDatum = "sphere";
    const double dx = 360.0 / columns;
    const double dy = (90.0 - south) / rows;
    const double west = -123.4;
    file.geotransform = std::array<double, 6>{west, dx, 0, 90, 0, -dy};
    const auto height = [](double lon, double lat) {
      const double w = std::cos(lat * dspace::testing::Degree);
      return 1000.0 * w * std::cos(lon * dspace::testing::Degree) + 500.0 * w;
    };
    file.value = [&, x = dx, y = dy](int c, int r, int) {
      return height(west + (c + 0.5) * x, 90.0 - (r + 0.5) * y);
    };
    const auto terrain = StreamedTerrain::Open(file.Write(folder / "odd.tif"), OnBody());
    EXPECT_TRUE(terrain->Pyramid()->Lattice().periodic);
    EXPECT_EQ(terrain->Resampling().has_value(), true) << columns;
    // A chord's departure, in either direction and along the diagonal, thrice at most.
    const double step = std::max(dx, dy) * dspace::testing::Degree;
    const double most = 1500.0 * step * step * 0.5 + 500.0 * (0.5 * step) * (0.5 * step) + 0.01;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int i = 0; i < 400; ++i) {
      const double lon = i % 2 ? west + 3.0 * dx * (unit(random) - 0.5) : 360.0 * unit(random);
      const double lat = 90.0 - dy - (88.0 - south) * 0.98 * unit(random);
      const SurfaceSample sample = terrain->Sample(2e6 * Direction(lon, lat));
      ASSERT_TRUE(sample.valid) << columns << " at " << lon << ", " << lat;
      ASSERT_NEAR(sample.height, height(lon, lat), most) << columns << " at " << lon << ", " << lat;
    }
  }
}

// Means over boxes that begin and end within pixels, across the seam: summed pixel by pixel.
TEST(ResampledGlobe, CoarserPostsAreMeansOfThePixelsUnderThem) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 1003;
  file.height = 64;
  const auto value = [](int c, int r) { return double((c * 7919 + r * 104729) % 3001); };
  file.value = [&](int c, int r, int) { return value(c, r); };
  const auto source = std::make_shared<const ElevationSource>(file.Write(folder / "ring.tif"));
  RasterPostsOptions options;
  options.periodic = true;
  options.coarsest = 60;
  options.columns = ColumnsAround(1003, 63, 60);
  options.subdivisions = 2;
  ASSERT_EQ(options.columns, 1008); // 63 x 16
  const RasterPosts posts(source, options);
  const double stretch = 1003.0 / 1008.0;
  for (int level = 3; level <= 5; ++level) { // every pixel is read up to 8 of them a post
    const int step = 1 << (level - 2);
    const int count = int(posts.GetLattice().ColumnsAt(level));
    const int rows = int(posts.GetLattice().RowsAt(level));
    // More than a turn, from before the seam.
    const PostBlock block{level, -3, 0, count + 7, rows};
    std::vector<float> heights(std::size_t(block.width) * block.height);
    posts.Read(block, heights.data());
    for (int j = 0; j < rows; ++j) {
      for (int i = 0; i < block.width; ++i) {
        const double x = 0.5 + (block.column + i) * step * stretch;
        const double y = 0.5 + std::min(j * step, 63);
        double sum = 0.0;
        double area = 0.0;
        for (int r = 0; r < 64; ++r) {
          const double high =
              std::min(r + 1.0, y + 0.5 * step) - std::max(double(r), y - 0.5 * step);
          for (int c = -40; high > 0.0 && c < 1060; ++c) {
            const double wide = std::min(c + 1.0, x + 0.5 * step * stretch) -
                                std::max(double(c), x - 0.5 * step * stretch);
            if (wide > 0.0) {
              sum += wide * high * value((c + 1003) % 1003, r);
              area += wide * high;
            }
          }
        }
        ASSERT_NEAR(heights[std::size_t(j) * block.width + i], sum / area, 1e-3)
            << level << ": " << block.column + i << ", " << j;
      }
    }
  }
}

TEST(ResampledGlobe, ALevelGlobeIsLevelAndRaysMeetIt) {
  const TemporaryFolder folder;
  Globe globe;
  globe.width = 1790; // down to 112 x 16
  globe.height = [](double, double) { return 1200.0; };
  const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), OnBody());
  const PostLattice& lattice = terrain->Pyramid()->Lattice();
  for (int level = 0; level < lattice.levels; ++level) {
    const std::int64_t columns = lattice.ColumnsAt(level);
    const std::int64_t rows = lattice.RowsAt(level);
    for (const std::int64_t row : {std::int64_t(0), rows / 2, rows - 4}) {
      for (const std::int64_t column : {std::int64_t(-20), columns / 3, columns - 20}) {
        std::vector<float> heights(40 * 4);
        terrain->Pyramid()->Read({level, column, row, 40, 4}, heights.data());
        for (const float height : heights) {
          ASSERT_EQ(height, 1200.0f) << level;
        }
      }
    }
  }
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d up =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    const RayHit hit = terrain->Intersect(5e6 * up, -up);
    ASSERT_TRUE(hit.hit);
    EXPECT_NEAR(hit.distance, 5e6 - globe.radius - 1200.0, 1e-3);
  }
}

// Finer levels lie on the surface that is asked.
TEST(ResampledGlobe, PostsOfLevelZeroAreWhatIsAnswered) {
  const TemporaryFolder folder;
  Globe globe;
  globe.width = 250;
  globe.height = Bulges;
  const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), OnBody());
  ASSERT_GT(terrain->FullLevel(), 1);
  const PostLattice& lattice = terrain->Pyramid()->Lattice();
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    const std::int64_t row = i % 3 == 0 ? random() % 300 : std::int64_t(random() % lattice.rows);
    const auto column = std::int64_t(random() % std::uint64_t(lattice.columns));
    float height = 0.0f;
    terrain->Pyramid()->Read({0, column, row, 1, 1}, &height);
    const Eigen::Vector3d p =
        terrain->Placement().ToScene(Eigen::Vector2d(double(column), double(row)), 0.0);
    ASSERT_NEAR(terrain->Sample(p).height, height, 2e-3) << column << ", " << row;
  }
}

// Of the pixels, not of what lies between them: a chequerboard's is its step's half.
TEST(ResampledGlobe, RoughnessIsOfItsPixels) {
  const TemporaryFolder folder;
  Globe globe;
  globe.width = 450;
  globe.height = [&](double lon, double lat) {
    const auto c = std::lround((lon - globe.west_deg) / globe.Step() - 0.5);
    const auto r = std::lround((90.0 - lat) / globe.Step() - 0.5);
    return (c + r) % 2 == 0 ? 10.0 : -10.0;
  };
  const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), OnBody());
  Rows3 points(2, 3);
  points.row(0) = 2e6 * Direction(-179.9, 3.0);
  points.row(1) = 2e6 * Direction(40.0, 50.0);
  Eigen::VectorXd roughness(2);
  terrain->Roughness(points, 4e5, roughness);
  EXPECT_NEAR(roughness[0], 10.0, 0.05);
  EXPECT_NEAR(roughness[1], 10.0, 0.05);
}

// A patch lies where its map says.
TEST(ResampledGlobe, PatchesLieOnIt) {
  const TemporaryFolder folder;
  Globe globe;
  globe.width = 250;
  globe.height = Bulges;
  RasterFile patch;
  patch.width = patch.height = 60;
  patch.crs = "+proj=longlat +R=1737400 +no_defs";
  patch.verticalDatum = "sphere";
  patch.geotransform = std::array<double, 6>{170.0, 0.5, 0, 15.0, 0, -0.5}; // over the date line
  patch.value = [](int, int, int) { return 5000.0; };
  StreamedTerrainOptions options = OnBody();
  TerrainPatch over;
  over.path = patch.Write(folder / "patch.tif");
  over.margin = 30000.0; // two pixels
  options.patches.push_back(over);
  const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), options);
  for (const double lon : {174.0, 179.9, -179.9, -164.0}) {
    for (const double lat : {11.0, 0.0, -11.0}) {
      EXPECT_NEAR(terrain->Sample(2e6 * Direction(lon, lat)).height, 5000.0, 1e-2) << lon;
    }
  }
  const double most = MaximumDeparture(globe) + 2e-3;
  for (const double lon : {168.0, -158.0, 20.0}) {
    EXPECT_NEAR(terrain->Sample(2e6 * Direction(lon, 3.0)).height, ByHand(globe, lon, 3.0), most);
  }
}

} // namespace
