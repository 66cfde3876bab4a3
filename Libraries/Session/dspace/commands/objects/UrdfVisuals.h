// The geometry of a robot's links.
#ifndef DSPACE_SESSION_URDF_VISUALS_H
#define DSPACE_SESSION_URDF_VISUALS_H

#include <vector>

#include <dspace/interpreter/Registry.h>

namespace dspace::session {

struct UrdfGeometry {
  std::vector<Part> parts;
  Eigen::Affine3d X_LO = Eigen::Affine3d::Identity(); // object in its link's frame
};

// Of a URDF that is read, and of what stands in for meshes that do not exist.
std::vector<std::string> UrdfWarnings(const Urdf& urdf);

// A list a link, in the order of its visuals. A mesh that cannot be read becomes the edges, as
// orange beams, of a box of the bounds that its file states (ReadStatedBounds), and a warning in
// the reply with the box's size, or an Error when options.strict; without such bounds, or without
// the file, an orange cube of 0.1 m.
std::vector<std::vector<UrdfGeometry>> LoadVisuals(const Context& context, const Urdf& urdf,
                                                   const ImportOptions& options);

} // namespace dspace::session

#endif
