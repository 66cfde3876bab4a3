// The geometry of a robot's links.
#ifndef DSPACE_SESSION_URDF_VISUALS_H
#define DSPACE_SESSION_URDF_VISUALS_H

#include <vector>

#include <dspace/session/Registry.h>

namespace dspace::session {

struct UrdfGeometry {
  std::vector<Part> parts;
  Eigen::Affine3d X_LO = Eigen::Affine3d::Identity(); // object in its link's frame
};

// A list a link, in the order of its visuals. A mesh that is missing or cannot be read becomes an
// orange box of 0.1 m and a warning in the reply, or an Error when options.strict.
std::vector<std::vector<UrdfGeometry>> LoadVisuals(const Context& context, const Urdf& urdf,
                                                   const ImportOptions& options);

} // namespace dspace::session

#endif
