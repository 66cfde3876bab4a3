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

// Warnings of a URDF, including those of placeholders for missing meshes.
std::vector<std::string> UrdfWarnings(const Urdf& urdf);

// One list per link, in the order of its visuals. An unreadable mesh is replaced by the edges
// (orange beams) of a box with the bounds that its file states (ReadStatedBounds), and the reply
// has a warning with the box's size; with options.strict it is an Error. Without such bounds, or
// without the file, the placeholder is an orange cube of 0.1 m.
std::vector<std::vector<UrdfGeometry>> LoadVisuals(const Context& context, const Urdf& urdf,
                                                   const ImportOptions& options);

} // namespace dspace::session

#endif
