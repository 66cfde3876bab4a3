// Directions along a lattice, against differences of places.
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/posts/ChartAxes.h>

namespace {

using namespace dspace;

constexpr double Moon = 1737400.0;

TEST(ChartAxes, RunAlongColumnsAndAgainstRows) {
  const BodyEllipsoid moon(Moon, Moon);
  const std::vector<std::pair<PostPlacement, Eigen::Vector2d>> cases = {
      {PostPlacement::OnSphere({-20.0, 80.0}, {0.01, -0.01}, Moon), {1234.5, 700.25}},
      {PostPlacement::OnSphere({190.0, -10.0}, {0.01, -0.01}, Moon), {17.0, 3000.0}},
      {PostPlacement::OnPole(false, 500.0, 1000.0, Moon), {1200.0, 900.0}},
      {PostPlacement::OnPole(true, 500.0, 1000.0, Moon), {300.0, 1800.0}},
      {PostPlacement::AtPole(true, 1e-4, {-400.0, 250.0}, 37.0, moon), {80.0, 90.0}},
      {PostPlacement::AtPole(false, 1e-4, {6000.0, 2000.0}, -101.5, moon), {3.0, 4.0}},
      {PostPlacement::AtPole(false, 1e-4, {50.0, 60.0}, 90.0, moon), {50.0, 60.0}}};
  for (const auto& [placement, post] : cases) {
    const ChartAxes axes = ChartAxesAt(placement, post);
    const auto along = [&, &placement = placement, &post = post](double c, double r) {
      const Eigen::Vector2d half(0.5 * c, 0.5 * r);
      return Eigen::Vector3d(placement.ToScene(post + half, 0.0) -
                             placement.ToScene(post - half, 0.0));
    };
    const double step = 1e-2;
    EXPECT_LT((along(step, 0.0).normalized() - axes.east).norm(), 1e-6);
    EXPECT_LT((along(0.0, -step).normalized() - axes.north).norm(), 1e-6);
    EXPECT_LT((placement.Up(placement.ToScene(post, 0.0)) - axes.up).norm(), 1e-12);
    const double side = std::max(along(1.0, 0.0).norm(), along(0.0, 1.0).norm());
    EXPECT_NEAR(side / placement.CellSize(post), 1.0, 1e-5);
  }
}

TEST(ChartAxes, OfAPlaneAreTheScenes) {
  Eigen::Affine2d turned = Eigen::Affine2d::Identity();
  turned.linear() = Eigen::Rotation2Dd(0.3).toRotationMatrix() * 5.0;
  const ChartAxes axes = ChartAxesAt(PostPlacement::OnPlane(turned), {3.0, 4.0});
  EXPECT_EQ(axes.east, Eigen::Vector3d::UnitX());
  EXPECT_EQ(axes.north, Eigen::Vector3d::UnitY());
  EXPECT_EQ(axes.up, Eigen::Vector3d::UnitZ());
}

} // namespace
