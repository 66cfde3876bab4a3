// Streamed terrains: on a plane against GridTerrain, on a body against closed forms.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/terrain/GridTerrain.h>
#include <dspace/terrain/StreamedTerrain.h>

#include "RasterFile.h"
#include "TestData.h"

namespace {

using namespace dspace;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

constexpr double Degree = M_PI / 180.0;

double Hills(double c, double r) {
  return 80.0 * std::sin(0.031 * c) * std::cos(0.027 * r) + 9.0 * std::sin(0.21 * c + 0.17 * r) +
         1.5 * std::sin(0.9 * c) * std::sin(0.8 * r);
}

StreamedTerrainOptions Streamed(const GridTerrainOptions& options) {
  StreamedTerrainOptions streamed;
  streamed.elevation = options.elevation;
  streamed.origin = options.origin;
  streamed.originHeight = options.originHeight;
  return streamed;
}

// Everything that both can be asked, at random places in and around the data.
void ExpectSame(const std::string& path, const GridTerrainOptions& options = {}) {
  const auto grid = GridTerrain::Load(path, options);
  const auto streamed = StreamedTerrain::Open(path, Streamed(options));
  EXPECT_EQ(grid->GetWarnings(), streamed->GetWarnings());
  const TerrainBounds a = grid->GetBounds();
  const TerrainBounds b = streamed->GetBounds();
  const double size = a.scene.sizes().norm();
  EXPECT_TRUE(a.scene.isApprox(b.scene, 1e-9)) << path;
  EXPECT_TRUE(a.map.isApprox(b.map, 1e-9)) << path;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-0.05, 1.05);
  constexpr int Count = 3000;
  Rows3 points(Count, 3);
  Rows2 map(Count, 2);
  for (int i = 0; i < Count; ++i) {
    const Eigen::Vector3d share(unit(random), unit(random), unit(random));
    points.row(i) = a.scene.min() + share.cwiseProduct(a.scene.sizes());
    map.row(i) = streamed->SceneToMap(points.row(i)).head<2>();
  }
  Eigen::VectorXd heights(Count);
  Eigen::VectorXd heightsMap(Count);
  streamed->Heights(points, heights);
  streamed->HeightsMap(map, heightsMap);
  int valid = 0;
  for (int i = 0; i < Count; ++i) {
    const SurfaceSample s = grid->Sample(points.row(i));
    const SurfaceSample t = streamed->Sample(points.row(i));
    ASSERT_EQ(s.valid, t.valid) << path << " at " << points.row(i);
    ASSERT_EQ(std::isnan(heights[i]), !s.valid);
    if (!s.valid) {
      continue;
    }
    ++valid;
    // Floats of up to 8192 m are within 0.25 mm.
    EXPECT_NEAR(s.height, t.height, 1e-3);
    EXPECT_EQ(t.height, heights[i]);
    EXPECT_NEAR(heights[i], heightsMap[i], 1e-6);
    EXPECT_LT((s.position_S - t.position_S).norm(), 1e-3);
    EXPECT_LT((s.normal_S - t.normal_S).norm(), 1e-3);
    EXPECT_NEAR(s.slope_deg, t.slope_deg, 0.05);
    EXPECT_EQ(t.level, 0);
  }
  EXPECT_GT(valid, Count / 4) << path << " of size " << size;
  // Rays of all kinds: down, up from below, grazing, from far away and from within.
  int hits = 0;
  for (int i = 0; i < Count; ++i) {
    Eigen::Vector3d from = points.row(i);
    const Eigen::Vector3d to = points.row((i * 7 + 1) % Count);
    if (i % 3 == 0) {
      from.z() += (i % 2 == 0 ? 1.0 : -1.0) * size;
    }
    const double most = i % 5 == 0 ? 0.4 * size : std::numeric_limits<double>::infinity();
    const Eigen::Vector3d along =
        i % 17 == 0 ? Eigen::Vector3d(0, 0, i % 2 == 0 ? -1 : 1) : Eigen::Vector3d(to - from);
    const RayHit g = grid->Intersect(from, along, most);
    const RayHit h = streamed->Intersect(from, along, most);
    // Where the two surfaces, a rounding apart, are met at a grazing angle they may be told apart.
    const double steep = g.hit ? std::abs(g.normal_S.dot(along.normalized())) : 1.0;
    ASSERT_TRUE(g.hit == h.hit || steep < 1e-3) << path << " ray " << i;
    if (!g.hit || !h.hit || steep < 1e-3) {
      continue;
    }
    ++hits;
    EXPECT_NEAR(g.distance, h.distance, 1e-3 / steep) << path << " ray " << i;
    EXPECT_EQ(g.fromBelow, h.fromBelow);
    if (std::abs(g.distance - h.distance) < 1e-3) {
      EXPECT_LT((g.position_S - h.position_S).norm(), 1e-2);
    }
    // It lies on its own surface.
    const SurfaceSample s = streamed->Sample(h.position_S);
    if (s.valid) {
      EXPECT_NEAR(s.position_S.z(), h.position_S.z(), 1e-6 + 1e-12 * size);
    }
  }
  EXPECT_GT(hits, Count / 4) << path;
}

TEST(StreamedTerrain, OnAPlaneItIsTheGrid) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 411;
  file.height = 303;
  file.noData = -9999.0;
  file.geotransform = std::array<double, 6>{1000, 2, 0, 5000, 0, -2};
  file.value = [](int c, int r, int) {
    return (c - 200) * (c - 200) + (r - 90) * (r - 90) < 900 ? -9999.0 : Hills(c, r);
  };
  ExpectSame(file.Write(folder / "plain.tif"));
  file.geotransform = std::array<double, 6>{1000, 2, 0.6, 5000, 0.3, -1.5};
  ExpectSame(file.Write(folder / "sheared.tif"));
  file.geotransform = std::array<double, 6>{1000, 2, 0, 5000, 0, 2};
  GridTerrainOptions options;
  options.origin = Eigen::Vector2d(1100.0, 5200.0);
  options.originHeight = 250.0;
  ExpectSame(file.Write(folder / "south-up.tif"), options);
  options = {};
  file.geotransform = std::array<double, 6>{100, 1e-4, 0, -4, 0, -1e-4};
  file.crs = "+proj=longlat +R=3396190 +no_defs";
  ExpectSame(file.Write(folder / "degrees.tif"));
  file.width = 3;
  file.height = 2;
  ExpectSame(file.Write(folder / "small.tif"));
}

TEST(StreamedTerrain, RealDataOnAPlaneAreTheGrid) {
  for (const char* name :
       {"terrain/moon_npole_stereo_33.tif", "terrain/earth_california_ned_1arcsec_129.tif",
        "terrain/earth_sfbay_200x125.tif", "terrain/moon_ulcn2005_spole_250.cub",
        "terrain/mars_gale_mola_128ppd_m.tif"}) {
    DSPACE_REAL_DATA(path, name);
    ExpectSame(path);
  }
}

// A whole body of `width` x width / 2 pixels.
struct Globe {
  int width = 96;
  double radius = 1737400.0;
  double west_deg = -180.0;                             // of the left edge
  int direction = 1;                                    // of longitude along columns
  std::function<double(double lon, double lat)> height; // [deg]

  double Step() const { return 360.0 / this->width; }
  double Lon(int c) const { return this->west_deg + this->direction * (c + 0.5) * this->Step(); }
  double Lat(int r) const { return 90.0 - (r + 0.5) * this->Step(); }
  RasterFile File() const {
    RasterFile file;
    file.width = this->width;
    file.height = this->width / 2;
    file.crs = "+proj=longlat +R=" + std::to_string(this->radius) + " +no_defs";
    file.verticalDatum = "sphere";
    file.geotransform = std::array<double, 6>{
        this->west_deg, this->direction * this->Step(), 0, 90, 0, -this->Step()};
    file.value = [this](int c, int r, int) {
      return double(float(this->height(this->Lon(c), this->Lat(r))));
    };
    return file;
  }
};

double Bulges(double lon, double lat) {
  const double l = lon * Degree;
  const double p = lat * Degree;
  return 4000.0 * std::cos(p) * std::cos(p) * std::sin(2.0 * l) + 1500.0 * std::sin(3.0 * p) +
         700.0 * std::cos(p) * std::cos(l - 0.4);
}

StreamedTerrainOptions OnBody() {
  StreamedTerrainOptions options;
  options.onBody = true;
  return options;
}

// The stated surface by hand: linear between pixels in longitude and latitude, on triangles whose
// diagonal runs down to the right, and ruled from the pole.
double ByHand(const Globe& globe, double lon, double lat) {
  const int height = globe.width / 2;
  const auto pixel = [&](int c, int r) {
    c = ((c % globe.width) + globe.width) % globe.width;
    return double(float(globe.height(globe.Lon(c), globe.Lat(r))));
  };
  double x = globe.direction * (lon - globe.west_deg) / globe.Step() - 0.5;
  x -= globe.width * std::floor(x / globe.width);
  const double y = (90.0 - lat) / globe.Step() - 0.5;
  const int c = int(x);
  const double u = x - c;
  if (y < 0.0 || y > height - 1.0) {
    const int row = y < 0.0 ? 0 : height - 1;
    double pole = 0.0;
    for (int i = 0; i < globe.width; ++i) {
      pole += pixel(i, row) / globe.width;
    }
    const double along = (1.0 - u) * pixel(c, row) + u * pixel(c + 1, row);
    const double share = 2.0 * (y < 0.0 ? y + 0.5 : height - 0.5 - y);
    return pole + share * (along - pole);
  }
  const int r = std::min(int(y), height - 2);
  const double v = y - r;
  const double corner = u > v ? pixel(c + 1, r) : pixel(c, r + 1);
  return (1.0 - std::max(u, v)) * pixel(c, r) + std::min(u, v) * pixel(c + 1, r + 1) +
         std::abs(u - v) * corner;
}

Eigen::Vector3d Direction(double lon, double lat) {
  return {std::cos(lat * Degree) * std::cos(lon * Degree),
          std::cos(lat * Degree) * std::sin(lon * Degree), std::sin(lat * Degree)};
}

TEST(StreamedTerrain, OnABodyHeightsAreThoseByHand) {
  const TemporaryFolder folder;
  for (const auto& [west, direction] : {std::pair(-180.0, 1), {0.0, 1}, {180.0, -1}}) {
    Globe globe;
    globe.west_deg = west;
    globe.direction = direction;
    globe.height = Bulges;
    const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), OnBody());
    EXPECT_TRUE(terrain->HeightRangeIsExact());
    EXPECT_GE(terrain->Subdivisions(), 1);
    // Flat cells stay within a millimetre of the sphere.
    const double cell = terrain->Placement().CellSize({0.0, double(1 << 20)});
    EXPECT_LE(cell * cell / (4.0 * globe.radius), 1e-3);
    std::mt19937 random(4);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    constexpr int Count = 4000;
    Rows3 points(Count, 3);
    Eigen::VectorXd heights(Count);
    std::vector<double> expected;
    for (int i = 0; i < Count; ++i) {
      const double lon = 180.0 * unit(random);
      // A quarter of them between the last row of pixels and a pole.
      const double lat = i % 4 == 0 ? 90.0 - 2.5 * std::abs(unit(random)) : 90.0 * unit(random);
      const double side = i % 8 == 0 ? -1.0 : 1.0;
      points.row(i) = (2e6 + 1e6 * unit(random)) * Direction(lon, side * lat);
      expected.push_back(ByHand(globe, lon, side * lat));
    }
    terrain->Heights(points, heights);
    for (int i = 0; i < Count; ++i) {
      ASSERT_NEAR(heights[i], expected[i], 2e-3) << west << " at " << points.row(i);
      const SurfaceSample sample = terrain->Sample(points.row(i));
      EXPECT_EQ(sample.height, heights[i]);
      EXPECT_NEAR(sample.position_S.norm(), globe.radius + heights[i], 1e-6);
      EXPECT_NEAR(sample.normal_S.norm(), 1.0, 1e-12);
    }
  }
}

// On a sphere of one height a ray's distance is the closed form's.
TEST(StreamedTerrain, RaysMeetASphereWhereTheClosedFormDoes) {
  const TemporaryFolder folder;
  Globe globe;
  globe.height = [](double, double) { return 1200.0; };
  const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), OnBody());
  const double radius = globe.radius + 1200.0;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d from =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized() * radius *
        (1.0 + (i % 3 == 0 ? 1e-6 : 0.3) * (0.01 + i % 10));
    Eigen::Vector3d to =
        Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized() * radius;
    if (i % 7 == 0) {
      to = Eigen::Vector3d(0, 0, i % 2 == 0 ? radius : -radius); // at a pole
    } else if (i % 11 == 0) {
      to = 0.3 * from; // straight down
    } else if (i % 3 == 0) {
      to = from + 3e4 * Eigen::Vector3d(normal(random), normal(random), normal(random));
    }
    const Eigen::Vector3d d = (to - from).normalized();
    const double b = from.dot(d);
    const double root = b * b - (from.squaredNorm() - radius * radius);
    const bool expected = root >= 0.0 && b < 0.0;
    const RayHit hit = terrain->Intersect(from, d);
    if (std::abs(root) < 1e4) {
      continue; // within a tenth of a millimetre of passing by
    }
    ASSERT_EQ(hit.hit, expected) << i << ": " << from.transpose() << " to " << to.transpose();
    if (expected) {
      ++hits;
      EXPECT_NEAR(hit.distance, -b - std::sqrt(root), 1e-6 / std::abs(d.dot(hit.normal_S)));
      EXPECT_FALSE(hit.fromBelow);
      EXPECT_LT((hit.normal_S - hit.position_S.normalized()).norm(), 1e-9);
    }
  }
  EXPECT_GT(hits, 2000);
}

// The first crossing that small steps along the ray find, by heights made by hand.
TEST(StreamedTerrain, RaysMeetABodysGroundWhereStepsDo) {
  const TemporaryFolder folder;
  for (const int direction : {1, -1}) {
    Globe globe;
    globe.width = 48;
    globe.radius = 20000.0; // a small body: its ground's shape matters
    globe.direction = direction;
    globe.height = [](double lon, double lat) {
      return 0.3 * Bulges(lon, lat) +
             150.0 * std::sin(lon * Degree * 11.0) * std::cos(lat * Degree);
    };
    const auto terrain = StreamedTerrain::Open(globe.File().Write(folder / "globe.tif"), OnBody());
    const auto above = [&](const Eigen::Vector3d& p) {
      const double lat = std::atan2(p.z(), p.head<2>().norm()) / Degree;
      return p.norm() - globe.radius - ByHand(globe, std::atan2(p.y(), p.x()) / Degree, lat);
    };
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    int hits = 0;
    int fromBelow = 0;
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector3d at(normal(random), normal(random), normal(random));
      Eigen::Vector3d from = at.normalized() * (i % 4 == 0   ? 17000.0
                                                : i % 4 == 1 ? 21500.0
                                                             : 60000.0);
      Eigen::Vector3d to =
          15000.0 * Eigen::Vector3d(normal(random), normal(random), normal(random));
      if (i % 9 == 0) {
        to = Eigen::Vector3d(0, 0, i % 2 == 0 ? 18000.0 : -18000.0);
        from = i % 18 == 0 ? Eigen::Vector3d(30000.0, 0.0, to.z()) : from;
      }
      const Eigen::Vector3d d = (to - from).normalized();
      const RayHit hit = terrain->Intersect(from, d, 1.2e5);
      double before = above(from);
      double found = -1.0;
      for (double t = 5.0; t < 1.2e5 && found < 0.0; t += 5.0) {
        const double now = above(from + t * d);
        if ((now > 0.0) != (before > 0.0)) {
          double a = t - 5.0;
          double b = t;
          while (b - a > 1e-9 * b) {
            const double m = 0.5 * (a + b);
            ((above(from + m * d) > 0.0) == (before > 0.0) ? a : b) = m;
          }
          found = 0.5 * (a + b);
        }
        before = now;
      }
      // Steps may pass over a crest's tip; floats of posts are within a quarter of a millimetre.
      if (hit.hit && (found < 0.0 || hit.distance < found - 1.0)) {
        EXPECT_NEAR(above(from + hit.distance * d), 0.0, 1e-3) << i;
        continue;
      }
      ASSERT_EQ(hit.hit, found >= 0.0) << i;
      if (hit.hit) {
        ++hits;
        fromBelow += hit.fromBelow;
        const double steep = std::max(1e-3, std::abs(hit.normal_S.dot(d)));
        EXPECT_NEAR(hit.distance, found, 1e-3 / steep) << i;
        EXPECT_NEAR(terrain->Sample(hit.position_S).position_S.norm(), hit.position_S.norm(), 2e-6);
      }
    }
    EXPECT_GT(hits, 150);
    EXPECT_GT(fromBelow, 20);
  }
}

} // namespace
