#include <dspace/scene/staging/Staging.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <dspace/Checks.h>
#include <dspace/import/worker/ModelImport.h>

namespace dspace {

FrameId StageModel(Scene& scene, const std::string& path, const std::string& name, FrameId parent) {
  const auto model = std::make_shared<const Model>(ImportModel(path));
  GraphicsObject object;
  object.name = name;
  object.frame = scene.Frames().Create(parent, name);
  object.levels = {DetailLevel{PartsOf(model)}};
  const FrameId frame = object.frame;
  try {
    scene.AddObject(std::move(object));
  } catch (...) {
    scene.Frames().Remove(frame);
    throw;
  }
  return frame;
}

void StageSun(Scene& scene, const Eigen::Vector3d& towards) {
  if (!towards.allFinite() || towards.stableNorm() == 0.0) {
    Reject("light 'sun'", "the direction towards it is " + VectorText(towards) +
                              "; accepted: finite numbers, not all 0");
  }
  Light sun;
  sun.name = "sun";
  sun.direction = -towards.stableNormalized();
  scene.SetLight(sun);
}

void StageCamera(Scene& scene, const std::string& name, const Eigen::Vector3d& eye,
                 const Eigen::Vector3d& target, const std::string& vantage) {
  Camera camera;
  camera.name = name;
  camera.mount.X_FC = LookAt(name, eye, target, Eigen::Vector3d::UnitZ());
  const std::vector<std::string> names = scene.VantageNames();
  const bool isNew = std::find(names.begin(), names.end(), vantage) == names.end();
  if (isNew) {
    scene.CreateVantage(vantage);
  }
  try {
    scene.SetCamera(vantage, camera);
  } catch (...) {
    if (isNew) {
      scene.RemoveVantage(vantage);
    }
    throw;
  }
}

} // namespace dspace
