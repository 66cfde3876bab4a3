// Rays against brute force over all triangles, and against rays that must not slip through.
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include <dspace/surface/GridTerrain.h>

#include "Grids.h"
#include "TestData.h"

namespace {

using dspace::GridTerrain;
using dspace::RayHit;
using dspace::testing::NorthUp;
using dspace::testing::Rough;

struct Brute {
  double distance = std::numeric_limits<double>::infinity();
  bool nearBorder = false; // within 1e-9 of an edge of the mesh, where rounding may decide
};

// Every triangle of the grid, two-sided (Moller and Trumbore 1997).
Brute BruteForce(const GridTerrain& terrain, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
  const dspace::HeightGrid& g = terrain.Grid();
  Brute best;
  const auto post = [&](int c, int r) {
    Eigen::Vector3d p;
    p << g.ToScene(Eigen::Vector2d(c, r)), g.At(c, r) - terrain.Frame().GetOriginHeight();
    return p;
  };
  const auto test = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c) {
    const Eigen::Vector3d e1 = b - a, e2 = c - a, p = d.cross(e2);
    const double det = e1.dot(p);
    if (det == 0.0)
      return;
    const Eigen::Vector3d s = o - a, q = s.cross(e1);
    const double u = s.dot(p) / det, v = d.dot(q) / det, t = e2.dot(q) / det;
    const double least = std::min({u, v, 1.0 - u - v});
    if (least >= -1e-9 && t >= 0.0 && t < best.distance) {
      best.distance = t;
      best.nearBorder = least < 1e-9;
    }
  };
  for (int r = 0; r < g.GetRows() - 1; ++r)
    for (int c = 0; c < g.GetColumns() - 1; ++c) {
      if (g.HasA(c, r))
        test(post(c, r), post(c, r + 1), post(c + 1, r + 1));
      if (g.HasB(c, r))
        test(post(c, r), post(c + 1, r + 1), post(c + 1, r));
    }
  return best;
}

// Random rays through the terrain's box, steep and grazing, from above, below and aside.
void Compare(const GridTerrain& terrain, int rays, unsigned seed) {
  const Eigen::AlignedBox3d box = terrain.GetBounds().scene;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int hits = 0, misses = 0;
  for (int i = 0; i < rays; ++i) {
    const auto inBox = [&](double grow) {
      Eigen::Vector3d p;
      for (int k = 0; k < 3; ++k)
        p[k] = box.center()[k] + grow * (unit(random) - 0.5) * box.sizes()[k];
      return p;
    };
    const Eigen::Vector3d o = inBox(i % 3 == 0 ? 40.0 : i % 3 == 1 ? 2.0 : 1.0);
    Eigen::Vector3d d = inBox(1.0) - o;
    if (i % 4 == 0)
      d.z() *= 0.02; // grazing
    d.normalize();
    const Brute brute = BruteForce(terrain, o, d);
    const RayHit hit = terrain.Intersect(o, d);
    if (brute.nearBorder && !hit.hit)
      continue; // the rim of the mesh or of a hole
    ASSERT_EQ(hit.hit, std::isfinite(brute.distance)) << "ray " << i;
    hits += hit.hit;
    misses += !hit.hit;
    if (!hit.hit) {
      EXPECT_TRUE(std::isinf(hit.distance));
      continue;
    }
    // Where a ray runs along the ground a little error in height is a long way: compare heights.
    const double tolerance = 1e-9 * (1.0 + box.sizes().norm());
    const Eigen::Vector3d at = o + hit.distance * d;
    EXPECT_NEAR(at.z(), (o + brute.distance * d).z(), tolerance) << "ray " << i;
    EXPECT_LT(std::abs(hit.distance - brute.distance) * std::max(std::abs(d.z()), 1e-6), tolerance);
    EXPECT_LT((hit.position_S - at).norm(), tolerance);
    EXPECT_NEAR(hit.normal_S.norm(), 1.0, 1e-12);
    EXPECT_GT(hit.normal_S.z(), 0.0);
    if (std::abs(hit.normal_S.dot(d)) > 1e-6) {
      EXPECT_EQ(hit.fromBelow, hit.normal_S.dot(d) > 0.0) << "ray " << i;
    }
  }
  EXPECT_GT(hits, rays / 20);
  EXPECT_GT(misses, rays / 50);
}

} // namespace

TEST(GridRay, EqualsBruteForceOnRandomGrids) {
  Compare(*Rough(33, 21, 11), 1500, 1);
  Compare(*Rough(40, 40, 12, 0.1), 1000, 2); // holes
  Compare(*Rough(2, 2, 13), 1000, 3);
  Compare(*Rough(7, 50, 14), 2000, 4);
}

TEST(GridRay, EqualsBruteForceOnRotatedGrids) {
  Eigen::Affine2d m = NorthUp(0.0, 0.0, 1.0);
  m.linear() = Eigen::Rotation2Dd(0.4).toRotationMatrix() * Eigen::Vector2d(1.0, 3.0).asDiagonal();
  const auto rough = Rough(25, 19, 15);
  const GridTerrain terrain("rotated", 25, 19, rough->Grid().GetHeights(), m);
  Compare(terrain, 1500, 5);
}

TEST(GridRay, EqualsBruteForceOnRealGround) {
  DSPACE_REAL_DATA(path, "terrain/earth_california_ned_1arcsec_129.tif");
  Compare(*GridTerrain::Load(path), 200, 6);
}

TEST(GridRay, NothingSlipsThroughEdgesAndPosts) {
  const auto terrain = Rough(33, 33, 21);
  const dspace::HeightGrid& g = terrain->Grid();
  std::mt19937 random(22);
  std::uniform_int_distribution<int> post(0, 32), part(0, 4);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  // Down through posts, edges and diagonals, tilted so as to run along them or not.
  for (int i = 0; i < 20000; ++i) {
    Eigen::Vector2d to(post(random), post(random));
    const double f = unit(random);
    if (i % 4 == 1)
      to.x() = std::min(to.x() + f, 32.0);
    else if (i % 4 == 2)
      to.y() = std::min(to.y() + f, 32.0);
    else if (i % 4 == 3 && to.x() < 32.0 && to.y() < 32.0)
      to += Eigen::Vector2d(f, f);
    const auto facet = g.FacetAt(to);
    Eigen::Vector3d target;
    target << g.ToScene(to), facet.height;
    const int way = part(random);
    Eigen::Vector2d from(post(random), post(random));
    if (way == 0)
      from = to;
    else if (way == 1)
      from.x() = to.x();
    else if (way == 2)
      from.y() = to.y();
    Eigen::Vector3d o;
    o << g.ToScene(from), 100.0;
    const Eigen::Vector3d d = target - o;
    const RayHit hit = terrain->Intersect(o, d);
    ASSERT_TRUE(hit.hit) << i << ": " << from.transpose() << " to " << to.transpose();
    EXPECT_FALSE(hit.fromBelow);
    EXPECT_LT(hit.distance, d.norm() + 1e-9);
    EXPECT_NEAR(terrain->Sample(hit.position_S).position_S.z(), hit.position_S.z(), 1e-9);
  }
}

TEST(GridRay, AGrazedRidgeIsHit) {
  // A ridge of height 8 along the middle row over flat ground: exact in binary, as are the rays.
  std::vector<double> heights(17 * 17, 0.0);
  for (int c = 0; c < 17; ++c)
    heights[8 * 17 + c] = 8.0;
  const GridTerrain terrain("ridge", 17, 17, heights, NorthUp(-0.5, 16.5, 1.0));
  for (double x = -8.0; x <= 8.0; x += 0.125) {
    const RayHit touch = terrain.Intersect({x, -8.0, 8.0}, {0.0, 1.0, 0.0});
    ASSERT_TRUE(touch.hit) << x;
    EXPECT_EQ(touch.distance, 8.0);
    EXPECT_FALSE(terrain.Intersect({x, -8.0, 8.0 + 1e-9}, {0.0, 1.0, 0.0}).hit) << x;
    EXPECT_TRUE(terrain.Intersect({x, -8.0, 8.0 - 1e-9}, {0.0, 1.0, 0.0}).hit) << x;
    EXPECT_TRUE(terrain.Intersect({x, -8.0, 0.0}, {0.0, 1.0, 0.0}).hit) << x; // along the ground
  }
  EXPECT_TRUE(terrain.Intersect({-8.0, 0.0, 8.0}, {1.0, 0.0, 0.0}).hit); // along the ridge
}

TEST(GridRay, DistancesAreMetresWithinTheLimit) {
  const GridTerrain flat("flat", 3, 3, std::vector<double>(9, 2.0), NorthUp(-1.5, 1.5, 1.0));
  const RayHit hit = flat.Intersect({0.2, 0.3, 12.0}, {0.0, 0.0, -7.0});
  EXPECT_TRUE(hit.hit);
  EXPECT_EQ(hit.distance, 10.0);
  EXPECT_TRUE(flat.Intersect({0.2, 0.3, 12.0}, {0.0, 0.0, -7.0}, 10.0).hit);
  EXPECT_FALSE(flat.Intersect({0.2, 0.3, 12.0}, {0.0, 0.0, -7.0}, 9.999).hit);
  EXPECT_TRUE(flat.Intersect({0.2, 0.3, 1.0}, {0.0, 0.0, 1.0}).fromBelow);
  EXPECT_FALSE(flat.Intersect({0.2, 0.3, 1.0}, {0.0, 0.0, -1.0}).hit);
  const RayHit slanted = flat.Intersect({-0.5, 0.1, 2.5}, {1.0, 0.0, -1.0}, 0.70710679);
  EXPECT_TRUE(slanted.hit);
  EXPECT_NEAR(slanted.distance, std::sqrt(0.5), 1e-12);
  EXPECT_FALSE(flat.Intersect({-0.5, 0.1, 2.5}, {1.0, 0.0, -1.0}, 0.707).hit);
  // From as far as the Moon's orbit: the crossing is right to the rounding of the origin.
  const Eigen::Vector3d far(4e8, 3e8, 2e8), target(0.25, -0.5, 2.0);
  const RayHit distant = flat.Intersect(far, target - far);
  ASSERT_TRUE(distant.hit);
  EXPECT_LT((distant.position_S - target).norm(), 1e-6);
  dspace::Rows3 origins(2, 3), directions(2, 3);
  origins << 0.2, 0.3, 12.0, 5.0, 5.0, 12.0;
  directions << 0.0, 0.0, -1.0, 0.0, 0.0, -1.0;
  Eigen::VectorXd distances(2);
  flat.Intersect(origins, directions, 100.0, distances);
  EXPECT_EQ(distances[0], 10.0);
  EXPECT_TRUE(std::isinf(distances[1]));
}
