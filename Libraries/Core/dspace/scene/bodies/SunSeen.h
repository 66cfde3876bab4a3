// The Sun of a scene's bodies as a place sees it, with eclipses.
#ifndef DSPACE_SCENE_SUN_SEEN_H
#define DSPACE_SCENE_SUN_SEEN_H

#include <optional>

#include <Eigen/Core>

namespace dspace {

class Scene;

struct SunSeen {
  Eigen::Vector3d towards_R; // the Sun's centre, unit, in the root's axes
  double left = 1.0; // of its disc, 0 to 1, by the bodies with BodyShape::eclipses: SunLeft()
};

// From a place in the root [m]. None without a visible body that is the Sun (BodyShape::sun). Two
// bodies before the Sun at once count as if they hid the disc evenly: their parts are multiplied,
// as in pictures.
std::optional<SunSeen> SunSeenFrom(const Scene& scene, const Eigen::Vector3d& p_R);

} // namespace dspace

#endif
