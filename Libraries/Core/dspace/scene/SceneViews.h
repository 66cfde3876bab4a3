// The vantages of one scene, and the lags of their chase cameras in simulation time.
#ifndef DSPACE_SCENE_SCENE_VIEWS_H
#define DSPACE_SCENE_SCENE_VIEWS_H

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <dspace/scene/SceneVantage.h>

namespace dspace {

// See the functions of the same purpose in Scene.
class SceneViews {
public:
  // `scene` names the scene in messages; `frames` must outlive this.
  SceneViews(std::string scene, const FrameTree& frames);

  void Create(const std::string& name);
  void Remove(const std::string& name);
  const SceneVantage& Get(const std::string& name) const; // throws Error(NotFound)
  std::vector<std::string> Names() const;

  // The camera's frame exists.
  void SetCamera(const std::string& vantage, const Camera& camera);
  void RemoveCamera(const std::string& vantage, const std::string& camera);
  bool SetActiveCamera(const std::string& vantage, const std::string& camera); // whether it changed
  CameraPose Place(const std::string& vantage, const std::string& camera) const;
  // Throws Error(InvalidArgument) if a camera is attached to a frame of `subtree` or follows one.
  // `removed` is the top of the subtree.
  void RejectWhileCamerasOn(FrameId removed, const std::vector<FrameId>& subtree) const;

  bool SetTime(double time_s); // whether it changed
  double Time() const { return this->Time_; }
  using Lags = std::map<std::pair<std::string, std::string>, ChaseState>;
  const Lags& GetLags() const { return this->Lags_; }
  void SetLags(Lags lags);

private:
  SceneVantage& Find(const std::string& name);

  std::string Scene_;
  const FrameTree& Frames_;
  std::vector<SceneVantage> Vantages_;
  Lags Lags_; // of chase and pointing cameras at the time before the present one, by vantage and
              // camera
  double Time_ = 0.0;
};

} // namespace dspace

#endif
