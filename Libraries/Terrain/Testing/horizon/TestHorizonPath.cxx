// Great circles over posts, by GeographicLib's geodesics and by vectors in the scene.
#include <cmath>
#include <random>

#include <GeographicLib/Geodesic.hpp>
#include <gtest/gtest.h>

#include <dspace/horizon/HorizonPath.h>

namespace {

using namespace dspace;

constexpr double Moon = 1737400.0;
constexpr double Degree = M_PI / 180.0;

TEST(HorizonPath, OnAPlaneItIsStraight) {
  Eigen::Affine2d map = Eigen::Affine2d::Identity();
  map.linear() << 3.0, 0.0, 0.0, -2.0;
  const PostPlacement plane = PostPlacement::OnPlane(map);
  const HorizonPath path(plane, {10.0, 20.0}, 30.0);
  const HorizonPath::Point p = path.At(60.0);
  EXPECT_NEAR(p.post.x(), 10.0 + 30.0 / 3.0, 1e-12);
  EXPECT_NEAR(p.post.y(), 20.0 - 60.0 * std::cos(30.0 * Degree) / 2.0, 1e-12);
  EXPECT_EQ(p.away, 60.0);
}

// On a sphere and on Mars' ellipsoid: places by geodesics.
TEST(HorizonPath, OnABodyItFollowsTheGeodesic) {
  const BodyEllipsoid mars(3396190.0, 3376200.0);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const bool flat : {false, true}) {
    const double radius = flat ? mars.Equatorial() : Moon;
    const PostPlacement grid =
        flat ? PostPlacement::OnEllipsoid({-180.0, 90.0}, {0.5, -0.5}, mars, 360.0)
             : PostPlacement::OnSphere({-180.0, 90.0}, {0.5, -0.5}, Moon, 360.0);
    const GeographicLib::Geodesic geodesic(radius,
                                           flat ? 1.0 - mars.Polar() / mars.Equatorial() : 0.0);
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector2d post(720.0 * unit(random), 20.0 + 320.0 * unit(random));
      const double azimuth = 360.0 * unit(random);
      const double distance = 300e3 * unit(random);
      const HorizonPath path(grid, post, azimuth);
      // Its distances are angles of verticals: the geodesic's length is what the point says.
      const HorizonPath::Point p = path.At(distance);
      const Eigen::Vector3d there = grid.ToScene(p.post, 0.0);
      const Eigen::Vector3d here = grid.ToScene(post, 0.0);
      const Eigen::Vector2d from = grid.Angles(post) / Degree;
      const Eigen::Vector2d to = grid.Angles(p.post) / Degree;
      double length = 0.0, first = 0.0, second = 0.0;
      geodesic.Inverse(from.y(), from.x(), to.y(), to.x(), length, first, second);
      // Across the azimuth: rounding, and on the ellipsoid a part in 2,000 of the way.
      const double across = std::sin((first - azimuth) * Degree) * length;
      EXPECT_NEAR(across, 0.0, flat ? 5e-4 * length : 1e-3) << i;
      // Elevation and distance of ground 5 km high, by vectors.
      const ChartAxes axes = ChartAxesAt(grid, post);
      const Eigen::Vector3d top = grid.ToScene(p.post, 5000.0);
      const Eigen::Vector3d eye = grid.ToScene(post, 700.0);
      const Eigen::Vector3d along =
          std::sin(azimuth * Degree) * axes.east + std::cos(azimuth * Degree) * axes.north;
      const double tangent = (top - eye).dot(axes.up) / (top - eye).dot(along);
      EXPECT_NEAR((p.fall + 5000.0 * p.rise - 700.0) / (p.away + 5000.0 * p.spread), tangent,
                  1e-9 + 1e-9 * std::abs(tangent))
          << i;
      EXPECT_NEAR((there - here).norm(), length, 2e-3 * length + 0.01);
    }
  }
}

TEST(HorizonPath, InAPolesChartItCrossesThePole) {
  for (const bool south : {false, true}) {
    const PostPlacement chart = PostPlacement::OnPole(south, 500.0, 1000.0, Moon);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int i = 0; i < 300; ++i) {
      const Eigen::Vector2d post(900.0 + 200.0 * unit(random), 900.0 + 200.0 * unit(random));
      const double azimuth = 360.0 * unit(random);
      const double distance = 200e3 * unit(random);
      const HorizonPath::Point p = HorizonPath(chart, post, azimuth).At(distance);
      const Eigen::Vector3d here = chart.ToScene(post, 0.0) / Moon;
      const Eigen::Vector3d there = chart.ToScene(p.post, 0.0) / Moon;
      EXPECT_NEAR(std::acos(here.dot(there)) * Moon, distance, 0.2);
      // The direction, looked up again.
      const ChartDirection seen = ChartDirectionAt(chart, post, there - here);
      EXPECT_NEAR(std::remainder(seen.azimuth_deg - azimuth, 360.0), 0.0, 1e-6) << i;
    }
    // Columns lead to longitude 0, rows against it along the other axis, up is out.
    const ChartAxes axes = ChartAxesAt(chart, {1010.0, 990.0});
    const Eigen::Vector3d e =
        chart.ToScene({1011.0, 990.0}, 0.0) - chart.ToScene({1009.0, 990.0}, 0.0);
    const Eigen::Vector3d n =
        chart.ToScene({1010.0, 989.0}, 0.0) - chart.ToScene({1010.0, 991.0}, 0.0);
    EXPECT_LT((e.normalized() - axes.east).norm(), 1e-6);
    EXPECT_LT((n.normalized() - axes.north).norm(), 1e-6);
    EXPECT_LT((axes.east.cross(axes.north) - axes.up).norm(), 1e-12);
  }
}

} // namespace
