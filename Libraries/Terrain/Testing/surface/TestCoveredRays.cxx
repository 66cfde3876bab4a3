// Rays over terrain groups and wheel tracks: against every triangle near them, and what they read.
#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include <dspace/rays/SurfaceRay.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Patches.h"
#include "RasterFile.h"
#include "WheelTrackTestSupport.h"

namespace {

using namespace dspace;
using namespace dspace::testing;

// All posts of level 0 of a terrain on a plane, and its triangles, every one that a ray's shadow
// meets tried (Moller and Trumbore 1997).
class EveryTriangle {
public:
  explicit EveryTriangle(const StreamedTerrain& terrain)
      : Terrain_(terrain), Columns_(int(terrain.Pyramid()->Lattice().columns)),
        Rows_(int(terrain.Pyramid()->Lattice().rows)),
        Heights_(std::size_t(Columns_) * std::size_t(Rows_)) {
    terrain.Pyramid()->Read({0, 0, 0, this->Columns_, this->Rows_}, this->Heights_.data());
    const Eigen::Affine2d& map = terrain.Placement().PostToScene();
    EXPECT_TRUE(map.linear().isDiagonal(1e-12)); // north-up, as the loops below take it
  }

  Eigen::Vector3d Post(int c, int r) const {
    return this->Terrain_.Placement().ToScene(
        Eigen::Vector2d(c, r), this->Heights_[std::size_t(r) * std::size_t(this->Columns_) + c]);
  }

  std::optional<double> Hit(const Eigen::Vector3d& o, const Eigen::Vector3d& d) const {
    std::optional<double> nearest;
    const auto test = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c) {
      const Eigen::Vector3d e1 = b - a, e2 = c - a, p = d.cross(e2);
      const double det = e1.dot(p);
      const Eigen::Vector3d s = o - a, q = s.cross(e1);
      const double u = s.dot(p) / det, v = d.dot(q) / det, t = e2.dot(q) / det;
      // Written so that what is not a number is no hit: a degenerate triangle, a hole.
      if (std::min({u, v, 1.0 - u - v}) >= -1e-9 && t >= 0.0 && (!nearest || t < *nearest)) {
        nearest = t;
      }
    };
    const Eigen::Affine2d& toPost = this->Terrain_.Placement().SceneToPost();
    const Eigen::Vector2d from = toPost * Eigen::Vector2d(o.head<2>());
    const Eigen::Vector2d along = toPost.linear() * Eigen::Vector2d(d.head<2>());
    const auto cell = [](double at, int count) {
      return int(std::clamp(std::floor(at), 0.0, count - 2.0));
    };
    for (int r = 0; r + 1 < this->Rows_; ++r) { // columns over which its shadow is in the row
      double c0 = from.x();
      double c1 = from.x() + along.x() * 1e9;
      if (std::abs(along.y()) > 1e-12) {
        const double t0 = (r - 1e-6 - from.y()) / along.y();
        const double t1 = (r + 1 + 1e-6 - from.y()) / along.y();
        if (std::max(t0, t1) < 0.0) {
          continue;
        }
        c0 = from.x() + along.x() * std::max(0.0, t0);
        c1 = from.x() + along.x() * std::max(0.0, t1);
      } else if (from.y() < r - 1e-6 || from.y() > r + 1 + 1e-6) {
        continue;
      }
      if (std::max(c0, c1) < -1.0 || std::min(c0, c1) > this->Columns_) {
        continue;
      }
      for (int c = cell(std::min(c0, c1) - 1e-6, this->Columns_);
           c <= cell(std::max(c0, c1) + 1e-6, this->Columns_); ++c) {
        const Eigen::Vector3d nw = this->Post(c, r), se = this->Post(c + 1, r + 1);
        test(nw, this->Post(c, r + 1), se);
        test(nw, se, this->Post(c + 1, r));
      }
    }
    return nearest;
  }

private:
  const StreamedTerrain& Terrain_;
  int Columns_;
  int Rows_;
  std::vector<float> Heights_;
};

struct Seen {
  int hits = 0;
  int misses = 0;
  int fromBelow = 0;
};

// Rays from above, grazing ones and ones from below, about places that `place` chooses. `height`
// is how far above or below the ground grazing ones begin.
template<typename Place>
Seen Compare(const StreamedTerrain& terrain, int rays, double size, double height,
             const Place& place, unsigned seed) {
  const EveryTriangle every(terrain);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Seen seen;
  for (int i = 0; i < rays; ++i) {
    const Eigen::Vector2d at = place(random);
    Eigen::Vector3d from(at.x(), at.y(), 0.0);
    from.z() = terrain.Sample(from).position_S.z();
    Eigen::Vector3d direction;
    if (i % 4 == 0) { // down onto it
      from += Eigen::Vector3d(size * unit(random), size * unit(random), size);
      direction = Eigen::Vector3d(at.x(), at.y(), 0.0) - from;
    } else { // grazing, every fourth from below
      from.z() += (i % 4 == 3 ? -1.0 : 1.0) * height * (1.05 + unit(random));
      const double azimuth = i % 16 < 4 ? 0.5 * M_PI * (i % 4) : M_PI * unit(random);
      direction << std::cos(azimuth), std::sin(azimuth), 0.02 * unit(random);
    }
    direction.normalize();
    const RayHit hit = terrain.Intersect(from, direction);
    const std::optional<double> truth = every.Hit(from, direction);
    ++(hit.hit ? seen.hits : seen.misses);
    seen.fromBelow += hit.hit && hit.fromBelow;
    EXPECT_EQ(hit.hit, truth.has_value()) << "ray " << i;
    if (hit.hit && truth) {
      // Posts between the raster's are floats: off by half a step, and more along a flat ray.
      const double steep = std::max(1e-4, std::abs(hit.normal_S.dot(direction)));
      EXPECT_NEAR(hit.distance, *truth, 2e-5 / steep) << "ray " << i;
      EXPECT_EQ(hit.fromBelow, hit.normal_S.dot(direction) > 0.0) << "ray " << i;
    }
  }
  return seen;
}

// 40 m x 40 m of pixels 0.2 m apart.
std::shared_ptr<StreamedTerrain> Field(const TemporaryFolder& folder) {
  RasterFile file;
  file.width = 201;
  file.height = 201;
  file.type = GDT_Float32;
  file.crs = "EPSG:32633";
  file.geotransform = {500000.0, 0.2, 0.0, 4200000.0, 0.0, -0.2};
  file.value = [](int c, int r, int) {
    return 0.4 * std::sin(0.05 * c) * std::cos(0.07 * r) + 0.01 * ((c * 7 + r * 13) % 5);
  };
  StreamedTerrainOptions options;
  options.subdivisions = 3;
  return StreamedTerrain::Open(file.Write(folder / "field.tif"), options);
}

TEST(CoveredRays, OverWheelTracksTheyMeetTheNearestTriangle) {
  const TemporaryFolder folder;
  const auto terrain = Field(folder);
  std::mt19937 random(3);
  std::vector<TrackAddition> additions;
  std::vector<Eigen::Vector2d> places;
  for (int n = 0; n < 4; ++n) {
    additions.push_back(
        Stroke("wheel " + std::to_string(n), Rut(), Wander(random, 80, n % 2 == 0)));
    for (const TrackContact& contact : additions.back().contacts) {
      places.push_back(contact.place);
    }
  }
  terrain->AddTracks(additions);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto near = [&](std::mt19937& chance) { // ruts, their rims and what lies beside them
    const Eigen::Vector2d& place = places[chance() % places.size()];
    return Eigen::Vector2d(place + 0.3 * Eigen::Vector2d(unit(chance), unit(chance)));
  };
  const Seen ruts = Compare(*terrain, 600, 3.0, 0.05, near, 11);
  EXPECT_GT(ruts.hits, 400);
  EXPECT_GT(ruts.fromBelow, 100);
  const auto anywhere = [&](std::mt19937& chance) {
    return Eigen::Vector2d(19.5 * unit(chance), 19.5 * unit(chance));
  };
  const Seen field = Compare(*terrain, 600, 10.0, 0.3, anywhere, 12);
  EXPECT_GT(field.hits, 300);
  EXPECT_GT(field.misses, 20);
}

// A base of 300 m, a patch of 60 m, and one of 20 m over both its middle and its border.
struct GroupRays : ::testing::Test {
  TemporaryFolder folder;
  Projection plane = EquidistantCylindrical(24.0, 60.0);
  Eigen::Vector2d middle = plane.toMap({24.3, 60.2});
  PatchFile coarse, fine;
  std::shared_ptr<const StreamedTerrain> terrain;

  void SetUp() override {
    RasterFile file;
    file.width = 60;
    file.height = 50;
    file.unit = "m";
    file.verticalDatum = "sphere";
    file.crs = plane.text;
    file.geotransform =
        std::array<double, 6>{middle.x() - 9000.0, 300.0, 0, middle.y() + 7500.0, 0, -300.0};
    file.value = [](int c, int r, int) {
      return 3.0 * c - 2.0 * r + 30.0 * std::sin(0.9 * c) * std::cos(0.7 * r);
    };
    coarse.projection = EquidistantCylindrical(24.1, 59.0);
    coarse.middle = {24.3, 60.2};
    coarse.width = 90;
    coarse.height = 80;
    coarse.size = 60.0;
    coarse.margin = 400.0;
    coarse.formula = [](const Eigen::Vector2d& m) {
      return 70.0 + 25.0 * std::sin(m.x() / 350.0) * std::cos(m.y() / 400.0);
    };
    fine.projection = PolarStereographic(10.0);
    fine.middle = {24.36, 60.24};
    fine.width = 130;
    fine.height = 110;
    fine.size = 20.0;
    fine.margin = 200.0;
    fine.formula = [](const Eigen::Vector2d& m) {
      return 40.0 + 6.0 * std::sin(m.x() / 60.0) * std::cos(m.y() / 45.0);
    };
    StreamedTerrainOptions options;
    options.patches = {coarse.Write(folder / "coarse.tif"), fine.Write(folder / "fine.tif")};
    terrain = StreamedTerrain::Open(file.Write(folder / "base.tif"), options);
    ASSERT_TRUE(terrain->Group()->patches[0].used && terrain->Group()->patches[1].used);
  }
  Eigen::Vector2d Scene(const Eigen::Vector2d& map) const {
    return terrain->MapToScene({map.x(), map.y(), 0.0}).head<2>();
  }
};

TEST_F(GroupRays, TheyMeetTheNearestTriangle) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto anywhere = [&](std::mt19937& random) {
    return Scene(middle + Eigen::Vector2d(8500.0 * unit(random), 7000.0 * unit(random)));
  };
  const Seen all = Compare(*terrain, 500, 3000.0, 60.0, anywhere, 21);
  EXPECT_GT(all.hits, 200);
  EXPECT_GT(all.misses, 20);
  const auto borders = [&](std::mt19937& random) { // of both patches
    const PatchFile& patch = random() % 2 == 0 ? coarse : fine;
    const double along = unit(random);
    const double side = random() % 2 == 0 ? 1.0 : -1.0;
    Eigen::Vector2d place(along, side * (1.0 + 0.05 * unit(random)));
    if (random() % 2 == 0) {
      std::swap(place.x(), place.y());
    }
    const Eigen::Vector2d pixel(0.5 * patch.width * (1.0 + place.x()),
                                0.5 * patch.height * (1.0 + place.y()));
    return Scene(plane.toMap(patch.LonLatOf(pixel)));
  };
  const Seen near = Compare(*terrain, 500, 800.0, 8.0, borders, 22);
  EXPECT_GT(near.hits, 350);
  EXPECT_GT(near.fromBelow, 80);
}

// The ground's own posts, 32 x 32 of a pixel's, are read where a patch is and the ray near it.
TEST_F(GroupRays, WhereNoPatchIsNoFinePostIsRead) {
  const std::uint64_t before = terrain->Pyramid()->Statistics().loads;
  int hits = 0;
  for (int i = 0; i < 40; ++i) { // along the south, and high over both patches
    const Eigen::Vector2d south = Scene(middle + Eigen::Vector2d(-8800.0, -6800.0 + 60.0 * i));
    const double ground = terrain->Undisturbed().Sample({south.x(), south.y(), 0.0}).position_S.z();
    hits += terrain->Intersect({south.x(), south.y(), ground + 5.0}, {1.0, 0.0, 0.001}).hit;
    const Eigen::Vector2d west = Scene(middle + Eigen::Vector2d(-8800.0, -1500.0 + 80.0 * i));
    hits += terrain->Intersect({west.x(), west.y(), 400.0}, {1.0, 0.0, -0.001}).hit;
  }
  EXPECT_GT(hits, 10);
  EXPECT_EQ(terrain->Pyramid()->Statistics().loads, before);
}

// A small body with a patch across its date line: against rays that look at every fine tile.
TEST(CoveredRays, OnABodyTheyMeetWhatFineTilesHave) {
  const TemporaryFolder folder;
  RasterFile file;
  file.width = 128;
  file.height = 64;
  file.unit = "m";
  file.verticalDatum = "sphere:10000";
  file.crs = "+proj=longlat +R=10000 +no_defs";
  file.geotransform = std::array<double, 6>{-180, 360.0 / 128, 0, 90, 0, -360.0 / 128};
  file.value = [](int c, int r, int) {
    return 200.0 * std::sin(2.0 * M_PI * 9 * c / 128) * std::sin(0.3 * r);
  };
  StreamedTerrainOptions options;
  options.onBody = true;
  const std::string path = file.Write(folder / "body.tif");
  file.width = 110;
  file.height = 90;
  file.geotransform = std::array<double, 6>{169.0, 0.2, 0, 39.0, 0, -0.2};
  file.value = [](int c, int r, int) {
    return 120.0 + 60.0 * std::sin(0.2 * c) * std::cos(0.25 * r);
  };
  TerrainPatch patch;
  patch.path = file.Write(folder / "patch.tif");
  patch.margin = 400.0;
  options.patches = {patch};
  const auto terrain = StreamedTerrain::Open(path, options);
  ASSERT_TRUE(terrain->Group()->patches[0].used);
  const PostSurface fine(terrain->Pyramid(), 0, true, 60.0);
  const SurfaceRay every(fine);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const double lon = (180.0 + 20.0 * unit(random)) * Deg;
    const double lat = (30.0 + 16.0 * unit(random)) * Deg;
    const Eigen::Vector3d up(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon),
                             std::sin(lat));
    const Eigen::Vector3d ground = terrain->Sample(1e4 * up).position_S;
    const Eigen::Vector3d from = ground + (i % 3 == 0 ? 600.0 : 20.0 * (1.05 + unit(random))) * up;
    Eigen::Vector3d direction = Eigen::Vector3d(unit(random), unit(random), unit(random));
    direction = (direction - direction.dot(up) * up).normalized() + 0.05 * unit(random) * up;
    direction = (direction - (i % 3 == 0 ? 0.5 : 0.0) * up).normalized();
    const RayHit hit = terrain->Intersect(from, direction, 8000.0);
    const RayPath ray(terrain->Placement(), terrain->Pyramid()->Lattice(), from, direction, 8000.0,
                      -1e9, 1e9);
    const SurfaceRay::Hit truth = every.Intersect(ray);
    ASSERT_EQ(hit.hit, truth.hit) << i;
    hits += hit.hit;
    if (hit.hit) {
      const double steep = std::max(1e-4, std::abs(hit.normal_S.dot(direction)));
      EXPECT_NEAR(hit.distance, truth.distance, 5e-5 / steep) << i;
      EXPECT_EQ(hit.fromBelow, truth.fromBelow) << i;
    }
  }
  EXPECT_GT(hits, 150);
}

} // namespace
