#include <dspace/commands/viewports/BuriedCamera.h>

#include <dspace/scene/Scene.h>
#include <dspace/state/TerrainObject.h>

namespace dspace::session {

std::map<std::string, double> GroundsOver(const SceneState& state, const CameraPose& camera) {
  std::map<std::string, double> over;
  const Scene& scene = *state.scene;
  for (const auto& [name, terrain] : state.terrains) {
    const GraphicsObject& object = scene.Object(terrain->Object());
    if (!object.visible || !scene.Fragments().Get(object.fragment).visible) {
      continue;
    }
    const Eigen::Vector3d p_S =
        scene.Frames().RelativePose(object.frame, camera.frame).Apply(camera.X_FC.position);
    const Eigen::Vector3d map = terrain->Surface().SceneToMap(p_S);
    if (!map.allFinite()) {
      continue;
    }
    const SurfaceSample ground = terrain->Surface().SampleMap(map.head<2>());
    if (ground.valid && map.z() < ground.height) {
      over.emplace(name, ground.height - map.z());
    }
  }
  return over;
}

} // namespace dspace::session
