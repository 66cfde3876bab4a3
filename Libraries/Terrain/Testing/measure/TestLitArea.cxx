// Sunlit areas against closed forms.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "Grids.h"

#include <dspace/measure/LitArea.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace::testing {
namespace {

using V = Eigen::Vector3d;

constexpr std::size_t Many = 20000;

// A parallelogram whose front is on the side of a x b.
std::vector<Face> Panel(const V& corner, const V& a, const V& b) {
  return {{corner, corner + a, corner + a + b}, {corner, corner + a + b, corner + b}};
}

std::vector<Face> Square() {
  return Panel({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
}

std::vector<Face> Cube() { // of side 1
  std::vector<Face> faces;
  for (const auto& side :
       {Panel({0, 0, 0}, {0, 1, 0}, {1, 0, 0}), Panel({0, 0, 1}, {1, 0, 0}, {0, 1, 0}),
        Panel({0, 0, 0}, {1, 0, 0}, {0, 0, 1}), Panel({0, 1, 0}, {0, 0, 1}, {1, 0, 0}),
        Panel({0, 0, 0}, {0, 0, 1}, {0, 1, 0}), Panel({1, 0, 0}, {0, 1, 0}, {0, 0, 1})}) {
    faces.insert(faces.end(), side.begin(), side.end());
  }
  return faces;
}

void AddTo(Obstacles& obstacles, const std::vector<Face>& faces) {
  auto mesh = std::make_shared<Mesh>();
  for (const Face& face : faces) {
    for (const V& corner : face) {
      for (int axis = 0; axis < 3; ++axis) {
        mesh->positions.push_back(float(corner[axis]));
      }
      mesh->indices.push_back(std::uint32_t(mesh->indices.size()));
    }
  }
  obstacles.Add(7, std::make_shared<MeshRays>(mesh), Eigen::Affine3d::Identity());
}

SunDisc SunAt(const V& towards, double radius_deg = 0.0) {
  return {towards.normalized(), radius_deg * M_PI / 180.0};
}

TEST(LitArea, AFreeSquareIsLitByTheCosine) {
  for (const double angle : {0.0, 30.0, 60.0, 89.0}) {
    const V towards(std::sin(angle * M_PI / 180.0), 0, std::cos(angle * M_PI / 180.0));
    const LitArea lit = MeasureLitArea({}, SunAt(towards), Square(), false, 100);
    EXPECT_NEAR(lit.area, 4.0, 1e-12);
    EXPECT_NEAR(lit.lit, 4.0, 1e-12);
    EXPECT_NEAR(lit.projected, 4.0 * std::cos(angle * M_PI / 180.0), 1e-12);
  }
  const LitArea behind = MeasureLitArea({}, SunAt({0.1, 0, -1}), Square(), false, 100);
  EXPECT_EQ(behind.lit, 0.0);
  const LitArea both = MeasureLitArea({}, SunAt({0, 0, -1}), Square(), true, 100);
  EXPECT_NEAR(both.area, 8.0, 1e-12);
  EXPECT_NEAR(both.lit, 4.0, 1e-12);
}

TEST(LitArea, ACubeShadesItself) {
  Obstacles obstacles;
  AddTo(obstacles, Cube());
  const LitArea lit = MeasureLitArea(obstacles, SunAt({1, 1, 1}), Cube(), false, Many);
  EXPECT_NEAR(lit.area, 6.0, 1e-9);
  EXPECT_NEAR(lit.lit, 3.0, 1e-9);
  EXPECT_NEAR(lit.projected, std::sqrt(3.0), 1e-9); // the area of its outline
}

TEST(LitArea, AWallShadesHalfOfATiltedSquare) {
  // Turned about x by 20 degrees, so that the wall's shadow lies in its own plane's axes.
  const Eigen::AngleAxisd tilt(20.0 * M_PI / 180.0, V::UnitX());
  std::vector<Face> square;
  for (Face face : Square()) {
    for (V& corner : face) {
      corner = tilt * corner;
    }
    square.push_back(face);
  }
  Obstacles obstacles;
  AddTo(obstacles, square);
  // The Sun is 45 degrees over +x: the wall at x = 1, one high over the square, shades x > 0.
  std::vector<Face> wall = Panel({1, -3, 0}, {0, 6, 0}, {0, 0, 1});
  for (Face& face : wall) {
    for (V& corner : face) {
      corner = tilt * corner;
    }
  }
  AddTo(obstacles, wall);
  const V towards = tilt * V(1, 0, 1);
  const LitArea lit = MeasureLitArea(obstacles, SunAt(towards), square, false, Many);
  EXPECT_NEAR(lit.lit / lit.area, 0.5, 0.003);
  EXPECT_NEAR(lit.projected, lit.lit * std::sqrt(0.5), 1e-9);
}

TEST(LitArea, AnEdgeThroughTheMiddleOfTheDiscLeavesHalfOfIt) {
  const double elevation = 0.1;
  Obstacles obstacles;
  const double top = 1e4 * std::tan(elevation);
  AddTo(obstacles, Panel({1e4, -1e3, -1e3}, {0, 2e3, 0}, {0, 0, 1e3 + top}));
  const std::vector<Face> panel = Panel({0, -0.01, -0.01}, {0, 0.02, 0}, {0, 0, 0.02});
  const V towards(std::cos(elevation), 0, std::sin(elevation));
  const LitArea lit = MeasureLitArea(obstacles, SunAt(towards, 0.2666), panel, false, Many);
  EXPECT_NEAR(lit.lit / lit.area, 0.5, 0.01);
  const double up = 0.5 * 0.2666 * M_PI / 180.0; // half a radius higher: the segment by hand
  const V higher(std::cos(elevation + up), 0, std::sin(elevation + up));
  const double hidden = (std::acos(0.5) - 0.5 * std::sqrt(0.75)) / M_PI;
  const LitArea more = MeasureLitArea(obstacles, SunAt(higher, 0.2666), panel, false, Many);
  EXPECT_NEAR(more.lit / more.area, 1.0 - hidden, 0.01);
}

TEST(LitArea, ADiscAsWideAsTheSky) {
  const LitArea flat = MeasureLitArea({}, SunAt({0, 0, 1}, 90.0), Square(), false, Many);
  EXPECT_NEAR(flat.projected, 4.0, 0.01);
  const std::vector<Face> upright = Panel({0, -1, -1}, {0, 2, 0}, {0, 0, 2});
  const LitArea half = MeasureLitArea({}, SunAt({0, 0, 1}, 90.0), upright, false, Many);
  EXPECT_NEAR(half.lit, 2.0, 0.02);
  EXPECT_NEAR(half.projected, 2.0, 0.02); // half of the sky, by Lambert's law
}

TEST(LitArea, GroundShadesAndBuries) {
  const auto ridge = Sampled(401, 41, NorthUp(-0.5, 20.5, 1.0), [](const Eigen::Vector2d& p) {
    return std::abs(p.x() - 200.0) < 0.1 ? 20.0 : 0.0;
  });
  Obstacles obstacles;
  obstacles.Add(Obstacles::Ground{"ridge", ridge, {}});
  const auto at = [&](double x, double z) {
    return Panel(ridge->MapToScene({x, -1.0, z}), {2, 0, 0}, {0, 2, 0});
  };
  const SunDisc sun = SunAt({1, 0, 1}); // the shadow ends 20 m before the ridge
  EXPECT_NEAR(MeasureLitArea(obstacles, sun, at(170, 0.0), false, Many).lit, 4.0, 1e-9);
  EXPECT_EQ(MeasureLitArea(obstacles, sun, at(185, 0.0), false, Many).lit, 0.0);
  EXPECT_NEAR(MeasureLitArea(obstacles, sun, at(179, 0.0), false, Many).lit, 2.0, 0.02);
  EXPECT_EQ(MeasureLitArea(obstacles, sun, at(170, -0.1), false, Many).lit, 0.0);
}

TEST(LitArea, FacesWithoutAreaDoNotCount) {
  std::vector<Face> faces = Square();
  faces.push_back({V(0, 0, 0), V(1, 0, 0), V(2, 0, 0)});
  EXPECT_NEAR(MeasureLitArea({}, SunAt({0, 0, 1}), faces, false, 10).lit, 4.0, 1e-12);
}

} // namespace
} // namespace dspace::testing
