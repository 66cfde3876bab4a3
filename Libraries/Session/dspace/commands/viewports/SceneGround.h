// The terrains of a scene as the ground of its cameras.
#ifndef DSPACE_SESSION_SCENE_GROUND_H
#define DSPACE_SESSION_SCENE_GROUND_H

#include <vector>

#include <dspace/scene/controls/Navigation.h>
#include <dspace/state/State.h>

namespace dspace::session {

// The visible terrains of a scene, in frame F. Where several lie on one vertical, the highest is
// the ground. On a body the vertical is its own up to a quarter of its radius above the ground,
// turns towards Z of F from there on, and is nothing beyond a radius.
class SceneGround : public NavigationGround {
public:
  // Valid while `scene` does not change.
  SceneGround(const SceneState& scene, FrameId F);
  bool Empty() const { return this->Grounds_.empty(); }
  std::optional<Eigen::Vector3d> Up(const Eigen::Vector3d& p_F) const override;
  std::optional<Eigen::Vector3d> Below(const Eigen::Vector3d& p_F) const override;

private:
  struct Ground {
    const TerrainSurface* surface;
    Pose X_FS;
    bool onBody;
  };
  struct Found {
    const Ground* ground;
    Eigen::Vector3d position_F;
    Eigen::Vector3d up_F;
    double radius; // of the body there [m of F]
  };
  std::optional<Found> Find(const Eigen::Vector3d& p_F) const;
  std::optional<Found> Assume(const Eigen::Vector3d& p_F) const;

  std::vector<Ground> Grounds_;
};

} // namespace dspace::session

#endif
