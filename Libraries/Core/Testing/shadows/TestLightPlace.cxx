// Hulls, their planes, sides and parts along the light, against points of theirs that are turned
// one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <dspace/render/shadows/CascadeFit.h>
#include <dspace/render/shadows/LightPlace.h>

using namespace dspace;

namespace {

class LightPlaceTest : public ::testing::Test {
protected:
  Eigen::Vector3d Vector() {
    return {this->Unit_(this->Random_), this->Unit_(this->Random_), this->Unit_(this->Random_)};
  }
  // Eight points about (1, 2, -9).
  LightHull Hull() {
    LightHull hull;
    for (int i = 0; i < 8; ++i) {
      hull.points.push_back(Eigen::Vector3d(1, 2, -9) + 2.0 * this->Vector());
    }
    return hull;
  }
  // A place within the hull of points.
  Eigen::Vector3d Within(const std::vector<Eigen::Vector3d>& points) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0.0;
    for (const Eigen::Vector3d& point : points) {
      const double weight = 1.0 + this->Unit_(this->Random_);
      sum += weight * point;
      weights += weight;
    }
    return sum / weights;
  }

  Eigen::Matrix3d axes = LightAxes({0.5, -0.3, 0.4});

private:
  std::mt19937 Random_{11};
  std::uniform_real_distribution<double> Unit_{-1.0, 1.0};
};

} // namespace

TEST_F(LightPlaceTest, ItsExtentHoldsItsPointsAndNoMore) {
  LightHull hull = this->Hull();
  hull.radius = 0.25;
  const LightPlace place(axes, hull);
  EXPECT_FALSE(place.Anywhere());
  EXPECT_TRUE(LightPlace(axes, LightHull()).Anywhere());
  const LightPlace::Extent& extent = place.Whole();
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-1e300);
  double nearest = 1e300;
  double farthest = -1e300;
  for (const Eigen::Vector3d& point : hull.points) {
    high = high.cwiseMax(axes * point);
    nearest = std::min(nearest, -point.z());
    farthest = std::max(farthest, -point.z());
  }
  EXPECT_LT((extent.box.max() - high - Eigen::Vector3d::Constant(0.25)).norm(), 1e-12);
  EXPECT_NEAR(place.GetDepths().nearest, nearest - 0.25, 1e-12);
  EXPECT_NEAR(place.GetDepths().farthest, farthest + 0.25, 1e-12);
}

TEST_F(LightPlaceTest, SidesLeaveWhatIsBesideTheHull) {
  const LightHull hull = this->Hull();
  const LightPlace place(axes, hull);
  const LightPlace::Extent& extent = place.Whole();
  ASSERT_GE(extent.sideCount, 3);
  const auto beyond = [&](const Eigen::Vector2d& uv) { // the greatest distance beyond a side
    double most = -1e300;
    for (int i = 0; i < extent.sideCount; ++i) {
      const Eigen::Vector3d& side = extent.sides[std::size_t(i)];
      most = std::max(most, side.head<2>().dot(uv) - side.z());
    }
    return most;
  };
  double nearest = -1e300; // of places within, to a side
  for (int i = 0; i < 200; ++i) {
    EXPECT_LE(beyond((axes * this->Within(hull.points)).head<2>()), 1e-12);
  }
  for (const Eigen::Vector3d& point : hull.points) {
    nearest = std::max(nearest, beyond((axes * point).head<2>()));
  }
  EXPECT_NEAR(nearest, 0.0, 1e-12); // points lie on the sides
  // A metre beyond a side, seen from the middle.
  for (int i = 0; i < extent.sideCount; ++i) {
    const Eigen::Vector3d& side = extent.sides[std::size_t(i)];
    EXPECT_NEAR(side.head<2>().norm(), 1.0, 1e-12);
    EXPECT_GE(beyond((side.z() + 1.0) * side.head<2>()), 1.0 - 1e-12);
  }
}

TEST_F(LightPlaceTest, PlanesAreHeightsAlongTheLight) {
  LightHull hull = this->Hull();
  const Eigen::Vector3d normal = Eigen::Vector3d(0.1, -0.2, 1.0).normalized();
  hull.floor = Eigen::Vector4d(normal.x(), normal.y(), normal.z(), 3.0);
  hull.ceiling = Eigen::Vector4d(-normal.x(), -normal.y(), -normal.z(), 3.0); // faces away
  const LightPlace place(axes, hull);
  EXPECT_FALSE(place.Whole().ceiling);
  ASSERT_TRUE(place.Whole().floor);
  for (int i = 0; i < 20; ++i) {
    Eigen::Vector3d point = 5.0 * this->Vector();
    point -= (normal.dot(point) + 3.0) * normal; // on the plane
    const Eigen::Vector3d light = axes * point;
    const Eigen::Vector3d& floor = *place.Whole().floor;
    EXPECT_NEAR(floor[0] + floor[1] * light.x() + floor[2] * light.y(), light.z(), 1e-12);
  }
}

TEST_F(LightPlaceTest, PartsHoldTheirBoxes) {
  LightHull hull = this->Hull();
  const std::vector<Eigen::AlignedBox3f> parts = {
      {Eigen::Vector3f(-1, -2, -3), Eigen::Vector3f(0, 1, 2)},
      {},
      {Eigen::Vector3f(4, 4, 4), Eigen::Vector3f(5, 6, 7)}};
  hull.parts = &parts;
  const Eigen::Affine3d X_VM =
      Eigen::Translation3d(this->Vector()) * Eigen::AngleAxisd(1.1, this->Vector().normalized());
  hull.X_VM = X_VM.matrix().topRows<3>();
  const LightPlace place(axes, hull);
  ASSERT_EQ(place.Parts().size(), 2u); // an empty box holds nothing
  for (const auto& [part, box] :
       {std::pair(place.Parts()[0], parts[0]), std::pair(place.Parts()[1], parts[2])}) {
    Eigen::AlignedBox3d held;
    double nearest = 1e300;
    double farthest = -1e300;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d corner =
          X_VM * box.corner(Eigen::AlignedBox3f::CornerType(i)).cast<double>();
      held.extend(axes * corner);
      nearest = std::min(nearest, -corner.z());
      farthest = std::max(farthest, -corner.z());
    }
    EXPECT_LT((part.box.min() - held.min()).norm(), 1e-5);
    EXPECT_LT((part.box.max() - held.max()).norm(), 1e-5);
    EXPECT_NEAR(part.depths.nearest, nearest, 1e-5);
    EXPECT_NEAR(part.depths.farthest, farthest, 1e-5);
  }
}
