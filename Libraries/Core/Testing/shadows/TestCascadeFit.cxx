// The maps of the Sun's shadows: what they cover, how finely, and that their texels hold still.
#include <gtest/gtest.h>

#include <cmath>

#include <dspace/render/shadows/CascadeFit.h>

using namespace dspace;

namespace {

SunPlace SunFrom(const Eigen::Vector3d& toSun) {
  SunPlace sun;
  sun.axes = LightAxes(toSun);
  sun.radius = 0.00465;
  return sun;
}

// A place on a map, -1 to 1, and its depth.
Eigen::Vector3d OnMap(const CascadeFit& fit, int k, const Eigen::Vector3d& p) {
  return (fit.ClipFromView(fit.cascades[std::size_t(k)]) * p.homogeneous()).head<3>();
}

Projection Wide() {
  Projection projection;
  projection.verticalFov_deg = 60.0;
  return projection;
}

Projection OffAxis() {
  Projection projection;
  projection.kind = Projection::Kind::Frustum;
  projection.left = -0.1;
  projection.right = 1.4;
  projection.top = -0.9;
  projection.bottom = 0.2;
  return projection;
}

Projection Parallel() {
  Projection projection;
  projection.kind = Projection::Kind::Orthographic;
  projection.height = 40.0;
  return projection;
}

} // namespace

TEST(CascadeFit, LightAxesAreARotationTowardsTheSun) {
  for (const Eigen::Vector3d& s :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(3, -4, 12),
        Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-1, 2, -2), Eigen::Vector3d(1e-3, 0, -1)}) {
    const Eigen::Matrix3d axes = LightAxes(s);
    EXPECT_NEAR(axes.determinant(), 1.0, 1e-9);
    EXPECT_LT((axes * axes.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
    EXPECT_LT((axes * s.normalized() - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
  }
}

// Every point of the view down to a map's end is on it, for odd sizes and all kinds of cameras.
TEST(CascadeFit, AMapCoversTheViewDownToItsEnd) {
  for (const Projection& projection : {Wide(), OffAxis(), Parallel()}) {
    for (const auto& [width, height] : {std::pair(1280, 720), {333, 777}, {1, 1}}) {
      for (const Eigen::Vector3d& s : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1),
                                       Eigen::Vector3d(1, 0.03, 0), Eigen::Vector3d(-1, -2, 0.5)}) {
        const CascadeFit fit =
            FitCascades(projection, width, height, SunFrom(s), 1.3, 900.0, ShadowLook());
        double before = 0.0;
        for (std::size_t k = 0; k < fit.cascades.size(); ++k) {
          if (projection.kind == Projection::Kind::Orthographic) {
            EXPECT_EQ(fit.cascades[k].end, 900.0);
          } else {
            EXPECT_GT(fit.cascades[k].end, before);
          }
          before = fit.cascades[k].end;
          for (const double depth : {0.01, 0.5 * before, before}) {
            for (const auto& [x, y] : {std::pair(-0.5, -0.5),
                                       {width - 0.5, -0.5},
                                       {-0.5, height - 0.5},
                                       {width - 0.5, height - 0.5},
                                       {0.4 * width, 0.7 * height}}) {
              const Projection::Ray ray = projection.PixelRay(x, y, width, height);
              const Eigen::Vector3d sensor = ray.origin + depth / ray.direction.z() * ray.direction;
              const Eigen::Vector3d p(sensor.x(), -sensor.y(), -sensor.z());
              const Eigen::Vector3d map = OnMap(fit, int(k), p);
              EXPECT_LT(std::abs(map.x()), 1.0);
              EXPECT_LT(std::abs(map.y()), 1.0);
              EXPECT_GE(map.z(), 0.0);
              EXPECT_LE(map.z(), 1.0);
            }
          }
        }
        EXPECT_GE(before, 900.0);
      }
    }
  }
}

// The goal: 2 cm on the ground at 5 m from a camera that stands 2 m above it.
TEST(CascadeFit, TexelsAreOfTwoCentimetresAtFiveMetres) {
  const CascadeFit fit = FitCascades(Wide(), 1280, 720, SunFrom({1, 1, 1}), 1.0, 1e5, ShadowLook());
  ASSERT_EQ(fit.cascades.size(), 4u);
  EXPECT_GE(fit.cascades[0].end, 5.0);
  EXPECT_LE(fit.cascades[0].Texel(fit.size), 0.02);
  EXPECT_DOUBLE_EQ(fit.cascades[3].end, 2048.0);
}

// The same 60 m by ever longer lenses: the maps are as fine as those from nearby, and hold what is
// seen.
TEST(CascadeFit, ALongLensHasTheTexelsOfAShortOne) {
  const auto fit = [](double distance) {
    Projection projection;
    projection.verticalFov_deg = 2.0 * std::atan(30.0 / distance) * 180.0 / M_PI;
    return FitCascades(projection, 640, 480, SunFrom({1, 1, 1}), distance - 30.0, distance + 30.0,
                       ShadowLook());
  };
  for (const double distance : {300.0, 3e3, 1e5}) {
    const CascadeFit far = fit(distance);
    EXPECT_LE(far.cascades[3].radius, 1.5 * std::hypot(30.0, 40.0, 40.0)) << distance;
    EXPECT_GE(far.cascades[3].end, distance + 30.0);
    const double angle = std::atan(30.0 / distance);
    for (const double depth : {distance - 29.9, distance, distance + 29.9}) {
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector3d map = OnMap(far, 3, {0.0, side * depth * std::tan(angle), -depth});
        EXPECT_LT(map.cwiseAbs().maxCoeff(), 1.0) << distance;
        EXPECT_GE(map.z(), 0.0);
      }
    }
  }
}

// A distance that the user gives ends the maps, also through a long lens.
TEST(CascadeFit, AGivenDistanceEndsTheMapsOfALongLens) {
  Projection projection;
  projection.verticalFov_deg = 1.0;
  ShadowLook look;
  for (const double distance : {500.0, 2990.0, 3e4}) {
    look.distance = distance;
    const CascadeFit fit =
        FitCascades(projection, 640, 480, SunFrom({1, 1, 1}), 2970.0, 3030.0, look);
    EXPECT_DOUBLE_EQ(fit.cascades.back().end, distance);
  }
}

// All maps of a parallel view have all of it; each resolves four times wider penumbrae, and sizes
// do not change with small changes of what is seen.
TEST(CascadeFit, MapsOfAParallelViewAreForEverWiderPenumbrae) {
  const auto fit = [](double nearest, double farthest) {
    return FitCascades(Parallel(), 640, 480, SunFrom({1, 1, 1}), nearest, farthest, ShadowLook());
  };
  const CascadeFit one = fit(10.0, 18.0);
  ASSERT_EQ(one.cascades.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(one.cascades[k].end, 18.0);
    EXPECT_DOUBLE_EQ(one.cascades[k].radius, one.cascades[0].radius * std::pow(4.0, double(k)));
    EXPECT_DOUBLE_EQ(one.Reach(one.cascades[k]),
                     7.0 * one.cascades[k].Texel(2048) / std::tan(0.00465));
    EXPECT_DOUBLE_EQ(one.Beginning(k), k > 0 ? 0.75 * one.Reach(one.cascades[k - 1]) : 0.0);
    EXPECT_EQ(fit(10.1, 18.3).cascades[k].radius, one.cascades[k].radius);
  }
  // The view's corners are at half of 40 m by 53 m from its axis, and 4 m before and behind.
  EXPECT_GE(one.cascades[0].radius, std::hypot(20.0, 20.0 * 640 / 480, 4.0));
  EXPECT_LE(one.cascades[0].radius, 1.5 * std::hypot(20.0, 20.0 * 640 / 480, 4.0));
}

// A point of the ground stays at the same place within its texel wherever the camera is, also far
// from the origin, and the maps keep their sizes.
TEST(CascadeFit, TexelsHoldStillWhileTheCameraMoves) {
  const Eigen::Vector3d toSun = Eigen::Vector3d(0.3, -0.5, 0.2).normalized();
  const Eigen::Matrix3d light = LightAxes(toSun); // from the light's frame
  const Eigen::Vector3d point(1.0e6 + 3.2, -2.0e6 + 1.1, 0.4);
  std::vector<Eigen::Vector2d> first;
  for (int step = 0; step < 50; ++step) {
    const Eigen::Vector3d eye(1.0e6 + 0.037 * step, -2.0e6 - 0.011 * step, 1.5 + 0.004 * step);
    const Eigen::Matrix3d view =
        Eigen::AngleAxisd(0.01 * step, Eigen::Vector3d(0.2, 1, 0.1).normalized())
            .toRotationMatrix(); // to view axes
    SunPlace sun;
    sun.axes = light * view.transpose();
    sun.camera = (light * eye).head<2>();
    const CascadeFit fit = FitCascades(Wide(), 640, 480, sun, 1.1, 300.0, ShadowLook());
    const Eigen::Vector3d p = view * (point - eye);
    for (std::size_t k = 0; k < fit.cascades.size(); ++k) {
      const Eigen::Vector2d texels =
          0.5 * fit.size * (OnMap(fit, int(k), p).head<2>() + Eigen::Vector2d::Ones());
      const Eigen::Vector2d part = texels - texels.array().floor().matrix();
      if (step == 0) {
        first.push_back(part);
      }
      const Eigen::Vector2d moved = part - first[k];
      EXPECT_LT((moved - moved.array().round().matrix()).norm(), 1e-3) << step << " " << k;
    }
  }
}
