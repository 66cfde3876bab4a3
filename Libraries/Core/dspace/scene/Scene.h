// One scene: its frames, objects, fragments, lights and vantages, free of VTK and OpenGL.
#ifndef DSPACE_SCENE_SCENE_H
#define DSPACE_SCENE_SCENE_H

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include <dspace/FrameTree.h>
#include <dspace/scene/Camera.h>
#include <dspace/scene/GraphicsObject.h>
#include <dspace/scene/Light.h>

namespace dspace {

// A named group of objects that is shown or hidden as one.
struct SceneFragment {
  std::string name;
  Nature nature = Nature::Physical;
  bool visible = true;           // everywhere; a viewport or a request hides it for itself
  std::vector<ObjectId> objects; // in the order they came
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

// Every change goes through the scene (or Frames()), is checked whole before it is made, and
// raises Revision(); setting what an object, a fragment or the time
// already is, is no change. Errors name the object, the value and
// what would be accepted. Names are not empty and hold no control characters.
// Not synchronised.
class Scene {
public:
  explicit Scene(std::string name);
  const std::string& Name() const { return this->Name_; }

  FrameTree& Frames() { return this->Frames_; }
  const FrameTree& Frames() const { return this->Frames_; }
  // Removes a frame with its subtree, the objects and the lights on it. Refused while a camera
  // stands on it or follows it. (Frames().Remove() is for frames on which nothing of the scene
  // hangs.)
  void RemoveFrame(FrameId frame);

  // Adds an object; id 0 takes the one after the largest ever used, another, at most 2^31 - 1, is
  // taken as it is. An empty fragment means the one of its nature. Throws Error: AlreadyExists
  // (name; id in use now or ever), NotFound (frame, fragment), InvalidArgument (natures that
  // differ, numbers out of range, levels without descending minimumPixels, damaged meshes or
  // materials).
  ObjectId AddObject(GraphicsObject object);
  void RemoveObject(ObjectId id);
  const GraphicsObject& Object(ObjectId id) const;    // throws Error(NotFound)
  ObjectId FindObject(const std::string& name) const; // 0 when there is none
  const std::map<ObjectId, GraphicsObject>& Objects() const { return this->Objects_; }
  void SetObjectVisible(ObjectId id, bool visible);
  void SetObjectMaterial(ObjectId id, const MaterialOverride& material);
  void SetObjectOffset(ObjectId id, const Eigen::Affine3d& X_FO);
  void AttachObject(ObjectId id, FrameId frame);
  void MoveToFragment(ObjectId id, const std::string& fragment);
  void SetObjectLevels(ObjectId id, std::vector<DetailLevel> levels);

  const SceneFragmentManager& Fragments() const { return this->Fragments_; }
  void CreateFragment(const std::string& name, Nature nature);
  void RemoveFragment(const std::string& name);
  void SetFragmentVisible(const std::string& name, bool visible);
  void SetLight(const Light& light);
  void RemoveLight(const std::string& name);

  void CreateVantage(const std::string& name);
  void RemoveVantage(const std::string& name);
  const SceneVantage& Vantage(const std::string& name) const; // throws Error(NotFound)
  std::vector<std::string> VantageNames() const;
  void SetCamera(const std::string& vantage, const Camera& camera);
  void RemoveCamera(const std::string& vantage, const std::string& camera);
  void SetActiveCamera(const std::string& vantage, const std::string& camera);

  // Where a camera of a vantage stands now ("": the active one): a function of the commands given
  // so far, however often and from however many viewports it is asked.
  CameraPose PlaceCamera(const std::string& vantage, const std::string& camera = {}) const;

  // Simulation time [s], TDB past J2000 or any other that only grows; smoothing depends on it.
  // Poses set after SetTime(t) are those of t. A step back starts all lags anew.
  void SetTime(double time_s);
  double Time() const { return this->Time_; }

  // What chase cameras with smoothing go on from, by vantage and camera, for whoever brings a scene
  // back to a state. SetLags throws Error(NotFound) for a camera that is not there.
  using Lags = std::map<std::pair<std::string, std::string>, ChaseState>;
  const Lags& GetLags() const { return this->Lags_; }
  void SetLags(Lags lags);

  // Raised by every change of anything above, poses included.
  std::uint64_t Revision() const;
  // Raised by changes of objects, fragments and lights only (not poses, cameras or time).
  std::uint64_t ContentRevision() const { return this->ContentRevision_; }

private:
  // Meshes that were found good and still live: an instance costs no second look.
  class MeshRegister {
  public:
    void Check(const std::shared_ptr<const Mesh>& mesh, const std::string& object);

  private:
    std::map<const Mesh*, std::weak_ptr<const Mesh>> Good_;
    std::size_t PruneAt_ = 256;
  };

  GraphicsObject& Find(ObjectId id);
  SceneVantage& FindVantage(const std::string& name);
  void RequireFrame(const std::string& object, FrameId frame) const;
  void CheckLevels(const std::string& object, std::vector<DetailLevel>& levels);
  void RefuseWhileCamerasOn(FrameId removed, const std::vector<FrameId>& subtree) const;
  void ContentChanged();

  std::string Name_;
  FrameTree Frames_;
  SceneFragmentManager Fragments_;
  std::map<ObjectId, GraphicsObject> Objects_;
  std::map<std::string, ObjectId> ObjectNames_;
  ObjectId LargestObject_ = 0;
  std::unordered_set<ObjectId> RetiredObjects_; // ids of removed objects
  MeshRegister Meshes_;
  std::vector<std::shared_ptr<const CustomGeometry>> Customs_; // of the objects
  std::vector<SceneVantage> Vantages_;
  // Lags of chase cameras at the time before the present one, by vantage and camera.
  Lags Lags_;
  double Time_ = 0.0;
  std::uint64_t Revision_ = 1;
  std::uint64_t ContentRevision_ = 1;
};

} // namespace dspace

#endif
