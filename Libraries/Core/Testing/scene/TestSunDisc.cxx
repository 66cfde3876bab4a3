// The lit part of the Sun's disc against the sums of many rays.
#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Geometry>

#include <dspace/scene/bodies/SunDisc.h>

namespace dspace {
namespace {

constexpr double SunRadius = 6.957e8;
constexpr double Au = 1.495978707e11;

// Rays to points of the Sun's disc that miss the ellipsoid.
double ByRays(const SunBlocker& blocker, const Eigen::Vector3d& sun, double radius, int side) {
  const Eigen::Vector3d s = sun.normalized();
  const Eigen::Vector3d u = s.unitOrthogonal();
  const Eigen::Vector3d v = s.cross(u);
  // The visible rim of a sphere is nearer than its centre; a disc of the same angle at the centre's
  // distance.
  const double rim = sun.norm() * std::tan(std::asin(radius / sun.norm()));
  int all = 0;
  int left = 0;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const double x = (2.0 * (i + 0.5) / side - 1.0);
      const double y = (2.0 * (j + 0.5) / side - 1.0);
      if (x * x + y * y > 1.0) {
        continue;
      }
      ++all;
      const Eigen::Vector3d d = (blocker.unit * (sun + rim * (x * u + y * v))).normalized();
      const Eigen::Vector3d c = blocker.unit * blocker.center;
      const double along = c.dot(d);
      left += along < 0.0 || (c - along * d).squaredNorm() > 1.0;
    }
  }
  return double(left) / all;
}

SunBlocker Body(const Eigen::Vector3d& center, const Eigen::Vector3d& radii,
                const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity()) {
  return {center, (axes * radii.asDiagonal()).inverse()};
}

TEST(SunDisc, TheMoonHidesTheSunAsRaysSay) {
  const Eigen::Vector3d sun(1.01 * Au, 3e9, -2e9);
  const Eigen::Vector3d radii = Eigen::Vector3d::Constant(1737.4e3);
  for (const double aside : {0.0, 1e5, 8e5, 1.7e6, 2.5e6, 3.4e6, 3.6e6}) {
    const SunBlocker moon =
        Body(sun.normalized() * 3.7e8 + Eigen::Vector3d(0, 0.6, 0.8) * aside, radii);
    EXPECT_NEAR(SunLeft(moon, sun, SunRadius), ByRays(moon, sun, SunRadius, 1500), 1e-4) << aside;
  }
}

TEST(SunDisc, AnOblateLimbHidesTheSunAsRaysSay) {
  Eigen::Matrix3d tilted;
  tilted = Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.2, 1.0, 0.3).normalized());
  const Eigen::Vector3d sun(Au, 0, 0);
  // The Earth from the Moon; Saturn, ten times as flat, from a moon.
  const Eigen::Vector3d earth(6378.137e3, 6378.137e3, 6356.752e3);
  for (const double angle : {0.0, 0.7, 1.3, 2.2, 4.0}) {
    for (const double aside : {4.5e6, 5.5e6, 6.3e6, 7.1e6, 8.0e6}) {
      const Eigen::Vector3d center(3.84e8, aside * std::cos(angle), aside * std::sin(angle));
      const SunBlocker body = Body(center, earth, tilted);
      EXPECT_NEAR(SunLeft(body, sun, SunRadius), ByRays(body, sun, SunRadius, 1000), 2e-4)
          << angle << " " << aside;
    }
    const Eigen::Vector3d saturn(60268e3, 60268e3, 54364e3);
    const Eigen::Vector3d far(9.5 * Au, 0, 0);
    for (const double aside : {5.2e7, 5.6e7, 5.8e7, 6.0e7, 6.2e7}) {
      const Eigen::Vector3d center(1.2e9, aside * std::cos(angle), aside * std::sin(angle));
      const SunBlocker body = Body(center, saturn, tilted);
      EXPECT_NEAR(SunLeft(body, far, SunRadius), ByRays(body, far, SunRadius, 1000), 2e-3)
          << angle << " " << aside;
    }
  }
}

TEST(SunDisc, WhatIsBehindOrUnderfootHidesNothing) {
  const Eigen::Vector3d radii = Eigen::Vector3d::Constant(1737.4e3);
  const Eigen::Vector3d sun(Au, 0, 0);
  EXPECT_EQ(SunLeft(Body({-3.8e8, 0, 0}, radii), sun, SunRadius), 1.0);           // behind
  EXPECT_EQ(SunLeft(Body({1.2 * Au, 0, 0}, radii), sun, SunRadius), 1.0);         // beyond the Sun
  EXPECT_EQ(SunLeft(Body({1.005 * 1737.4e3, 0, 0}, radii), sun, SunRadius), 1.0); // its own ground
  EXPECT_EQ(SunLeft(Body({1.1 * 1737.4e3, 0, 0}, radii), sun, SunRadius), 0.0);   // in orbit
}

} // namespace
} // namespace dspace
