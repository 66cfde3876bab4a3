// The fragments and lights of one scene.
#ifndef DSPACE_SCENE_SCENE_FRAGMENT_MANAGER_H
#define DSPACE_SCENE_SCENE_FRAGMENT_MANAGER_H

#include <string>
#include <vector>

#include <dspace/scene/GraphicsObject.h>
#include <dspace/scene/Light.h>

namespace dspace {

// A named group of objects that is shown or hidden as one.
struct SceneFragment {
  std::string name;
  Nature nature = Nature::Physical;
  bool visible = true;           // default; a viewport or a request can hide it locally
  std::vector<ObjectId> objects; // in order of addition
};

// The fragments of one scene, and its lights, which light all of it.
// Two fragments always exist: "physical" and "ornamental".
class SceneFragmentManager {
public:
  SceneFragmentManager();
  // Throws Error(AlreadyExists, InvalidArgument).
  void Create(const std::string& name, Nature nature);
  // The fragment must be empty and not one of the two that always exist.
  void Remove(const std::string& name);
  void SetVisible(const std::string& name, bool visible);
  const SceneFragment& Get(const std::string& name) const; // throws Error(NotFound)
  bool Contains(const std::string& name) const;
  // The membership of something in a fragment; an empty name means the one of the nature. Throws
  // Error about `object`: NotFound, InvalidArgument for a fragment of the other nature.
  Membership Member(const std::string& object, Nature nature, const std::string& fragment) const;
  std::vector<std::string> Names() const; // in creation order

  // Lights, by unique name.
  void SetLight(const Light& light); // creates or replaces; throws Error(InvalidArgument)
  void RemoveLight(const std::string& name);
  const std::vector<Light>& Lights() const { return this->Lights_; }

private:
  friend class Scene;
  SceneFragment& Find(const std::string& name);
  std::vector<SceneFragment> Fragments_;
  std::vector<Light> Lights_;
};

} // namespace dspace

#endif
