// How a person moves a camera, and the ground that the camera keeps above.
#ifndef DSPACE_SCENE_NAVIGATION_H
#define DSPACE_SCENE_NAVIGATION_H

#include <optional>
#include <string>

#include <Eigen/Core>

namespace dspace {

// Settings of a viewport.
struct Navigation {
  enum class Kind {
    Orbit, // about the point under the pointer
    Walk,  // on the ground
    Map    // without turns
  };
  Kind kind = Kind::Orbit;
  double eyeHeight = 1.7; // Walk: above the ground [m], 0.01 to 1e6
  double walkSpeed = 1.5; // Walk: [m/s], 0.001 to 1e6

  // Throws Error(InvalidArgument) naming `object` and the value.
  void Check(const std::string& object) const;
};

// The ground about a camera, in the frame F of the camera's pose. The local vertical is a body's or
// a map's.
class NavigationGround {
public:
  virtual ~NavigationGround() = default;
  // The local vertical at a point, unit; none where the ground is too far away to say what is
  // level.
  virtual std::optional<Eigen::Vector3d> Up(const Eigen::Vector3d& p_F) const = 0;
  // The ground on the local vertical through a point, above or below it; none where it is unknown.
  virtual std::optional<Eigen::Vector3d> Below(const Eigen::Vector3d& p_F) const = 0;
};

} // namespace dspace

#endif
