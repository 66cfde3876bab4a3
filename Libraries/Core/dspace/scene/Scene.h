// One scene: its frames, objects, fragments, lights and vantages, free of VTK and OpenGL.
#ifndef DSPACE_SCENE_SCENE_H
#define DSPACE_SCENE_SCENE_H

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include <dspace/FrameTree.h>
#include <dspace/scene/GraphicsObject.h>
#include <dspace/scene/NumberedNames.h>
#include <dspace/scene/SceneFragmentManager.h>
#include <dspace/scene/SceneViews.h>

namespace dspace {

// Every change goes through the scene (or Frames()), is checked completely before it is made, and
// increases Revision(). Setting an object, a fragment or the time to its current value is no
// change. Errors name the object, the value and what is accepted. Names are not empty and have no
// control characters.
// Not synchronised.
class Scene {
public:
  explicit Scene(std::string name);
  const std::string& Name() const { return this->Name_; }

  FrameTree& Frames() { return this->Frames_; }
  const FrameTree& Frames() const { return this->Frames_; }
  // Removes a frame with its subtree and the objects and lights on it. Rejected while a camera is
  // attached to it or follows it. (Use Frames().Remove() only for frames without any of these.)
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
  // `wanted`, or with " 2", " 3", ... appended the first name that no object has. Amortised
  // logarithmic time.
  std::string FreeObjectName(const std::string& wanted) const;
  const std::map<ObjectId, GraphicsObject>& Objects() const { return this->Objects_; }
  void SetObjectVisible(ObjectId id, bool visible);
  void SetObjectMaterial(ObjectId id, const MaterialOverride& material);
  // Overrides of the parts of this name. Throws Error(NotFound) that lists names if no part has it.
  void SetPart(ObjectId id, const std::string& part, const PartOverride& over);
  void SetObjectShader(ObjectId id, std::shared_ptr<const ShaderCode> shader); // null: none
  void SetObjectOffset(ObjectId id, const Eigen::Affine3d& X_FO);
  void AttachObject(ObjectId id, FrameId frame);
  void MoveToFragment(ObjectId id, const std::string& fragment);
  void SetObjectLevels(ObjectId id, std::vector<DetailLevel> levels);

  const SceneFragmentManager& Fragments() const { return this->Fragments_; }
  void CreateFragment(const std::string& name, Nature nature);
  void RemoveFragment(const std::string& name);
  // What parts of objects are in the fragment: "contours of object 'gale'".
  std::vector<std::string> MembersOf(const std::string& fragment) const;
  void SetFragmentVisible(const std::string& name, bool visible);
  void SetLight(const Light& light);
  void RemoveLight(const std::string& name);

  void CreateVantage(const std::string& name);
  void RemoveVantage(const std::string& name);
  const SceneVantage& Vantage(const std::string& name) const; // throws Error(NotFound)
  std::vector<std::string> VantageNames() const { return this->Views_.Names(); }
  void SetCamera(const std::string& vantage, const Camera& camera);
  void RemoveCamera(const std::string& vantage, const std::string& camera);
  void SetActiveCamera(const std::string& vantage, const std::string& camera);

  // Returns the current pose of a camera of a vantage ("": the active one). It depends only on the
  // commands so far, not on how often or from how many viewports it is requested.
  CameraPose PlaceCamera(const std::string& vantage, const std::string& camera = {}) const {
    return this->Views_.Place(vantage, camera);
  }

  // Simulation time [s]: TDB since J2000 or any other monotonic time. Smoothing depends on it.
  // Poses set after SetTime(t) belong to t. A step back restarts all lags.
  void SetTime(double time_s);
  double Time() const { return this->Views_.Time(); }

  // Lag states of smoothed chase cameras, by vantage and camera, to restore a scene. SetLags throws
  // Error(NotFound) for an unknown camera.
  using Lags = SceneViews::Lags;
  const Lags& GetLags() const { return this->Views_.GetLags(); }
  void SetLags(Lags lags);

  // Increases with every change of anything above, including poses.
  std::uint64_t Revision() const;
  // Increases with changes of objects, fragments and lights only (not poses, cameras or time).
  std::uint64_t ContentRevision() const { return this->ContentRevision_; }

private:
  // Meshes that passed the check and still exist: an instance is not checked again.
  class MeshRegister {
  public:
    void Check(const std::shared_ptr<const Mesh>& mesh, const std::string& object);

  private:
    std::map<const Mesh*, std::weak_ptr<const Mesh>> Good_;
    std::size_t PruneAt_ = 256;
  };

  GraphicsObject& Find(ObjectId id);
  void RequireFrame(const std::string& object, FrameId frame) const;
  void CheckLevels(const std::string& object, std::vector<DetailLevel>& levels);
  void ContentChanged();

  std::string Name_;
  FrameTree Frames_;
  SceneFragmentManager Fragments_;
  std::map<ObjectId, GraphicsObject> Objects_;
  std::map<std::string, ObjectId> ObjectNames_;
  mutable NumberedNames NumberedNames_; // what is known of them, for FreeObjectName
  ObjectId LargestObject_ = 0;
  std::unordered_set<ObjectId> RetiredObjects_; // ids of removed objects
  MeshRegister Meshes_;
  std::vector<std::shared_ptr<const CustomGeometry>> Customs_; // of the objects
  SceneViews Views_;
  std::uint64_t Revision_ = 1;
  std::uint64_t ContentRevision_ = 1;
};

} // namespace dspace

#endif
