// Heights, normals, slopes, holes and coordinates of grids in memory, against closed forms.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/surface/GridTerrain.h>

#include "Grids.h"

namespace {

using dspace::Crs;
using dspace::Error;
using dspace::GridTerrain;
using dspace::Rows2;
using dspace::Rows3;
using dspace::SurfaceSample;
using dspace::testing::NorthUp;
using dspace::testing::Rough;
using dspace::testing::Sampled;

const double NaN = std::numeric_limits<double>::quiet_NaN();

void ExpectPlane(const GridTerrain& terrain, double a, double b, double d) {
  // z = a x + b y + d in map coordinates, metres.
  std::mt19937 random(5);
  const Eigen::AlignedBox3d box = terrain.GetBounds().scene;
  std::uniform_real_distribution<double> x(box.min().x(), box.max().x());
  std::uniform_real_distribution<double> y(box.min().y(), box.max().y());
  int inside = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p_S(x(random), y(random), 77.0);
    const SurfaceSample sample = terrain.Sample(p_S);
    if (!sample.valid)
      continue;
    ++inside;
    const Eigen::Vector3d map = terrain.SceneToMap(p_S);
    EXPECT_NEAR(sample.height, a * map.x() + b * map.y() + d, 1e-9);
    EXPECT_LT((sample.normal_S - Eigen::Vector3d(-a, -b, 1.0).normalized()).norm(), 1e-12);
    EXPECT_NEAR(sample.slope_deg, std::atan(std::hypot(a, b)) * 180.0 / M_PI, 1e-10);
    EXPECT_EQ(sample.level, 0);
    EXPECT_EQ(sample.position_S.head<2>(), p_S.head<2>());
    const Eigen::Vector3d onMap = terrain.SceneToMap(sample.position_S);
    EXPECT_NEAR(onMap.z(), sample.height, 1e-9);
  }
  EXPECT_GT(inside, 200);
}

} // namespace

TEST(GridTerrain, PlaneIsAPlane) {
  const auto height = [](const Eigen::Vector2d& m) { return 0.3 * m.x() - 0.2 * m.y() + 5.0; };
  ExpectPlane(*Sampled(17, 9, NorthUp(1000.0, 2000.0, 3.0), height), 0.3, -0.2, 5.0);
  ExpectPlane(*Sampled(17, 9, NorthUp(1000.0, 2000.0, 3.0), height, 4000.0), 0.3, -0.2, 5.0);
}

TEST(GridTerrain, RotatedShearedAndSouthUpPixelsKeepTheirPlace) {
  const auto height = [](const Eigen::Vector2d& m) { return 0.3 * m.x() - 0.2 * m.y() + 5.0; };
  Eigen::Affine2d rotated = NorthUp(50.0, 70.0, 2.0);
  rotated.linear() = Eigen::Rotation2Dd(0.6).toRotationMatrix() * rotated.linear();
  ExpectPlane(*Sampled(15, 13, rotated, height), 0.3, -0.2, 5.0);
  Eigen::Affine2d sheared = NorthUp(50.0, 70.0, 2.0);
  sheared.linear() << 2.0, 0.7, 0.1, -5.0; // anisotropic, too
  ExpectPlane(*Sampled(15, 13, sheared, height), 0.3, -0.2, 5.0);
  Eigen::Affine2d southUp = NorthUp(50.0, 70.0, 2.0);
  southUp.linear() << 2.0, 0.0, 0.0, 2.0;
  ExpectPlane(*Sampled(15, 13, southUp, height), 0.3, -0.2, 5.0);
}

TEST(GridTerrain, TrianglesByHand) {
  // Posts (0,1) (1,1) over (0,0) (1,0) of the map: 0 1 / 2 5. Diagonal from the north-west.
  const GridTerrain terrain("hand", 2, 2, {0.0, 1.0, 2.0, 5.0}, NorthUp(-0.5, 1.5, 1.0));
  const auto h = [&](double x, double y) { return terrain.SampleMap({x, y}).height; };
  EXPECT_DOUBLE_EQ(h(0.0, 1.0), 0.0);
  EXPECT_DOUBLE_EQ(h(1.0, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(h(0.0, 0.0), 2.0);
  EXPECT_DOUBLE_EQ(h(1.0, 0.0), 5.0);
  EXPECT_DOUBLE_EQ(h(0.5, 0.5), 2.5); // half of 0 and 5; bilinear would give 2
  EXPECT_DOUBLE_EQ(h(0.25, 0.25), 0.75 * 2.0 + 0.25 * 3.0); // A: 2 down, 3 along the bottom
  EXPECT_DOUBLE_EQ(h(0.75, 0.75), 0.75 * 1.0 + 0.25 * 4.0); // B: 1 along the top, 4 down
  const SurfaceSample a = terrain.SampleMap({0.25, 0.25});
  EXPECT_LT((a.normal_S - Eigen::Vector3d(-3.0, 2.0, 1.0).normalized()).norm(), 1e-14);
  EXPECT_NEAR(a.slope_deg, std::atan(std::sqrt(13.0)) * 180.0 / M_PI, 1e-12);
}

TEST(GridTerrain, OutsideAndHolesAreTyped) {
  std::vector<double> heights(25, 1.0);
  heights[12] = NaN; // the middle post of 5 x 5
  const GridTerrain terrain("hole", 5, 5, heights, NorthUp(-0.5, 4.5, 1.0));
  for (const Eigen::Vector2d& out : {Eigen::Vector2d(-0.01, 2.0),
                                     {4.01, 2.0},
                                     {2.0, -0.01},
                                     {2.0, 4.01},
                                     {1e300, 0.0},
                                     {2.0, 2.0},
                                     {2.3, 2.2}}) {
    const SurfaceSample sample = terrain.SampleMap(out);
    EXPECT_FALSE(sample.valid) << out.transpose();
    EXPECT_TRUE(std::isnan(sample.height) && std::isnan(sample.slope_deg));
    EXPECT_TRUE(sample.normal_S.array().isNaN().all());
    EXPECT_EQ(terrain.ResidentLevel(out), -1);
  }
  // The six triangles around it are gone, the other two corners of its four cells stay; posts and
  // edges on the rim of the hole have data.
  EXPECT_TRUE(terrain.SampleMap({1.2, 1.2}).valid);  // cell south-west: below its diagonal
  EXPECT_TRUE(terrain.SampleMap({2.8, 2.8}).valid);  // cell north-east: above its diagonal
  EXPECT_FALSE(terrain.SampleMap({1.2, 2.4}).valid); // cell north-west: both triangles touch it
  for (int r = 0; r < 5; ++r)
    for (int c = 0; c < 5; ++c)
      EXPECT_EQ(terrain.SampleMap({c, r}).valid, !(c == 2 && r == 2)) << c << " " << r;
  EXPECT_EQ(terrain.Grid().GetHoleCount(), 1u);
}

TEST(GridTerrain, ArraysEqualSingles) {
  const auto terrain = Rough(40, 30, 3, 0.05);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> x(-16.0, 16.0), y(-12.0, 12.0);
  Rows3 points(1000, 3);
  Rows2 map(1000, 2);
  for (int i = 0; i < 1000; ++i) {
    points.row(i) << x(random), y(random), 0.0;
    map.row(i) = terrain->SceneToMap(points.row(i)).head<2>();
  }
  Eigen::VectorXd heights(1000), heightsMap(1000), slopes(1000);
  Rows3 normals(1000, 3);
  terrain->Heights(points, heights);
  terrain->HeightsMap(map, heightsMap);
  terrain->Slopes(points, slopes);
  terrain->Normals(points, normals);
  int valid = 0;
  for (int i = 0; i < 1000; ++i) {
    const SurfaceSample sample = terrain->Sample(points.row(i));
    valid += sample.valid;
    if (!sample.valid) {
      EXPECT_TRUE(std::isnan(heights[i]) && std::isnan(slopes[i]) && std::isnan(normals(i, 2)));
      continue;
    }
    EXPECT_EQ(heights[i], sample.height);
    EXPECT_NEAR(heightsMap[i], sample.height, 1e-9);
    EXPECT_EQ(slopes[i], sample.slope_deg);
    EXPECT_EQ(normals.row(i).transpose(), sample.normal_S);
  }
  EXPECT_GT(valid, 400);
  EXPECT_LT(valid, 1000);
}

TEST(GridTerrain, RejectsBadArguments) {
  const auto terrain = Rough(10, 10, 1);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero(), up = Eigen::Vector3d::UnitZ();
  EXPECT_THROW(terrain->Sample({NaN, 0.0, 0.0}), Error);
  EXPECT_THROW(terrain->SampleMap({0.0, INFINITY}), Error);
  EXPECT_THROW(terrain->Intersect(zero, zero), Error);
  EXPECT_THROW(terrain->Intersect(zero, {0.0, 0.0, NaN}), Error);
  EXPECT_THROW(terrain->Intersect(zero, up, -1.0), Error);
  EXPECT_THROW(terrain->Intersect(zero, up, NaN), Error);
  EXPECT_THROW(terrain->GeographicToMap(zero), Error);
  Rows3 points = Rows3::Zero(3, 3);
  Eigen::VectorXd two(2), three(3);
  EXPECT_THROW(terrain->Heights(points, two), Error);
  points(1, 2) = NaN;
  try {
    terrain->Heights(points, three);
    ADD_FAILURE() << "accepted NaN";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("row 1"), std::string::npos) << error.what();
  }
  EXPECT_THROW(GridTerrain("short", 3, 3, {1.0, 2.0}, NorthUp(0.0, 0.0, 1.0)), Error);
  const auto rejected = [](const std::vector<double>& heights, double size, const char* words) {
    try {
      GridTerrain("far", 2, 2, heights, NorthUp(0.0, 0.0, size));
      ADD_FAILURE() << "no error: " << words;
    } catch (const Error& e) {
      EXPECT_EQ(e.GetKind(), Error::Kind::InvalidArgument);
      EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
      EXPECT_EQ(e.GetObjectName(), "far");
    }
  };
  rejected({1.0, 2.0, 1e30, 1.0}, 1.0, "column 0, row 1 has the height 1e+30 m; accepted are -1e9");
  rejected({1.0, -1.1e9, NaN, 1.0}, 1.0, "column 1, row 0 has the height -1.1e+09");
  rejected({1.0, 2.0, 3.0, 1.0}, 1e20, "within 1e15 m");
  EXPECT_NO_THROW(GridTerrain("sun", 2, 2, {7e8, 7e8, NaN, -7e8}, NorthUp(0.0, 0.0, 1.0)));
  EXPECT_THROW(GridTerrain("inf", 2, 2, {1.0, 2.0, INFINITY, 1.0}, NorthUp(0.0, 0.0, 1.0)), Error);
  EXPECT_THROW(GridTerrain("flat", 2, 2, {1.0, 2.0, 3.0, 4.0}, NorthUp(0.0, 0.0, 0.0)), Error);
}

TEST(GridTerrain, LongitudesWrapTowardsTheData) {
  // A grid from 0 to 360 E; its middle is at 180.
  Eigen::Affine2d global = Eigen::Affine2d::Identity();
  global.linear() << 10.0, 0.0, 0.0, -10.0;
  global.translation() << 0.0, 90.0;
  std::vector<double> heights;
  for (int r = 0; r < 18; ++r)
    for (int c = 0; c < 36; ++c)
      heights.push_back(10.0 * c + 5.0); // the post's longitude
  const GridTerrain terrain("global", 36, 18, heights, global, Crs::FromText("IAU_2015:49900"));
  for (double longitude : {-170.0, -90.0, -10.0, 90.0, 170.0, 350.0}) {
    const Eigen::Vector3d map = terrain.GeographicToMap({longitude, 3.0, 0.0});
    EXPECT_NEAR(terrain.SampleMap(map.head<2>()).height, std::fmod(longitude + 360.0, 360.0), 1e-9);
    EXPECT_NEAR(terrain.MapToGeographic(map).x(), std::remainder(longitude, 360.0), 1e-9);
  }
  EXPECT_THROW(terrain.GeographicToMap({0.0, 91.0, 0.0}), Error);
}
