// Wheel tracks on a grid in memory: what is answered, and the triangles that show it.
#include <cmath>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/mesh/TerrainMesh.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Grids.h"
#include "RasterFile.h"

namespace {

using namespace dspace;
using dspace::testing::NorthUp;
using dspace::testing::RasterFile;
using dspace::testing::TemporaryFolder;

constexpr double Spacing = 0.05; // [m] of posts
constexpr int Side = 401;        // 20 m

double Before(double x, double y) {
  return -4500.0 + 0.1 * x + 0.02 * y;
}

// A slope, (0, 0) in the middle, with posts at multiples of the spacing.
std::shared_ptr<GridTerrain> Slope() {
  const double edge = -0.5 * Side * Spacing;
  const Eigen::Affine2d map = NorthUp(edge, -edge, Spacing);
  std::vector<double> heights;
  for (int r = 0; r < Side; ++r) {
    for (int c = 0; c < Side; ++c) {
      const Eigen::Vector2d p = map * Eigen::Vector2d(c + 0.5, r + 0.5);
      heights.push_back(Before(p.x(), p.y()));
    }
  }
  return std::make_shared<GridTerrain>("slope", Side, Side, std::move(heights), map, Crs(),
                                       VerticalDatum(), Eigen::Vector2d(0.0, 0.0), -4500.0);
}

TrackAddition Straight(double sinkage = 0.06) { // along X from -5 to 5, at y = 2
  TrackAddition stroke;
  stroke.name = "wheel";
  stroke.profile.width = 0.3;
  stroke.profile.wall = 0.1;
  stroke.profile.rimWidth = 0.2;
  stroke.profile.rimHeight = 0.02;
  stroke.contacts = {{{-5.0, 2.0}, sinkage}, {{5.0, 2.0}, sinkage}};
  return stroke;
}

// Where `aside` metres from the middle of Straight(): the closed form of a rut's cross-section.
double Depth(double aside, double sinkage = 0.06) {
  if (aside <= 0.15) {
    return sinkage;
  }
  if (aside <= 0.25) {
    return sinkage * (0.25 - aside) / 0.1;
  }
  if (aside <= 0.45) {
    const double u = (aside - 0.25) / 0.2;
    return -0.02 * 4.0 * u * (1.0 - u);
  }
  return 0.0;
}

double Height(const GridTerrain& of, double x, double y) {
  return of.Sample(Eigen::Vector3d(x, y, 0.0)).height;
}

// All vertices of a mesh.
std::vector<Eigen::Vector3d> Vertices(const TerrainMesh& mesh) {
  std::vector<Eigen::Vector3d> vertices;
  for (const auto& tile : mesh.Tiles()) {
    for (std::size_t i = 0; i < tile->VertexCount(); ++i) {
      vertices.push_back(tile->origin_S + Eigen::Vector3d(tile->positions[3 * i],
                                                          tile->positions[3 * i + 1],
                                                          tile->positions[3 * i + 2]));
    }
  }
  return vertices;
}

TEST(GridTracks, HeightsNormalsAndRaysShowTheClosedForm) {
  const auto terrain = Slope();
  const std::uint64_t version = terrain->GetVersion();
  terrain->AddTracks({Straight()});
  EXPECT_NE(terrain->GetVersion(), version);
  const Eigen::Vector3d down(0.0, 0.0, -1.0);
  for (int k = -12; k <= 12; ++k) { // at posts, where ruts stand exactly
    const double y = 2.0 + k * Spacing;
    const double wanted = Before(1.0, y) - Depth(std::abs(k) * Spacing);
    EXPECT_NEAR(Height(*terrain, 1.0, y), wanted, 1e-7) << y;
    const RayHit hit = terrain->Intersect({1.0, y, 5.0}, down, 100.0);
    ASSERT_TRUE(hit.hit);
    EXPECT_NEAR(hit.position_S.z() - 4500.0, wanted, 1e-7) << y;
  }
  // On the wall the ground falls by 0.06 in 0.1 towards the middle, which is to the north.
  const Eigen::Vector3d normal = terrain->Sample(Eigen::Vector3d(1.02, 2.0 - 0.21, 0.0)).normal_S;
  EXPECT_NEAR(-normal.y() / normal.z(), 0.02 - 0.6, 1e-6);
  EXPECT_NEAR(-normal.x() / normal.z(), 0.1, 1e-6);
  // Along the rut, below the ground as it was, and onto its end.
  const RayHit along =
      terrain->Intersect({-4.0, 2.0, Before(-4.0, 2.0) + 4500.0 - 0.03}, {1.0, 0.0, 0.1}, 100.0);
  ASSERT_TRUE(along.hit);
  EXPECT_NEAR(along.position_S.x(), 5.0 + 0.15 + 0.05, 0.03); // halfway up its wall
}

TEST(GridTracks, UndisturbedAndClearedItIsTheGroundAsItWas) {
  const auto terrain = Slope();
  const std::vector<double> before = terrain->Grid().GetHeights();
  const Eigen::AlignedBox3d bounds = terrain->GetBounds().scene;
  terrain->AddTracks({Straight(0.9)});
  EXPECT_EQ(terrain->Undisturbed().Grid().GetHeights(), before);
  EXPECT_NE(terrain->Grid().GetHeights(), before);
  EXPECT_NEAR(Height(terrain->Undisturbed(), 1.0, 2.0), Before(1.0, 2.0), 1e-9);
  terrain->ClearTracks();
  EXPECT_EQ(terrain->Grid().GetHeights(), before);
  EXPECT_EQ(terrain->GetBounds().scene.min(), bounds.min());
  EXPECT_EQ(terrain->Tracks().Statistics().bytes, 0u);
  EXPECT_NEAR(terrain->Intersect({1.0, 2.0, 5.0}, {0.0, 0.0, -1.0}, 100.0).position_S.z(),
              Before(1.0, 2.0) + 4500.0, 1e-9);
}

TEST(GridTracks, ARutBelowTheLowestGroundIsHitAndWithinTheBounds) {
  const auto terrain = Slope();
  TrackAddition deep = Straight(0.9);
  deep.contacts = {{{-9.5, -9.0}, 0.9}, {{-8.0, -9.0}, 0.9}};
  terrain->AddTracks({deep});
  const RayHit hit = terrain->Intersect({-9.0, -9.0, 5.0}, {0.05, 0.0, -1.0}, 100.0);
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(hit.position_S.z(), 0.1 * hit.position_S.x() + 0.02 * -9.0 - 0.9, 1e-6);
  EXPECT_LT(terrain->GetBounds().scene.min().z(), -0.95 - 0.18 - 0.8);
}

TEST(GridTracks, NarrowRutsBetweenFarPostsAreLeftOut) {
  const auto terrain = Slope();
  TrackAddition narrow = Straight();
  narrow.profile = TrackProfile();
  narrow.profile.width = 0.01;
  narrow.profile.wall = 0.0;
  terrain->AddTracks({narrow});
  EXPECT_NEAR(Height(*terrain, 1.0, 2.0), Before(1.0, 2.0), 1e-9);
  EXPECT_GT(terrain->Tracks().Statistics().contacts, 0u);
}

TEST(GridTracks, ItAnswersLikeAClipmapOfTheSamePosts) {
  TemporaryFolder folder;
  RasterFile file;
  file.width = 201;
  file.height = 151;
  file.type = GDT_Float32;
  file.crs = "EPSG:32633";
  file.geotransform = {500000.0, 0.1, 0.0, 4200000.0, 0.0, -0.1};
  file.value = [](int c, int r, int) { return 3.0 * std::sin(0.05 * c) * std::cos(0.04 * r); };
  const std::string path = file.Write(folder / "hills.tif");
  const auto grid = GridTerrain::Load(path);
  const auto streamed = StreamedTerrain::Open(path);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<TrackAddition> additions;
  for (int n = 0; n < 6; ++n) {
    TrackAddition stroke = Straight();
    stroke.name = "wheel " + std::to_string(n);
    stroke.profile.treadPitch = 0.3;
    stroke.profile.treadDepth = 0.02;
    stroke.contacts.clear();
    Eigen::Vector2d p(8.0 * unit(random), 5.0 * unit(random));
    for (int i = 0; i < 60; ++i) {
      p += Eigen::Vector2d(0.15 * unit(random), 0.15);
      TrackContact contact;
      contact.place = p;
      contact.sinkage = 0.05 + 0.04 * unit(random);
      stroke.contacts.push_back(contact);
    }
    additions.push_back(stroke);
  }
  for (TerrainSurface* surface :
       {static_cast<TerrainSurface*>(grid.get()), static_cast<TerrainSurface*>(streamed.get())}) {
    dynamic_cast<TrackedGround&>(*surface).AddTracks(additions);
  }
  const int n = 4000;
  Rows3 points(n, 3);
  Rows3 directions(n, 3);
  for (int i = 0; i < n; ++i) {
    points.row(i) << 9.9 * unit(random), 7.4 * unit(random), 8.0;
    directions.row(i) << unit(random), unit(random), -1.5;
  }
  Eigen::VectorXd a(n);
  Eigen::VectorXd b(n);
  grid->Heights(points, a);
  streamed->Heights(points, b);
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-6); // floats of some metres
  Eigen::VectorXd bare(n);
  grid->Undisturbed().Heights(points, bare);
  EXPECT_GT((a - bare).cwiseAbs().maxCoeff(), 0.05);
  grid->Intersect(points, directions, 1e3, a);
  streamed->Intersect(points, directions, 1e3, b);
  int differ = 0;
  for (int i = 0; i < n; ++i) {
    differ += std::isinf(a[i]) != std::isinf(b[i]) ||
                      (std::isfinite(a[i]) && std::abs(a[i] - b[i]) > 2e-5)
                  ? 1
                  : 0;
  }
  EXPECT_LE(differ, 2); // rays that graze an edge
}

TEST(GridTracks, PostsBetweenPixelsLieOnTheSameTriangles) {
  TemporaryFolder folder;
  RasterFile file;
  file.width = 31;
  file.height = 21;
  file.type = GDT_Float32;
  file.crs = "EPSG:32633";
  file.noData = -9999.0;
  file.geotransform = {500000.0, 0.8, 0.0, 4200000.0, 0.0, -0.8};
  file.value = [](int c, int r, int) {
    return c == 7 && r == 9 ? -9999.0 : 3.0 * std::sin(0.5 * c) * std::cos(0.4 * r);
  };
  const std::string path = file.Write(folder / "hills.tif");
  GridTerrainOptions options;
  const auto plain = GridTerrain::Load(path, options);
  options.subdivisions = 4; // 5 cm
  const auto fine = GridTerrain::Load(path, options);
  EXPECT_EQ(fine->Grid().GetColumns(), 30 * 16 + 1);
  EXPECT_EQ(fine->Frame().GetOrigin(), plain->Frame().GetOrigin());
  StreamedTerrainOptions same;
  same.subdivisions = 4;
  const auto streamed = StreamedTerrain::Open(path, same);
  const auto heights = [](const TerrainSurface& of, const Rows3& points) {
    Eigen::VectorXd values(points.rows());
    of.Heights(points, values);
    return values;
  };
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const int n = 4000;
  Rows3 points(n, 3);
  for (int i = 0; i < n; ++i) {
    points.row(i) << 11.9 * unit(random), 7.9 * unit(random), 0.0;
  }
  const auto compare = [n](const Eigen::VectorXd& a, const Eigen::VectorXd& b, double tolerance) {
    int holes = 0;
    for (int i = 0; i < n; ++i) {
      EXPECT_EQ(std::isnan(a[i]), std::isnan(b[i])) << i;
      holes += std::isnan(a[i]) ? 1 : 0;
      EXPECT_FALSE(std::abs(a[i] - b[i]) > tolerance) << i;
    }
    EXPECT_GT(holes, 5);
  };
  compare(heights(*plain, points), heights(*fine, points), 1e-9);
  TrackAddition stroke = Straight();
  stroke.contacts = {{{-8.0, -3.0}, 0.06}, {{6.0, 4.0}, 0.08}};
  fine->AddTracks({stroke});
  streamed->AddTracks({stroke});
  compare(heights(*fine, points), heights(*streamed, points), 1e-6);
  EXPECT_GT((heights(*fine, points) - heights(*plain, points))
                .array()
                .isNaN()
                .select(0.0, heights(*fine, points) - heights(*plain, points))
                .cwiseAbs()
                .maxCoeff(),
            0.05);
  options.subdivisions = 13;
  EXPECT_THROW(GridTerrain::Load(path, options), Error);
  options.subdivisions = 9;
  options.maximumPosts = 100000;
  EXPECT_THROW(GridTerrain::Load(path, options), Error);
}

TEST(GridTracks, TheMeshShowsEveryPostThatARutReaches) {
  const auto terrain = Slope();
  TerrainMeshOptions options;
  options.triangleBudget = 2000; // a plane needs few
  TerrainMesh mesh(terrain, options);
  const std::size_t bare = mesh.Report().triangles;
  const auto tiles = mesh.Tiles();
  terrain->AddTracks({Straight()});
  const std::vector<std::size_t> changed = mesh.FollowTracks(terrain->TakeChanges());
  EXPECT_TRUE(terrain->TakeChanges().empty());
  EXPECT_GT(mesh.Report().triangles, bare + 2 * 200 * 12);
  EXPECT_TRUE(mesh.Report().budgetMet);
  EXPECT_LT(mesh.Report().verticalError, 1e-6);
  EXPECT_LT(changed.size(), tiles.size() / 2);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const bool same = mesh.Tiles()[i] == tiles[i];
    EXPECT_EQ(same, std::find(changed.begin(), changed.end(), i) == changed.end()) << i;
  }
  // Each post of the rut is a vertex at its place, and so is no other height.
  int floor = 0;
  for (const Eigen::Vector3d& v : Vertices(mesh)) {
    EXPECT_NEAR(v.z() - 4500.0, Height(*terrain, v.x(), v.y()), 1e-6);
    floor += std::abs(v.x()) < 4.99 && std::abs(v.y() - 2.0) < 0.16 ? 1 : 0;
  }
  EXPECT_GE(floor, 199 * 7);
  // Tiles carry what was rolled over.
  int rolled = 0;
  for (const auto& tile : mesh.Tiles()) {
    EXPECT_TRUE(tile->rolled.empty() || tile->rolled.size() == tile->VertexCount());
    for (const float share : tile->rolled) {
      rolled += share == 1.0f ? 1 : 0;
    }
  }
  EXPECT_GE(rolled, 199 * 7);
  terrain->ClearTracks();
  mesh.FollowTracks(terrain->TakeChanges());
  ASSERT_EQ(mesh.Tiles().size(), tiles.size());
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    EXPECT_EQ(mesh.Tiles()[i]->id, tiles[i]->id);
    EXPECT_EQ(mesh.Tiles()[i]->positions, tiles[i]->positions);
    EXPECT_EQ(mesh.Tiles()[i]->normals, tiles[i]->normals);
    EXPECT_TRUE(mesh.Tiles()[i]->rolled.empty());
  }
}

TEST(GridTracks, TheMeshDependsOnTheTracksAndNotOnTheirHistory) {
  const auto one = Slope();
  const auto two = Slope();
  TerrainMesh stepwise(one);
  for (int i = 0; i <= 100; ++i) { // a contact at a time
    TrackAddition step = Straight();
    step.contacts = {{{-5.0 + 0.1 * i, 2.0 + 0.5 * std::sin(0.1 * i)}, 0.06}};
    one->AddTracks({step});
    stepwise.FollowTracks(one->TakeChanges());
  }
  two->RestoreTracks(one->Tracks().Strokes());
  const TerrainMesh at_once(two);
  EXPECT_EQ(one->Grid().GetHeights(), two->Grid().GetHeights());
  ASSERT_EQ(stepwise.Tiles().size(), at_once.Tiles().size());
  for (std::size_t i = 0; i < stepwise.Tiles().size(); ++i) {
    EXPECT_EQ(stepwise.Tiles()[i]->id, at_once.Tiles()[i]->id) << i;
    EXPECT_EQ(stepwise.Tiles()[i]->positions, at_once.Tiles()[i]->positions) << i;
    EXPECT_EQ(stepwise.Tiles()[i]->normals, at_once.Tiles()[i]->normals) << i;
    EXPECT_EQ(stepwise.Tiles()[i]->indices, at_once.Tiles()[i]->indices) << i;
    EXPECT_EQ(stepwise.Tiles()[i]->rolled, at_once.Tiles()[i]->rolled) << i;
  }
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d from(6.0 * unit(random), 2.0 + unit(random), 3.0);
    const Eigen::Vector3d way(unit(random), unit(random), -1.0);
    EXPECT_EQ(one->Intersect(from, way).distance, two->Intersect(from, way).distance);
  }
}

TEST(GridTracks, HolesStayAndWhatIsRejectedChangesNothing) {
  const auto terrain = std::make_shared<GridTerrain>(
      "holed", 3, 3, std::vector<double>{0, 0, 0, 0, std::nan(""), 0, 0, 0, 0},
      NorthUp(-1.5, 1.5, 1.0));
  TrackAddition stroke = Straight();
  stroke.contacts = {{{-1.0, 0.0}, 0.1}, {{1.0, 0.0}, 0.1}};
  terrain->AddTracks({stroke});
  EXPECT_FALSE(terrain->Grid().HasPost(1, 1));
  EXPECT_LT(terrain->Rolled(1, 1), 0.0f);
  EXPECT_NEAR(terrain->Grid().At(0, 1), -0.1, 1e-7);
  const std::vector<double> before = terrain->Grid().GetHeights();
  stroke.contacts[0].sinkage = 2.0;
  EXPECT_THROW(terrain->AddTracks({stroke}), Error);
  EXPECT_EQ(terrain->Grid().At(0, 1), before[3]);
  WheelTracksOptions least;
  least.byteBudget = 1000;
  EXPECT_THROW(GridTerrain("least", 2, 2, {0, 0, 0, 0}, NorthUp(0.0, 0.0, 1.0), Crs(),
                           VerticalDatum(), std::nullopt, 0.0, {}, least),
               Error);
}

} // namespace
