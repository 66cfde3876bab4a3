// The Sun as a place of a scene sees it.
#include <gtest/gtest.h>

#include <cmath>

#include <dspace/scene/Scene.h>
#include <dspace/scene/bodies/CelestialBody.h>
#include <dspace/scene/bodies/SunSeen.h>

namespace dspace {
namespace {

struct SunSeenTest : ::testing::Test {
  Scene scene{"scene"};

  ObjectId Add(const std::string& name, const Eigen::Vector3d& place, double radius,
               bool sun = false, bool eclipses = true) {
    BodyShape shape;
    shape.radii.setConstant(radius);
    shape.sun = sun;
    shape.eclipses = eclipses;
    GraphicsObject object;
    object.name = name;
    object.custom = std::make_shared<CelestialBody>(name, shape);
    Pose pose;
    pose.position = 0.5 * place; // the rest is the object's own offset
    object.frame = scene.Frames().Create(RootFrame, name, pose);
    object.X_FO.translation() = 0.5 * place;
    return scene.AddObject(object);
  }
};

TEST_F(SunSeenTest, WithoutASunThereIsNone) {
  Add("moon", {4e8, 0, 0}, 1.7e6);
  EXPECT_FALSE(SunlitBodies(scene).From({0, 0, 0}));
  EXPECT_EQ(FindSunBody(scene), nullptr);
}

TEST_F(SunSeenTest, ABodyOfHalfTheSunsAngleLeavesThreeQuarters) {
  const Eigen::Vector3d here(1e3, 2e3, -3e3);
  const Eigen::Vector3d ahead = Eigen::Vector3d(1, 2, 2).normalized();
  const ObjectId sun = Add("sun", here + 1.5e11 * ahead, 7e8, true);
  const double half = std::asin(0.5 * std::tan(std::asin(7e8 / 1.5e11)));
  const ObjectId moon = Add("moon", here + 4e8 * ahead, 4e8 * std::sin(half));
  Add("dust", here + 3e8 * ahead, 1e6, false, false); // eclipses nothing
  const auto seen = SunlitBodies(scene).From(here);
  ASSERT_TRUE(seen);
  EXPECT_NEAR((seen->towards_R - ahead).norm(), 0.0, 1e-12);
  EXPECT_NEAR(seen->left, 0.75, 1e-4); // sines for tangents
  EXPECT_NEAR(std::sin(seen->radius), 7e8 / 1.5e11, 1e-15);
  EXPECT_NEAR(seen->square, std::pow(1.495978707 / 1.5, 2), 1e-12);
  EXPECT_EQ(SunlitBodies(scene).From(here + Eigen::Vector3d(0, 1e7, -1e7))->left, 1.0); // beside it
  scene.SetObjectVisible(moon, false);
  EXPECT_EQ(SunlitBodies(scene).From(here)->left, 1.0);
  scene.SetObjectVisible(sun, false);
  EXPECT_FALSE(SunlitBodies(scene).From(here));
  ASSERT_TRUE(FindSunBody(scene)); // hidden
  EXPECT_EQ(FindSunBody(scene)->name, "sun");
}

} // namespace
} // namespace dspace
