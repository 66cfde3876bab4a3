// One view of a scene: cameras, of which one is active.
#ifndef DSPACE_SCENE_SCENE_VANTAGE_H
#define DSPACE_SCENE_SCENE_VANTAGE_H

#include <string>
#include <utility>
#include <vector>

#include <dspace/scene/Camera.h>

namespace dspace {

// One SceneFragmentManager seen through one of its cameras; one camera is active.
class SceneVantage {
public:
  explicit SceneVantage(std::string name) : Name_(std::move(name)) {}
  const std::string& Name() const { return this->Name_; }
  // Creates or replaces; the first camera becomes the active one. Checked before anything changes.
  void SetCamera(const Camera& camera);
  void RemoveCamera(const std::string& name); // not the active one, unless it is the last
  void SetActiveCamera(const std::string& name);
  const Camera& GetCamera(const std::string& name) const; // throws Error(NotFound)
  const Camera& ActiveCamera() const;                     // throws Error(NotFound) without any
  std::vector<std::string> CameraNames() const;

private:
  std::string Name_;
  std::string Active_;
  std::vector<Camera> Cameras_;
};

} // namespace dspace

#endif
