// The drawn triangles: no cracks, holes kept, zones exact, errors as claimed, little rebuilt.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/mesh/TerrainMesh.h>

#include "Grids.h"
#include "TestData.h"

namespace {

using dspace::Error;
using dspace::GridTerrain;
using dspace::HeightGrid;
using dspace::TerrainMesh;
using dspace::TerrainMeshOptions;
using dspace::TerrainTile;
using dspace::TerrainZone;
using dspace::testing::NorthUp;
using dspace::testing::Rough;
using dspace::testing::Sampled;

using Post = std::array<int, 2>;
using Edge = std::pair<Post, Post>;

struct Drawn {
  std::array<Eigen::Vector3d, 3> p_S;
  std::array<Post, 3> post;
};

// All triangles of a mesh with their posts, found from positions alone. One place, to the last bit,
// must stand for each post.
std::vector<Drawn> Triangles(const TerrainMesh& mesh) {
  const HeightGrid& grid = mesh.Terrain().Grid();
  std::vector<Drawn> all;
  std::map<Post, Eigen::Vector3d> places;
  for (const auto& tile : mesh.Tiles())
    for (std::size_t t = 0; t < tile->TriangleCount(); ++t) {
      Drawn drawn;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = tile->indices[3 * t + k];
        EXPECT_LT(v, tile->VertexCount());
        const float* p = tile->positions.data() + 3 * v;
        drawn.p_S[k] = tile->origin_S + Eigen::Vector3d(p[0], p[1], p[2]);
        const Eigen::Vector2d g = grid.ToGrid(drawn.p_S[k].head<2>());
        drawn.post[k] = {static_cast<int>(std::lround(g.x())),
                         static_cast<int>(std::lround(g.y()))};
        const auto [place, isNew] = places.emplace(drawn.post[k], drawn.p_S[k]);
        EXPECT_TRUE(isNew || place->second == drawn.p_S[k]) << "tiles disagree about a post";
      }
      all.push_back(drawn);
    }
  return all;
}

// Edges of the full-resolution grid that belong to one triangle: the border, and rims of holes.
std::set<Edge> RimOf(const HeightGrid& grid) {
  std::map<Edge, int> count;
  const auto add = [&](Post a, Post b) { ++count[{std::min(a, b), std::max(a, b)}]; };
  for (int r = 0; r < grid.GetRows() - 1; ++r)
    for (int c = 0; c < grid.GetColumns() - 1; ++c) {
      const Post nw{c, r}, ne{c + 1, r}, sw{c, r + 1}, se{c + 1, r + 1};
      if (grid.HasA(c, r)) {
        add(nw, sw);
        add(sw, se);
        add(nw, se);
      }
      if (grid.HasB(c, r)) {
        add(nw, ne);
        add(ne, se);
        add(nw, se);
      }
    }
  std::set<Edge> rim;
  for (const auto& [edge, n] : count)
    if (n == 1)
      rim.insert(edge);
  return rim;
}

// Each edge is shared by exactly two triangles that run it in opposite ways, or lies on the rim;
// together the triangles cover what has data, once, all facing up.
void ExpectNoCracks(const TerrainMesh& mesh) {
  const HeightGrid& grid = mesh.Terrain().Grid();
  const std::vector<Drawn> triangles = Triangles(mesh);
  EXPECT_EQ(triangles.size(), mesh.Report().triangles);
  std::map<std::pair<Post, Post>, int> directed;
  long long doubledArea = 0;
  int downward = 0;
  for (const Drawn& t : triangles) {
    for (int k = 0; k < 3; ++k)
      ++directed[{t.post[k], t.post[(k + 1) % 3]}];
    const Post a = t.post[0], b = t.post[1], c = t.post[2];
    doubledArea += std::abs(static_cast<long long>(b[0] - a[0]) * (c[1] - a[1]) -
                            static_cast<long long>(c[0] - a[0]) * (b[1] - a[1]));
    const Eigen::Vector3d n = (t.p_S[1] - t.p_S[0]).cross(t.p_S[2] - t.p_S[0]);
    downward += !(n.z() > 0.0);
  }
  EXPECT_EQ(downward, 0);
  long long expectedArea = 0;
  for (int r = 0; r < grid.GetRows() - 1; ++r)
    for (int c = 0; c < grid.GetColumns() - 1; ++c)
      expectedArea += grid.HasA(c, r) + grid.HasB(c, r);
  EXPECT_EQ(doubledArea, expectedArea);
  const std::set<Edge> rim = RimOf(grid);
  int twice = 0, cracks = 0;
  for (const auto& [edge, count] : directed) {
    twice += count != 1;
    const auto [a, b] = edge;
    if (directed.count({b, a}))
      continue;
    // Alone: every unit of it must be rim.
    const int n = std::gcd(b[0] - a[0], b[1] - a[1]);
    const int dc = (b[0] - a[0]) / n, dr = (b[1] - a[1]) / n;
    for (int i = 0; i < n; ++i) {
      const Post p{a[0] + i * dc, a[1] + i * dr}, q{p[0] + dc, p[1] + dr};
      cracks += !rim.count({std::min(p, q), std::max(p, q)});
    }
  }
  EXPECT_EQ(twice, 0);
  EXPECT_EQ(cracks, 0);
}

// The claim against the greatest difference found at random points of every triangle and at its
// corners; a claim far above it would be no claim.
void ExpectErrorAsClaimed(const TerrainMesh& mesh) {
  const GridTerrain& terrain = mesh.Terrain();
  const double rounding = mesh.Report().roundingZ + 10.0 * mesh.Report().roundingXY;
  std::mt19937 random(31);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double measured = 0.0;
  for (const Drawn& t : Triangles(mesh))
    for (int i = 0; i < 40; ++i) {
      double u = unit(random), v = unit(random);
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const Eigen::Vector3d p = t.p_S[0] + u * (t.p_S[1] - t.p_S[0]) + v * (t.p_S[2] - t.p_S[0]);
      const dspace::SurfaceSample sample = terrain.Sample(p);
      if (sample.valid)
        measured = std::max(measured, std::abs(p.z() - sample.position_S.z()));
    }
  EXPECT_LE(measured, mesh.Report().verticalError + rounding);
  EXPECT_GE(measured + rounding, 0.7 * mesh.Report().verticalError);
}

// Random points of a zone: the drawn triangle is the grid's, and at its height.
int ExpectZoneIsExact(const TerrainMesh& mesh, const TerrainZone& zone) {
  const GridTerrain& terrain = mesh.Terrain();
  const HeightGrid& grid = terrain.Grid();
  std::set<std::set<Post>> cells;
  const std::vector<Drawn> triangles = Triangles(mesh);
  for (const Drawn& t : triangles)
    cells.insert({t.post[0], t.post[1], t.post[2]});
  std::mt19937 random(17);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int checked = 0;
  for (std::size_t leg = 0; leg < zone.path_S.size(); ++leg)
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector2d a = zone.path_S[leg],
                            b = zone.path_S[std::max<std::size_t>(leg, 1) - 1];
      const double angle = 2.0 * M_PI * unit(random), r = zone.radius * std::sqrt(unit(random));
      const Eigen::Vector2d xy =
          a + unit(random) * (b - a) + r * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      if (!terrain.Sample({xy.x(), xy.y(), 0.0}).valid)
        continue;
      const Eigen::Vector2d g = grid.ToGrid(xy);
      const int c = std::min(static_cast<int>(g.x()), grid.GetColumns() - 2);
      const int rr = std::min(static_cast<int>(g.y()), grid.GetRows() - 2);
      const bool below = g.y() - rr > g.x() - c;
      const Post third = below ? Post{c, rr + 1} : Post{c + 1, rr};
      EXPECT_TRUE(cells.count({Post{c, rr}, Post{c + 1, rr + 1}, third})) << xy.transpose();
      ++checked;
    }
  double worst = 0.0;
  for (const Drawn& t : triangles)
    for (int k = 0; k < 3; ++k)
      worst = std::max(worst, std::abs(t.p_S[k].z() + terrain.Frame().GetOriginHeight() -
                                       grid.At(t.post[k][0], t.post[k][1])));
  EXPECT_LE(worst, mesh.Report().roundingZ * (1.0 + 1e-9));
  return checked;
}

TerrainMeshOptions Budget(std::size_t triangles, int tileCells = 0) {
  TerrainMeshOptions options;
  options.triangleBudget = triangles;
  options.tileCells = tileCells;
  return options;
}

// How many places in the zone were looked at.
int CheckAll(const std::shared_ptr<const GridTerrain>& terrain, std::size_t budget, int cells,
             double radius) {
  TerrainMesh mesh(terrain, Budget(budget, cells));
  ExpectNoCracks(mesh);
  ExpectErrorAsClaimed(mesh);
  EXPECT_EQ(mesh.Report().budgetMet, mesh.Report().triangles <= budget);
  const Eigen::AlignedBox3d box = terrain->GetBounds().scene;
  const TerrainZone zone{{box.center().head<2>() + 0.2 * box.sizes().head<2>()}, radius};
  mesh.SetZones({zone});
  ExpectNoCracks(mesh);
  ExpectErrorAsClaimed(mesh);
  return ExpectZoneIsExact(mesh, zone);
}

} // namespace

TEST(TerrainMesh, RandomGridsOfAllSizes) {
  for (const auto& [columns, rows] : {std::pair{2, 2}, {9, 9}, {33, 33}, {34, 65}, {100, 37}})
    CheckAll(Rough(columns, rows, 100u + columns), columns * rows / 3, 8, 3.0);
  EXPECT_GT(CheckAll(Rough(70, 70, 5), 1, 32, 4.0), 250); // a budget that cannot be met
}

TEST(TerrainMesh, HolesStayHoles) {
  EXPECT_GT(CheckAll(Rough(65, 65, 41, 0.01), 3000, 16, 4.0), 250);
  CheckAll(Rough(40, 50, 42, 0.3), 3000, 16, 4.0);
  // A large hole with whole tiles in it.
  const auto rough = Rough(129, 129, 43);
  std::vector<double> heights = rough->Grid().GetHeights();
  for (int r = 20; r < 90; ++r)
    for (int c = 30; c < 110; ++c)
      heights[r * 129 + c] = std::numeric_limits<double>::quiet_NaN();
  const auto holed = std::make_shared<GridTerrain>("holed", 129, 129, heights, NorthUp(0., 0., 1.));
  CheckAll(holed, 4000, 16, 5.0);
  const TerrainMesh mesh(holed, Budget(4000, 16));
  int empty = 0;
  for (const auto& tile : mesh.Tiles())
    empty += tile->id == 0 && tile->TriangleCount() == 0 && tile->bounds_S.isEmpty();
  EXPECT_GT(empty, 4);
}

TEST(TerrainMesh, SouthUpAndRotatedGridsFaceUp) {
  const auto rough = Rough(40, 30, 51);
  Eigen::Affine2d southUp = Eigen::Affine2d::Identity();
  southUp.linear() << 2.0, 0.0, 0.0, 2.0;
  CheckAll(std::make_shared<GridTerrain>("south-up", 40, 30, rough->Grid().GetHeights(), southUp),
           700, 8, 6.0);
  Eigen::Affine2d rotated = Eigen::Affine2d::Identity();
  rotated.linear() =
      Eigen::Rotation2Dd(0.9).toRotationMatrix() * Eigen::Vector2d(2.0, -5.0).asDiagonal();
  CheckAll(std::make_shared<GridTerrain>("rotated", 40, 30, rough->Grid().GetHeights(), rotated),
           700, 8, 12.0);
}

TEST(TerrainMesh, FullBudgetDrawsTheGridItself) {
  const auto terrain = Rough(50, 40, 61);
  const TerrainMesh mesh(terrain, Budget(1000000));
  EXPECT_EQ(mesh.Report().triangles, 2u * 49 * 39);
  EXPECT_EQ(mesh.Report().verticalError, 0.0);
}

TEST(TerrainMesh, PlaneNeedsNoTrianglesToBeRight) {
  const auto plane = Sampled(129, 129, NorthUp(0.0, 129.0, 1.0),
                             [](const Eigen::Vector2d& m) { return 0.25 * m.x() + 0.5 * m.y(); });
  TerrainMeshOptions options = Budget(200, 16);
  const TerrainMesh mesh(plane, options);
  EXPECT_EQ(mesh.Report().triangles, 2u * 8 * 8);
  EXPECT_LT(mesh.Report().verticalError, 1e-12);
  const Eigen::Vector3d normal = Eigen::Vector3d(-0.25, -0.5, 1.0).normalized();
  for (const auto& tile : mesh.Tiles())
    for (std::size_t v = 0; v < tile->VertexCount(); ++v) {
      const Eigen::Vector3f n(tile->normals[3 * v], tile->normals[3 * v + 1],
                              tile->normals[3 * v + 2]);
      EXPECT_LT((n.cast<double>() - normal).norm(), 1e-6);
      // Post (c, r) is at x = c - 64, y = 64 - r around the middle; its texture coordinate is the
      // middle of its pixel, v from the bottom.
      const double x = tile->origin_S.x() + tile->positions[3 * v];
      const double y = tile->origin_S.y() + tile->positions[3 * v + 1];
      EXPECT_NEAR(tile->tcoords[2 * v], (x + 64.5) / 129.0, 1e-6);
      EXPECT_NEAR(tile->tcoords[2 * v + 1], (y + 64.5) / 129.0, 1e-6);
      EXPECT_TRUE(tile->bounds_S.contains(
          tile->origin_S + Eigen::Vector3d(tile->positions[3 * v], tile->positions[3 * v + 1],
                                           tile->positions[3 * v + 2])));
    }
}

TEST(TerrainMesh, MovingRebuildsOnlyWhatChanges) {
  const auto terrain = Rough(513, 513, 71); // 358 m
  TerrainMesh mesh(terrain, Budget(60000, 32));
  const double radius = 8.0;
  std::size_t most = 0;
  for (int step = 0; step <= 40; ++step) {
    const Eigen::Vector2d at(-80.0 + 4.0 * step, 30.0);
    const auto before = mesh.Tiles();
    const std::vector<std::size_t> changed = mesh.SetZones({{{at}, radius}});
    const std::set<std::size_t> named(changed.begin(), changed.end());
    for (std::size_t i = 0; i < before.size(); ++i)
      EXPECT_EQ(before[i] != mesh.Tiles()[i], named.count(i) == 1) << i;
    if (step > 0)
      most = std::max(most, changed.size());
    EXPECT_TRUE(mesh.Report().budgetMet);
    // Nearly the same place: nothing to do.
    EXPECT_TRUE(mesh.SetZones({{{at + Eigen::Vector2d(1e-6, 0.0)}, radius}}).size() <= 9u);
  }
  EXPECT_GT(most, 0u);
  EXPECT_LE(most, 25u); // of 256
  // The last place from scratch gives the same tiles, array for array.
  TerrainMesh fresh(terrain, Budget(60000, 32));
  fresh.SetZones({{{Eigen::Vector2d(80.0, 30.0)}, radius}});
  mesh.SetZones({{{Eigen::Vector2d(80.0, 30.0)}, radius}});
  for (std::size_t i = 0; i < fresh.Tiles().size(); ++i) {
    const TerrainTile &a = *fresh.Tiles()[i], &b = *mesh.Tiles()[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.indices, b.indices);
  }
  // Without zones it is as at first.
  mesh.SetZones({});
  const TerrainMesh first(terrain, Budget(60000, 32));
  for (std::size_t i = 0; i < first.Tiles().size(); ++i)
    EXPECT_EQ(first.Tiles()[i]->id, mesh.Tiles()[i]->id);
  EXPECT_TRUE(mesh.SetZones({}).empty());
}

TEST(TerrainMesh, APathIsExactAllAlong) {
  const auto terrain = Rough(300, 200, 81);
  TerrainMesh mesh(terrain, Budget(40000));
  const TerrainZone path{{{-90.0, -50.0}, {-20.0, 40.0}, {70.0, 10.0}, {1e7, 0.0}}, 2.0};
  mesh.SetZones({path, {{{95.0, -60.0}}, 5.0}});
  ExpectNoCracks(mesh);
  EXPECT_GT(ExpectZoneIsExact(mesh, {{path.path_S[0], path.path_S[1], path.path_S[2]}, 2.0}), 800);
  EXPECT_EQ(ExpectZoneIsExact(mesh, {{{95.0, -60.0}}, 5.0}), 300);
}

TEST(TerrainMesh, RejectsBadArguments) {
  const auto terrain = Rough(30, 30, 91);
  EXPECT_THROW(TerrainMesh(nullptr), Error);
  EXPECT_THROW(TerrainMesh(terrain, Budget(0)), Error);
  for (int cells : {-8, 4, 12, 2048})
    EXPECT_THROW(TerrainMesh(terrain, Budget(100, cells)), Error);
  TerrainMeshOptions options;
  options.zoneShare = 1.0;
  EXPECT_THROW(TerrainMesh(terrain, options), Error);
  TerrainMesh mesh(terrain, Budget(300, 8));
  mesh.SetZones({{{Eigen::Vector2d(1.0, 1.0)}, 2.0}});
  const auto before = mesh.Tiles();
  EXPECT_THROW(mesh.SetZones({{{}, 2.0}}), Error);
  EXPECT_THROW(mesh.SetZones({{{Eigen::Vector2d(0.0, 0.0)}, 0.0}}), Error);
  EXPECT_THROW(mesh.SetZones({{{Eigen::Vector2d(0.0, NAN)}, 1.0}}), Error);
  EXPECT_EQ(before, mesh.Tiles());
}

TEST(TerrainMesh, RealGround) {
  struct Case {
    const char* file;
    std::size_t budget;
    double radius;
  };
  for (const Case& c : {Case{"terrain/mars_gale_mola_128ppd_m.tif", 60000, 5000.0},
                        {"terrain/earth_sfbay_200x125.tif", 5000, 5000.0},
                        {"terrain/moon_npole_stereo_33.tif", 600, 8.0},
                        {"terrain/earth_california_ned_1arcsec_129.tif", 8000, 200.0}}) {
    DSPACE_REAL_DATA(path, c.file);
    SCOPED_TRACE(c.file);
    const auto terrain = GridTerrain::Load(path);
    EXPECT_GT(CheckAll(terrain, c.budget, 0, c.radius), 250);
    const TerrainMesh mesh(terrain, Budget(c.budget));
    EXPECT_TRUE(mesh.Report().budgetMet);
    EXPECT_GT(mesh.Report().triangles, c.budget / 2);
  }
}

TEST(TerrainMesh, AWheelOnApolloGroundStandsWhereItIsDrawn) {
  DSPACE_REAL_DATA(path, "terrain/moon_apollo15_nac_dtm_257.png");
  dspace::GridTerrainOptions options;
  options.elevation.verticalScale = 49.0 / 255.0;
  options.elevation.pixelSize = 2.0;
  const auto terrain = GridTerrain::Load(path, options);
  TerrainMesh mesh(terrain, Budget(20000));
  mesh.SetZones({{{Eigen::Vector2d(40.0, -30.0)}, 15.0}});
  EXPECT_LT(mesh.Report().roundingXY, 1e-3);
  EXPECT_LT(mesh.Report().roundingZ, 1e-4);
  EXPECT_EQ(ExpectZoneIsExact(mesh, {{Eigen::Vector2d(40.0, -30.0)}, 15.0}), 300);
}

TEST(MeshQuadtree, ErrorOfAFanByHand) {
  // 3 x 3 posts as one square of level 1: west and south middles 1, all else 0. A fan with both as
  // vertices meets every post; in the south-western cell its spoke runs across the grid's diagonal,
  // on 0 where the grid is at 1.
  const std::vector<double> heights = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  const HeightGrid grid("fan", 3, 3, heights, Eigen::Affine2d::Identity());
  const dspace::MeshQuadtree tree(grid, 1);
  EXPECT_DOUBLE_EQ(tree.LeafError({1, 0, 0, 1 | 2}), 1.0);
  EXPECT_DOUBLE_EQ(tree.LeafError({1, 0, 0, 2}), 1.0); // the west middle itself is missed
  EXPECT_DOUBLE_EQ(tree.LeafError({1, 0, 0, 0}), 1.0);
  EXPECT_DOUBLE_EQ(tree.LeafError({0, 0, 0, 0}), 0.0);
  EXPECT_GE(tree.GetGreatestError(), 1.0);
}
