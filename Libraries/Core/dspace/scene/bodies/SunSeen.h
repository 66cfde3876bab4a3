// The Sun of a scene's bodies as places see it, with eclipses.
#ifndef DSPACE_SCENE_SUN_SEEN_H
#define DSPACE_SCENE_SUN_SEEN_H

#include <optional>
#include <vector>

#include <Eigen/Core>

namespace dspace {

class Scene;
struct GraphicsObject;

struct SunSeen {
  Eigen::Vector3d towards_R; // the Sun's centre, unit, in the root's axes
  double radius = 0.0;       // of its disc, angular [rad]
  double square = 1.0;       // (1 au / its distance)^2: the factor of an irradiance at 1 au
  double left = 1.0; // of its disc, 0 to 1, by the bodies with BodyShape::eclipses: SunLeft()
};

// The body that is the Sun (BodyShape::sun), shown or hidden; null: the scene has none.
const GraphicsObject* FindSunBody(const Scene& scene);

// The visible bodies of a scene at the time of construction. The constructor visits all objects;
// From() visits the bodies only.
class SunlitBodies {
public:
  explicit SunlitBodies(const Scene& scene);

  // From a place in the root [m]. None without a visible body that is the Sun (BodyShape::sun), or
  // within it. Two bodies before the Sun at once count as if they hid the disc evenly: their parts
  // are multiplied, as in pictures.
  std::optional<SunSeen> From(const Eigen::Vector3d& p_R) const;

private:
  struct Blocker {
    Eigen::Vector3d center_R;
    Eigen::Matrix3d unit; // as SunBlocker has it
  };

  std::optional<Eigen::Vector3d> Sun_; // its centre in the root
  double Radius_ = 0.0;                // [m]
  std::vector<Blocker> Blockers_;
};

} // namespace dspace

#endif
