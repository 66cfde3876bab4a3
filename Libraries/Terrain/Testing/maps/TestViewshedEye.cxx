// What an eye sees, whatever it looked at before.
#include <cmath>

#include <gtest/gtest.h>

#include <dspace/horizon/HeldPosts.h>
#include <dspace/maps/ViewshedEye.h>

#include "FormulaPosts.h"
#include "Grids.h"
#include "MapTestSupport.h"

namespace dspace::testing {
namespace {

constexpr double Everywhere = std::numeric_limits<double>::infinity();

// Of every cell: the least height is the same after other lines as alone, and a target is seen from
// that height on.
void ExpectOneAnswer(const MapGround& ground, const ViewshedObserver& observer, int every) {
  const auto held = HeldPosts::Read(*ground.pyramid, 1, 1, {});
  const ViewshedEye eye(ground, *held, observer);
  ASSERT_TRUE(eye.HasGround());
  const PostLattice& lattice = ground.pyramid->Lattice();
  ViewshedEye::Memory running;
  ViewshedEye::Memory looking;
  int hidden = 0;
  int seen = 0;
  for (int r = 0; r < lattice.rows; r += every) {
    for (int c = 0; c < lattice.columns; c += every) {
      const Eigen::Vector2d to(c, r);
      ViewshedEye::Memory fresh;
      const double alone = eye.Least(to, Everywhere, fresh);
      const double least = eye.Least(to, Everywhere, running);
      ASSERT_FALSE(std::isnan(alone));
      if (std::isinf(alone)) {
        EXPECT_EQ(least, alone);
        continue;
      }
      EXPECT_NEAR(least, alone, 1e-9 * (1.0 + alone)) << c << ", " << r;
      for (const double target : {0.0, 0.5 * least, 0.999 * least, 1.001 * least, least + 1.0}) {
        if (std::abs(target - least) > 1e-6) {
          EXPECT_EQ(eye.Sees(to, Everywhere, target, looking), target > least)
              << c << ", " << r << ": " << target << " of " << least;
        }
      }
      ++(least > 0.0 ? hidden : seen);
    }
  }
  EXPECT_GT(hidden, 100);
  EXPECT_GT(seen, 20);
  EXPECT_FALSE(eye.Sees({0.0, 0.0}, 1e-3, 0.0, looking).has_value());
  EXPECT_TRUE(std::isnan(eye.Least({0.0, 0.0}, 1e-3, running)));
}

TEST(ViewshedEye, APlaneHasOneAnswer) {
  const auto ground = Rough(140, 110, 5);
  ExpectOneAnswer(MapGroundOf(*ground), {{71.3, 40.8}, 2.0}, 1);
}

TEST(ViewshedEye, ABodyHasOneAnswer) {
  const TemporaryFolder folder;
  const auto terrain = HillyMoon(folder);
  ExpectOneAnswer(MapGroundOf(*terrain), {{150.0, 130.0}, 20.0}, 8);
}

// Near a pole great circles are far from straight in posts: against a march that leaves nothing
// out.
TEST(ViewshedEye, LinesThatBendOverThePostsAgreeWithAMarch) {
  const auto height = [](double c, double r) {
    return 1500.0 * std::sin(0.055 * c) * std::cos(0.095 * r) + 500.0 * std::sin(0.5 * (c + r));
  };
  MapGround ground;
  ground.name = "north";
  ground.pyramid =
      std::make_shared<ElevationPyramid>(std::make_shared<FormulaPosts>(240, 90, false, height));
  ground.placement = PostPlacement::OnSphere({-12.0, 79.5}, {0.1, -0.1}, 1737400.0);
  const auto held = HeldPosts::Read(*ground.pyramid, 1, 1, {});
  const ViewshedObserver observer{{120.0, 60.0}, 900.0};
  const ViewshedEye eye(ground, *held, observer);
  const double from = height(120.0, 60.0) + observer.height;
  const auto triangle = [&](const Eigen::Vector2d& post) {
    const double c = std::floor(post.x());
    const double r = std::floor(post.y());
    const double u = post.x() - c;
    const double v = post.y() - r;
    const double across =
        height(c, r) * (1.0 - std::max(u, v)) + height(c + 1.0, r + 1.0) * std::min(u, v);
    return across + (v > u ? height(c, r + 1.0) * (v - u) : height(c + 1.0, r) * (u - v));
  };
  ViewshedEye::Memory memory;
  int hidden = 0;
  int seen = 0;
  for (int r = 1; r < 88; r += 9) {
    for (int c = 2; c < 238; c += 13) {
      const Eigen::Vector2d to(c, r);
      const double least = eye.Least(to, Everywhere, memory);
      const Eigen::Vector3d a = ground.placement.ToScene(observer.post, 0.0);
      const Eigen::Vector3d b = ground.placement.ToScene(to, 0.0);
      const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
      if (angle < 0.005) {
        continue;
      }
      const HorizonPath path(ground.placement, observer.post,
                             ChartDirectionAt(ground.placement, observer.post, b - a).azimuth_deg);
      const double length = angle * ground.placement.Radius();
      double steepest = -Everywhere;
      constexpr int Steps = 40000;
      for (int k = 1; k < Steps; ++k) {
        const HorizonPath::Point p = path.At(length * k / Steps);
        const double h = triangle(p.post);
        steepest = std::max(steepest, (p.fall + p.rise * h - from) / (p.away + p.spread * h));
      }
      const HorizonPath::Point end = path.At(length);
      const double rise = end.rise - steepest * end.spread;
      ASSERT_GT(rise, 0.0);
      const double expected =
          std::max(0.0, (steepest * end.away - end.fall + from) / rise - height(c, r));
      EXPECT_NEAR(least, expected, 2.0 + 1e-3 * expected) << c << ", " << r;
      ++(expected > 100.0 ? hidden : seen);
    }
  }
  EXPECT_GT(hidden, 50);
  EXPECT_GT(seen, 20);
}

} // namespace
} // namespace dspace::testing
