// Lights of exported scenes, opened by assimp.
#include "ExportTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

using ExportLightsTest = SceneExportTest;

// A light of intensity 1 shows a white matt surface as 1, and E lux (or E candela at 1 m) as E /
// pi.
TEST_F(ExportLightsTest, LightsAreAsBrightAsInTheScene) {
  const FrameId base =
      this->S.Frames().Create(RootFrame, "base", Turned(1, 2, 3, 50, {1, -2, 3}, 2));
  this->Add("ground", MakeBox({20, 20, 2})); // its middle is the origin
  Light sun;
  sun.name = "sun";
  sun.frame = base;
  sun.direction = {0.3, -2, -0.5};
  sun.color = {1.0, 0.5, 0.25};
  sun.intensity = 3;
  this->S.SetLight(sun);
  Light lamp;
  lamp.name = "lamp";
  lamp.kind = Light::Kind::Point;
  lamp.frame = base;
  lamp.position = {4, 5, 6};
  lamp.attenuation = {0, 0, 0.5};
  lamp.intensity = 7;
  this->S.SetLight(lamp);
  Light spot = lamp;
  spot.name = "spot";
  spot.kind = Light::Kind::Spot;
  spot.direction = {0, 1, 0};
  spot.cone_deg = 20;
  spot.attenuation = {2, 0.1, 0.03};
  this->S.SetLight(spot);
  Light other = sun;
  other.name = "dark";
  other.enabled = false;
  this->S.SetLight(other);
  other.name = "sky";
  other.enabled = true;
  other.kind = Light::Kind::Ambient;
  other.intensity = 0.5;
  this->S.SetLight(other);
  other.name = "flash";
  other.kind = Light::Kind::Head;
  this->S.SetLight(other);
  const std::vector<std::string> warnings = this->Export();
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("light 'spot' falls off by 1 / (2 + 0.1 d + 0.03 d^2)"),
            std::string::npos)
      << warnings[0];
  EXPECT_NE(warnings[1].find("light 'flash' is left out"), std::string::npos) << warnings[1];

  const ExportedFile file(this->Path);
  ASSERT_EQ(file.Scene->mNumLights, 3u);
  const Pose& X = this->S.Frames().WorldPose(base);
  const auto light = [&](const std::string& name) -> const aiLight& {
    for (unsigned i = 0; i < file.Scene->mNumLights; ++i) {
      if (file.Scene->mLights[i]->mName == aiString(name)) {
        return *file.Scene->mLights[i];
      }
    }
    throw std::runtime_error("no light '" + name + "'");
  };
  const auto shines = [&](const std::string& name) -> Eigen::Vector3d {
    return (file.World(file.Node(name)).linear() * Eigen::Vector3d(0, 0, -1)).normalized();
  };
  const auto place = [&](const std::string& name) -> Eigen::Vector3d {
    return file.World(file.Node(name)).translation();
  };
  EXPECT_STREQ(file.Node("sun").mParent->mName.C_Str(), "base");
  EXPECT_EQ(light("sun").mType, aiLightSource_DIRECTIONAL);
  EXPECT_LT((shines("sun") - YUp(X.rotation * sun.direction.normalized())).norm(), 1e-6);
  EXPECT_NEAR(light("sun").mColorDiffuse.r, M_PI * 3, 1e-5);
  EXPECT_NEAR(light("sun").mColorDiffuse.g, M_PI * 3 * Linear(0.5), 1e-5);
  EXPECT_NEAR(light("sun").mColorDiffuse.b, M_PI * 3 * Linear(0.25), 1e-5);
  EXPECT_EQ(light("lamp").mType, aiLightSource_POINT);
  EXPECT_LT((place("lamp") - YUp(X.Apply(lamp.position))).norm(), 1e-5);
  EXPECT_NEAR(light("lamp").mColorDiffuse.r, M_PI * 7 / 0.5, 1e-4);
  EXPECT_EQ(light("spot").mType, aiLightSource_SPOT);
  EXPECT_LT((shines("spot") - YUp(X.rotation * spot.direction)).norm(), 1e-6);
  EXPECT_NEAR(light("spot").mAngleOuterCone, 20 * M_PI / 180, 1e-6);
  EXPECT_LT(light("spot").mAngleInnerCone, light("spot").mAngleOuterCone);
  EXPECT_GT(light("spot").mAngleInnerCone, 0.99 * light("spot").mAngleOuterCone);
  const double d = X.Apply(spot.position).norm(); // where both fall-offs agree
  EXPECT_NEAR(light("spot").mColorDiffuse.r / M_PI / (d * d), 7 / (2 + 0.1 * d + 0.03 * d * d),
              1e-5);

  SceneExportOptions options;
  options.lights = false;
  EXPECT_TRUE(this->Export(options).empty());
  EXPECT_EQ(ExportedFile(this->Path).Scene->mNumLights, 0u);
}
