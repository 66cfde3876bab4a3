// VRML97 6.18: a cross-section swept along a spine. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML_EXTRUSION_H
#define DSPACE_IMPORT_VRML_EXTRUSION_H

#include <Eigen/Geometry>
#include <vector>

#include <dspace/import/vrml/VrmlFaces.h>

namespace dspace {

struct VrmlExtrusion {
  std::vector<Eigen::Vector2d> crossSection;
  std::vector<Eigen::Vector3d> spine;
  std::vector<Eigen::Vector2d> scale;          // one for all, or one a spine point
  std::vector<Eigen::Quaterniond> orientation; // likewise
  bool beginCap = true;
  bool endCap = true;
};
// False, and a complaint, when the spine or cross-section has fewer than two points or the surface
// more than 10,000,000.
bool MakeVrmlExtrusion(const VrmlExtrusion& extrusion, VrmlFaces& faces,
                       VrmlComplaints& complaints);

} // namespace dspace

#endif
