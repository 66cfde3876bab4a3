// Scenes that are filled in a few lines.
#include <gtest/gtest.h>

#include <dspace/scene/staging/Staging.h>

#include "SceneTestSupport.h"

namespace dspace {
namespace {

std::string SeedPath(const std::string& name) {
  return std::string(DSPACE_SEEDS) + "/" + name;
}

TEST(Staging, AModelASunAndACamera) {
  Scene scene("s");
  const FrameId frame = StageModel(scene, SeedPath("text.stl"), "part");
  EXPECT_EQ(scene.Frames().Name(frame), "part");
  EXPECT_EQ(scene.Frames().Parent(frame), RootFrame);
  ASSERT_EQ(scene.Objects().size(), 1u);
  EXPECT_EQ(scene.Objects().begin()->second.name, "part");
  EXPECT_EQ(scene.Objects().begin()->second.frame, frame);
  StageSun(scene, {0, 0, 7});
  StageSun(scene, {-3, 0, 4}); // the same light
  ASSERT_EQ(scene.Fragments().Lights().size(), 1u);
  const Light& sun = scene.Fragments().Lights()[0];
  EXPECT_TRUE(sun.direction.isApprox(Eigen::Vector3d(0.6, 0, -0.8)));
  EXPECT_EQ(sun.intensity, 1.0);
  StageCamera(scene, "eye", {0, -5, 0}, {0, 0, 0});
  StageCamera(scene, "eye", {5, 0, 0}, {0, 0, 0});
  StageCamera(scene, "other", {5, 0, 0}, {0, 0, 0}, "second");
  const Pose X_RC = scene.PlaceCamera("main", "eye").X_FC;
  EXPECT_TRUE(X_RC.position.isApprox(Eigen::Vector3d(5, 0, 0)));
  EXPECT_TRUE((X_RC.rotation * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d(-1, 0, 0)));
  EXPECT_TRUE((X_RC.rotation * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d(0, 0, -1)));
  EXPECT_EQ(scene.VantageNames(), (std::vector<std::string>{"main", "second"}));
}

TEST(Staging, WhatIsRejectedLeavesTheScene) {
  Scene scene("s");
  EXPECT_THROW(StageModel(scene, SeedPath("absent.stl"), "part"), Error);
  EXPECT_EQ(scene.Frames().Find("part"), NoFrame);
  StageModel(scene, SeedPath("text.stl"), "part");
  EXPECT_THROW(StageModel(scene, SeedPath("text.stl"), "part"), Error);
  EXPECT_EQ(scene.Objects().size(), 1u);
  EXPECT_THROW(StageSun(scene, {0, 0, 0}), Error);
  EXPECT_THROW(StageSun(scene, {0, std::nan(""), 1}), Error);
  EXPECT_TRUE(scene.Fragments().Lights().empty());
  EXPECT_THROW(StageCamera(scene, "eye", {1, 1, 1}, {1, 1, 1}), Error);
  EXPECT_THROW(StageCamera(scene, "eye", {0, 0, 5}, {0, 0, 0}), Error); // straight down
  EXPECT_THROW(StageCamera(scene, "", {5, 0, 0}, {0, 0, 0}), Error);
  EXPECT_TRUE(scene.VantageNames().empty());
}

} // namespace
} // namespace dspace
