// How surfaces look: each kind of light and material against its formula, and what is see-through.
#include "RenderingTestSupport.h"

#include <functional>

using namespace dspace;

namespace {

// A display value is a step of at most 0.009 in linear light.
constexpr double Step = 0.006;

// A matt wall of 20 m, 10 m ahead of a camera of 21 x 21 pixels that looks along X.
struct ShadingTest : RenderingFixture {
  static constexpr int Size = 21;
  Capture capture;

  std::shared_ptr<Material> material = std::make_shared<Material>();
  ShadingTest() {
    Look({});
    this->material->color = {1, 1, 1};
    this->material->roughness = 1.0; // Lambertian
  }
  ObjectId AddWall(double x = 10) {
    const std::string name = "wall " + std::to_string(x);
    return scene->AddObject(Object(name, scene->Frames().Create(RootFrame, name, At(x, 0, 0)),
                                   PlaneTowardsCamera(20, 20), this->material));
  }
  void SetLight(Light::Kind kind, double intensity) {
    light.name = "light";
    light.kind = kind;
    light.intensity = intensity;
    scene->SetLight(light);
  }
  Light light;

  void Take() { this->capture = View(Size, Size)->GetCapture({true, false, true, false, {}}); }
  double Linear(int x, int y, int channel = 0) const {
    return LinearFromSrgb(this->capture.color[4 * (y * Size + x) + channel] / 255.0);
  }
  // The point of the wall that a pixel shows.
  static Eigen::Vector3d OnWall(int x, int y) {
    const double metres = 10 * std::tan(M_PI / 8) / (0.5 * Size); // a pixel's
    return {10, (10 - x) * metres, (10 - y) * metres};
  }
  void ExpectEverywhere(const std::function<double(const Eigen::Vector3d&)>& formula) {
    this->Take();
    for (int y = 0; y < Size; ++y) {
      for (int x = 0; x < Size; ++x) {
        const double expected = formula(OnWall(x, y));
        if (!std::isnan(expected)) {
          ASSERT_NEAR(this->Linear(x, y), std::min(expected, 1.0), Step) << x << " " << y;
        }
      }
    }
  }
};

} // namespace

TEST_F(ShadingTest, LambertsLawHoldsUnderADirectionalLight) {
  AddWall();
  for (const double angle_deg : {0.0, 30.0, 60.0, 80.0, 100.0}) {
    const double angle = angle_deg * M_PI / 180;
    light.direction = {std::cos(angle), 0, -std::sin(angle)};
    SetLight(Light::Kind::Directional, 0.5);
    ExpectEverywhere([&](const auto&) { return std::max(0.0, 0.5 * std::cos(angle)); });
  }
}

TEST_F(ShadingTest, APointLightFallsOffAsItsAttenuationSays) {
  AddWall();
  light.position = {7, 1, 0.5};
  light.attenuation = {0.5, 0.1, 0.2};
  SetLight(Light::Kind::Point, 2.0);
  ExpectEverywhere([&](const Eigen::Vector3d& p) {
    const double d = (light.position - p).norm();
    return 2.0 * (3.0 / d) / (0.5 + 0.1 * d + 0.2 * d * d);
  });
}

TEST_F(ShadingTest, ASpotLightsItsConeOnly) {
  AddWall();
  light.position = {7, 0.2, 0};
  light.direction = {1, 0, 0};
  light.cone_deg = 35;
  SetLight(Light::Kind::Spot, 0.7);
  ExpectEverywhere([&](const Eigen::Vector3d& p) {
    const double cosine = 3.0 / (light.position - p).norm();
    const double edge = std::cos(light.cone_deg * M_PI / 180);
    return std::abs(cosine - edge) < 1e-3 ? std::nan("") : cosine > edge ? 0.7 * cosine : 0.0;
  });
  EXPECT_GT(Linear(10, 10), 0.6);
  EXPECT_EQ(Linear(0, 0), 0.0);
}

TEST_F(ShadingTest, AHeadLightComesFromTheCameraAndAmbientLightFromEverywhere) {
  AddWall();
  SetLight(Light::Kind::Head, 0.8);
  ExpectEverywhere([](const Eigen::Vector3d& p) { return 0.8 * p.x() / p.norm(); });
  SetLight(Light::Kind::Ambient, 0.3);
  ExpectEverywhere([](const auto&) { return 0.3; });
}

TEST_F(ShadingTest, WhatGlowsAddsToWhatIsLit) {
  material->color = {0.5, 0.5, 0.5};
  material->emissive = {0.6, 0.3, 0};
  AddWall();
  SetLight(Light::Kind::Ambient, 0.4);
  Take();
  const double lit = 0.4 * LinearFromSrgb(0.5);
  EXPECT_NEAR(Linear(10, 10, 0), lit + LinearFromSrgb(0.6), Step);
  EXPECT_NEAR(Linear(10, 10, 1), lit + LinearFromSrgb(0.3), Step);
  EXPECT_NEAR(Linear(10, 10, 2), lit, Step);
}

TEST_F(ShadingTest, MetalsAndGlossReflectAsTheFormulaStraightOn) {
  // With N = L = V: D = 1 / alpha², the visibility is 1/4, and Fresnel's factor is F0.
  SetLight(Light::Kind::Head, 1.0);
  material->color = {0.9, 0.5, 0.2};
  material->metallic = 1.0; // F0 is the colour, nothing is diffuse; alpha 1
  const ObjectId metal = AddWall();
  Take();
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(Linear(10, 10, k), 0.25 * LinearFromSrgb(material->color[k]), Step);
  }
  scene->RemoveObject(metal);
  material = std::make_shared<Material>();
  material->color = {0.5, 0.5, 0.5};
  material->roughness = 0.5; // alpha 1/4; F0 is 0.04
  AddWall(9);
  Take();
  EXPECT_NEAR(Linear(10, 10), 0.96 * LinearFromSrgb(0.5) + 16 * 0.25 * 0.04, Step);
}

TEST_F(ShadingTest, BothSidesAreLitFromTheSideThatIsSeen) {
  Pose away = At(10, 0, 0);
  away.rotation = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ());
  scene->AddObject(Object("back", scene->Frames().Create(RootFrame, "back", away),
                          PlaneTowardsCamera(20, 20), material));
  light.direction = {1, 0, 0};
  SetLight(Light::Kind::Directional, 0.5);
  ExpectEverywhere([](const auto&) { return 0.5; });
  light.direction = {-1, 0, 0};
  SetLight(Light::Kind::Directional, 0.5);
  ExpectEverywhere([](const auto&) { return 0.0; });
}

TEST_F(ShadingTest, ANormalMapTurnsTheNormalsInItsTextureCoordinates) {
  auto image = std::make_shared<Image>();
  image->name = "normals";
  image->width = image->height = 1;
  image->channels = 3;
  material->normalTexture = image;
  const FrameId frame = scene->Frames().Create(RootFrame, "wall", At(10, 0, 0));
  // u runs to the camera's right, -Y, v upwards, Z; not alike, so that the axes are not square.
  for (const Eigen::Vector3d& wanted : {Eigen::Vector3d(0.5, 0, 0.8), Eigen::Vector3d(0, 0.6, 0.8),
                                        Eigen::Vector3d(-0.4, 0.3, 0.9)}) {
    for (const double scale : {1.0, 0.5}) {
      const Eigen::Vector3d bytes = ((wanted * 0.5).array() + 0.5) * 255.0;
      image->pixels = {std::uint8_t(bytes.x()), std::uint8_t(bytes.y()), std::uint8_t(bytes.z())};
      // A new one, since a mesh and its images do not change.
      auto made = std::make_shared<Material>(*material);
      made->normalTexture = std::make_shared<Image>(*image);
      made->normalScale = scale;
      const ObjectId id = scene->AddObject(Object("wall", frame, PlaneTowardsCamera(20, 12), made));
      Eigen::Vector3d n;
      for (int k = 0; k < 3; ++k) {
        n[k] = (image->pixels[std::size_t(k)] / 255.0 * 2.0 - 1.0) * (k < 2 ? scale : 1.0);
      }
      const Eigen::Vector3d N = Eigen::Vector3d(-n.z(), -n.x(), n.y()).normalized();
      for (const Eigen::Vector3d& direction :
           {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.6, 0.8, 0),
            Eigen::Vector3d(0.6, 0, -0.8)}) {
        light.direction = direction;
        SetLight(Light::Kind::Directional, 0.5);
        Take();
        const double expected = 0.5 * std::max(0.0, -direction.dot(N));
        for (const int x : {7, 10, 13}) { // 2 of 255 display steps are at most 0.018 here
          EXPECT_NEAR(Linear(x, 10), expected, 2 * Step) << wanted.transpose() << ", " << scale;
        }
      }
      scene->RemoveObject(id);
    }
  }
  // Without one, or without texture coordinates, the surface is as it was.
  light.direction = {1, 0, 0};
  SetLight(Light::Kind::Directional, 0.5);
  Mesh bare = PlaneTowardsCamera(20, 20);
  bare.tcoords.clear();
  scene->AddObject(Object("wall", frame, bare, material));
  ExpectEverywhere([](const auto&) { return 0.5; });
}

TEST_F(ShadingTest, VertexColoursMultiplyInLinearLight) {
  Mesh mesh = PlaneTowardsCamera(20, 20);
  for (std::size_t i = 0; i < mesh.VertexCount(); ++i) {
    mesh.colors.insert(mesh.colors.end(), {128, 64, 255, 255});
  }
  scene->AddObject(Object("wall", scene->Frames().Create(RootFrame, "wall", At(10, 0, 0)), mesh,
                          Unlit({0.5, 1, 0.8})));
  Take();
  EXPECT_NEAR(Linear(10, 10, 0), LinearFromSrgb(0.5) * LinearFromSrgb(128 / 255.0), Step);
  EXPECT_NEAR(Linear(10, 10, 1), LinearFromSrgb(64 / 255.0), Step);
  EXPECT_NEAR(Linear(10, 10, 2), LinearFromSrgb(0.8), Step);
}

TEST_F(ShadingTest, GlassShowsInFrontOfAWallAndNotBehindIt) {
  const auto glassAt = [&](double x) {
    const std::string name = "glass " + std::to_string(x);
    return scene->AddObject(Object(name, scene->Frames().Create(RootFrame, name, At(x, 0, 0)),
                                   PlaneTowardsCamera(20, 20), Unlit({0, 1, 0}, 0.25)));
  };
  scene->AddObject(Object("wall", scene->Frames().Create(RootFrame, "wall", At(10, 0, 0)),
                          PlaneTowardsCamera(20, 20), Unlit({1, 0, 0})));
  glassAt(12);
  Take();
  EXPECT_EQ(Linear(10, 10, 0), 1.0);
  EXPECT_EQ(Linear(10, 10, 1), 0.0);
  glassAt(8);
  Take();
  EXPECT_NEAR(Linear(10, 10, 0), 0.75, Step);
  EXPECT_NEAR(Linear(10, 10, 1), 0.25, Step);
}

TEST_F(ShadingTest, WhatATextureCutsOutIsNeitherSeenNorPicked) {
  auto image = std::make_shared<Image>();
  image->name = "half";
  image->width = 2;
  image->height = 1;
  image->channels = 4;
  image->pixels = {255, 255, 255, 0, 255, 255, 255, 255}; // the left half is not there
  material->texture = image;
  material->repeatTexture = false;
  material->lit = false;
  const ObjectId id = scene->AddObject(
      Object("sheet", scene->Frames().Create(RootFrame, "sheet", At(10, 0, 0)),
             PlaneTowardsCamera(6, 6), material)); // 15 pixels wide, about the middle
  Take();
  EXPECT_EQ(Linear(4, 10), 0.0);
  EXPECT_EQ(capture.label[10 * Size + 4], 0u);
  EXPECT_EQ(Linear(16, 10), 1.0);
  EXPECT_EQ(capture.label[10 * Size + 16], id);
}

TEST_F(ShadingTest, TheBackgroundRunsFromBottomToTop) {
  auto viewport = View(Size, Size);
  viewport->SetBackground({0.1, 0.2, 0.3}, {0.9, 0.6, 0.3});
  const Capture gradient = viewport->GetCapture({});
  for (int y = 0; y < Size; ++y) {
    const double up = (Size - 0.5 - y) / Size;
    const std::uint8_t* pixel = &gradient.color[4 * (y * Size + 3)];
    EXPECT_NEAR(pixel[0], 255 * (0.1 + 0.8 * up), 1);
    EXPECT_NEAR(pixel[1], 255 * (0.2 + 0.4 * up), 1);
    EXPECT_NEAR(pixel[2], 255 * 0.3, 1);
    EXPECT_EQ(pixel[3], 255);
  }
}

TEST_F(ShadingTest, WhatNobodyShowsLeavesTheGpu) {
  AddWall();
  auto viewport = View(Size, Size);
  viewport->GetCapture({});
  const auto bytes = context->GetStatistics().meshBytes;
  const ObjectId second = AddWall(11);
  viewport->GetCapture({});
  EXPECT_GT(context->GetStatistics().meshBytes, bytes);
  scene->RemoveObject(second);
  viewport->GetCapture({});
  EXPECT_EQ(context->GetStatistics().meshBytes, bytes);
}
