// VRML's primitive shapes and elevation grids. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML_SOLIDS_H
#define DSPACE_IMPORT_VRML_SOLIDS_H

#include <dspace/import/vrml/VrmlFaces.h>

#include <Eigen/Geometry>

namespace dspace {

// How round shapes are cut: triangles of a sphere 2 * 32 * 15, of a cylinder's or cone's side 2 *
// 32 and 32, of each cap 30.
constexpr int VrmlSlices = 32;
constexpr int VrmlStacks = 16;

// Shapes as VRML97 chapter 6 and VRML 1.0 place them: centred at the origin, axis along Y, with
// their texture coordinates and outward normals. Sizes are positive.
Mesh MakeVrmlBox(const Eigen::Vector3d& size);
Mesh MakeVrmlSphere(double radius);
Mesh MakeVrmlCylinder(double radius, double height, bool side, bool top, bool bottom);
Mesh MakeVrmlCone(double bottomRadius, double height, bool side, bool bottom);

// ElevationGrid, VRML97 6.17: heights row by row (X fastest), facing +Y.
struct VrmlElevationGrid {
  int xDimension = 0;
  int zDimension = 0;
  double xSpacing = 1.0;
  double zSpacing = 1.0;
  std::vector<float> heights;
};
// Points, quadrilaterals and default texture coordinates; the caller adds colours and normals,
// whose PerCornerIndexed and PerFace run over points and quadrilaterals. False, and a complaint,
// when there are fewer than 2 x 2 heights or fewer heights than the dimensions say.
bool MakeVrmlElevationGrid(const VrmlElevationGrid& grid, VrmlFaces& faces,
                           VrmlComplaints& complaints);

} // namespace dspace

#endif
