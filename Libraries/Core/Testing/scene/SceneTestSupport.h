// What the tests of scenes share: simple objects, cameras and lights, a scene, and rejections.
#ifndef DSPACE_CORE_TESTING_SCENE_TEST_SUPPORT_H
#define DSPACE_CORE_TESTING_SCENE_TEST_SUPPORT_H

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/scene/Scene.h>

namespace dspace {

inline std::shared_ptr<Mesh> Triangle() {
  auto mesh = std::make_shared<Mesh>();
  mesh->name = "triangle";
  mesh->positions = {0, 0, 0, 2, 0, 0, 0, 2, 0};
  mesh->indices = {0, 1, 2};
  return mesh;
}

inline GraphicsObject Object(const std::string& name, Nature nature = Nature::Physical) {
  GraphicsObject object;
  object.name = name;
  object.nature = nature;
  object.levels = {{{{Triangle(), nullptr, Eigen::Affine3d::Identity()}}, 0.0}};
  return object;
}

inline Camera Fixed(const std::string& name, FrameId frame) {
  Camera camera;
  camera.name = name;
  camera.mount.frame = frame;
  return camera;
}

inline Light Lamp(const std::string& name, FrameId frame) {
  Light light;
  light.name = name;
  light.frame = frame;
  return light;
}

// All that can be seen of a scene, as text.
inline std::string Describe(const Scene& scene) {
  std::string text;
  const auto add = [&](const auto& part) { text += part + std::string(" "); };
  for (const auto& entry : scene.Objects()) {
    const GraphicsObject& object = entry.second;
    add(std::to_string(entry.first) + object.name + std::to_string(object.frame) + object.fragment +
        std::to_string(object.levels.size()) + std::to_string(object.visible) +
        std::to_string(object.material.opacity.value_or(-1)) + std::to_string(object.X_FO(0, 3)));
  }
  for (const std::string& name : scene.Fragments().Names()) {
    const SceneFragment& fragment = scene.Fragments().Get(name);
    add(name + std::to_string(int(fragment.nature)) + std::to_string(fragment.visible));
    for (const ObjectId id : fragment.objects) {
      add(std::to_string(id));
    }
  }
  for (const Light& light : scene.Fragments().Lights()) {
    add(light.name + std::to_string(light.frame) + std::to_string(light.intensity));
  }
  for (const std::string& name : scene.VantageNames()) {
    add(name);
    for (const std::string& camera : scene.Vantage(name).CameraNames()) {
      const Camera& c = scene.Vantage(name).GetCamera(camera);
      add(camera + std::to_string(c.mount.frame) + std::to_string(c.projection.verticalFov_deg) +
          (scene.Vantage(name).ActiveCamera().name == camera ? "!" : ""));
    }
  }
  return text + std::to_string(scene.Frames().Size()) + " " + std::to_string(scene.Time()) + " " +
         std::to_string(scene.Revision()) + " " + std::to_string(scene.ContentRevision());
}

// `f` must throw `kind` with `word` in its message and change nothing.
inline void ExpectRejected(Scene& scene, Error::Kind kind, const std::string& word,
                           const std::function<void()>& f) {
  const std::string before = Describe(scene);
  try {
    f();
    ADD_FAILURE() << "accepted; expected an error with '" << word << "'";
  } catch (const Error& e) {
    EXPECT_EQ(e.GetKind(), kind) << e.what();
    EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
  EXPECT_EQ(Describe(scene), before);
}

constexpr auto Invalid = Error::Kind::InvalidArgument;
constexpr auto NotFound = Error::Kind::NotFound;
constexpr auto Exists = Error::Kind::AlreadyExists;
inline const double NaN = std::numeric_limits<double>::quiet_NaN();

class SceneTest : public testing::Test {
protected:
  void SetUp() override {
    this->Rover = this->S.Frames().Create(RootFrame, "rover");
    this->Mast = this->S.Frames().Create(this->Rover, "mast");
    GraphicsObject body = Object("body");
    body.frame = this->Rover;
    this->Body = this->S.AddObject(body);
    this->S.CreateVantage("main");
    this->S.SetCamera("main", Fixed("first", RootFrame));
  }
  Scene S{"mission"};
  FrameId Rover = 0, Mast = 0;
  ObjectId Body = 0;
};

} // namespace dspace

#endif
