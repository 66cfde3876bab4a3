// Viewsheds cell by cell against exact rays.
#include <cmath>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/horizon/HeldPosts.h>
#include <dspace/maps/Viewshed.h>
#include <dspace/measure/SightLine.h>

#include "FormulaPosts.h"
#include "Grids.h"
#include "MapTestSupport.h"

namespace dspace::testing {
namespace {

using V = Eigen::Vector3d;

// Every cell: a ray to a target that is a margin higher than the least seen height is clear, and to
// one that is a margin lower is blocked.
void ExpectExact(const TerrainSurface& surface, const MapGround& ground,
                 const ViewshedObserver& observer, const MapCells& cells, double margin) {
  const auto held = HeldPosts::Read(*ground.pyramid, 1, 1, {});
  Obstacles obstacles;
  obstacles.Add(Obstacles::Ground{"ground", {std::shared_ptr<void>(), &surface}, {}});
  const V foot = surface.Sample(ground.placement.ToScene(observer.post, 0.0)).position_S;
  const V eye = foot + observer.height * surface.Up(foot);
  int hidden = 0;
  int seen = 0;
  for (int j = 0; j < cells.rows; ++j) {
    for (int i = 0; i < cells.columns; ++i) {
      const Eigen::Vector2d post = cells.Post(i, j);
      const double least = LeastSeenHeight(ground, *held, observer, post);
      float height = 0.0f;
      ground.pyramid->Read({0, std::int64_t(post.x()), std::int64_t(post.y()), 1, 1}, &height);
      if (std::isnan(height)) {
        EXPECT_TRUE(std::isnan(least));
        continue;
      }
      const auto clear = [&](double above) {
        const V target = ground.placement.ToScene(post, double(height) + above);
        return (target - eye).norm() < 1e-3 || !obstacles.First(eye, target, "eye", "target").hit;
      };
      EXPECT_TRUE(clear(least + margin)) << i << ", " << j << " least " << least;
      if (least > margin) {
        EXPECT_FALSE(clear(least - margin)) << i << ", " << j << " least " << least;
        ++hidden;
      } else {
        ++seen;
      }
    }
  }
  EXPECT_GT(hidden, cells.columns * cells.rows / 10);
  EXPECT_GT(seen, cells.columns * cells.rows / 50);
}

TEST(Viewshed, APlaneAgreesWithRaysInEveryCell) {
  const auto ground = Rough(80, 70, 5);
  const MapGround map = MapGroundOf(*ground);
  const MapCells cells = FindCells(map, std::nullopt, 0.0);
  ExpectExact(*ground, map, {{41.0, 30.0}, 2.0}, cells, 1e-4);
  ExpectExact(*ground, map, {{12.3, 55.6}, 6.0}, cells, 1e-4); // between posts
}

TEST(Viewshed, ABodyAgreesWithRaysInEveryCell) {
  const TemporaryFolder folder;
  const auto terrain = HillyMoon(folder);
  const MapGround ground = MapGroundOf(*terrain);
  MapCells cells = FindCells(ground, std::nullopt, 0.0);
  cells.every *= 8; // to 48 km
  cells.columns /= 8;
  cells.rows /= 8;
  ExpectExact(*terrain, ground, {{150.0, 130.0}, 20.0}, cells, 0.02);
}

// Over a smooth sphere the least height follows from the dip.
TEST(Viewshed, ASmoothSphereHidesByItsCurvature) {
  const TemporaryFolder folder;
  const double radius = 1737400.0;
  const auto terrain = OnBody(WriteDegrees(folder, "level.tif", radius, 120, 100, 30.0, 20.0, 0.01,
                                           [](double, double) { return 0.0; }));
  const MapGround ground = MapGroundOf(*terrain);
  const auto held = HeldPosts::Read(*ground.pyramid, 1, 1, {});
  const ViewshedObserver observer{{100.0, 200.0}, 10.0};
  const double dip = std::acos(radius / (radius + 10.0));
  const V from = ground.placement.ToScene(observer.post, 0.0).normalized();
  int hidden = 0;
  for (int k = 0; k < 60; ++k) {
    const Eigen::Vector2d to(100.0 + 5.0 * k, 200.0 + 2.0 * (k % 7));
    const V there = ground.placement.ToScene(to, 0.0).normalized();
    const double beyond = std::atan2(from.cross(there).norm(), from.dot(there)) - dip;
    // The last facet before the tangent point may reach a millimetre below the sphere.
    const double expected = beyond > 0.0 ? radius / std::cos(beyond) - radius : 0.0;
    EXPECT_NEAR(LeastSeenHeight(ground, *held, observer, to), expected,
                2e-3 + 2e-3 * std::sqrt(expected))
        << k;
    hidden += beyond > 0.0;
  }
  EXPECT_GT(hidden, 20);
}

TEST(Viewshed, ObserversAreCumulative) {
  const TemporaryFolder folder;
  const auto ground = Rough(90, 80, 5, 0.01);
  const MapGround map = MapGroundOf(*ground);
  ViewshedOptions options;
  options.cells = FindCells(map, std::nullopt, 0.0);
  options.observers = {{{41.0, 30.0}, 2.0}, {{10.5, 60.2}, 3.0}, {{80.0, 70.0}, 1.0}};
  options.targetHeight = 0.4;
  options.radius = 30.0;
  using Q = ViewshedOptions::Quantity;
  options.quantities = {Q::Visible, Q::LeastHeight, Q::Count};
  const std::string path = (folder.Path() / "view.tif").string();
  ASSERT_TRUE(WriteViewshed(map, options, path));
  const auto bands = BandsOf(path);
  const std::vector<float>& visible = bands[0];
  const std::vector<float>& least = bands[1];
  const std::vector<float>& count = bands[2];
  const auto held = HeldPosts::Read(*map.pyramid, 1, 1, {});
  int two = 0;
  int far = 0;
  for (int i = 0; i < 90 * 80; ++i) {
    const Eigen::Vector2d post(i % 90, i / 90);
    double lowest = std::numeric_limits<double>::infinity();
    int seen = 0;
    bool near = false;
    for (const ViewshedObserver& observer : options.observers) {
      if (0.7 * (post - observer.post).norm() <= 30.0) {
        const double height = LeastSeenHeight(map, *held, observer, post);
        near |= !std::isnan(height);
        lowest = height < lowest ? height : lowest;
        seen += height <= 0.4;
      }
    }
    const auto at = std::size_t(i);
    EXPECT_EQ(std::isnan(visible[at]), !near);
    far += !near;
    if (near) {
      EXPECT_EQ(count[at], float(seen));
      EXPECT_EQ(visible[at], float(seen > 0));
      EXPECT_EQ(least[at], float(lowest));
    }
    two += seen == 2;
  }
  EXPECT_GT(two, 10);
  EXPECT_GT(far, 100);
}

// Also beyond a quarter turn of the body, where nothing is seen.
TEST(Viewshed, CellsBeyondTheRadiusAreEmptyAllAroundABody) {
  const TemporaryFolder folder;
  const double radius = 1000.0;
  MapGround ground;
  ground.name = "globe";
  ground.pyramid = std::make_shared<ElevationPyramid>(
      std::make_shared<FormulaPosts>(72, 35, true, [](double, double) { return 0.0; }));
  ground.placement = PostPlacement::OnSphere({0.0, 85.0}, {5.0, -5.0}, radius);
  ViewshedOptions options;
  options.cells.columns = 72;
  options.cells.rows = 35;
  options.observers = {{{10.0, 17.0}, 5.0}};
  const V from = ground.placement.ToScene(options.observers[0].post, 0.0).normalized();
  for (const double within : {800.0, 1e6}) {
    options.radius = within;
    const std::string path = (folder.Path() / (std::to_string(int(within)) + ".tif")).string();
    ASSERT_TRUE(WriteViewshed(ground, options, path));
    const std::vector<float> visible = BandsOf(path)[0];
    int behind = 0;
    for (int i = 0; i < 72 * 35; ++i) {
      const V to = ground.placement.ToScene(options.cells.Post(i % 72, i / 72), 0.0).normalized();
      const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
      ASSERT_EQ(std::isnan(visible[std::size_t(i)]), angle * radius > within) << i;
      if (angle > 0.51 * M_PI && within == 1e6) {
        EXPECT_EQ(visible[std::size_t(i)], 0.0f) << i;
      }
      behind += angle > 0.51 * M_PI;
    }
    EXPECT_GT(behind, 1000);
  }
}

TEST(Viewshed, BadInputIsRejected) {
  const TemporaryFolder folder;
  const auto ground = Rough(30, 30, 5);
  const MapGround map = MapGroundOf(*ground);
  ViewshedOptions options;
  options.cells = FindCells(map, std::nullopt, 0.0);
  const std::string path = (folder.Path() / "view.tif").string();
  EXPECT_THROW(WriteViewshed(map, options, path), Error); // no observer
  options.observers = {{{31.0, 5.0}, 2.0}};
  EXPECT_THROW(WriteViewshed(map, options, path), Error); // off the data
  options.observers = {{{5.0, 5.0}, -2.0}};
  EXPECT_THROW(WriteViewshed(map, options, path), Error); // below the ground
  options.observers = {{{5.0, 5.0}, 2.0}};
  options.radius = 0.0;
  EXPECT_THROW(WriteViewshed(map, options, path), Error);
  options.radius = 10.0;
  EXPECT_TRUE(WriteViewshed(map, options, path));
}

} // namespace
} // namespace dspace::testing
