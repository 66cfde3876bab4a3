// Meshes of basic shapes.
#ifndef DSPACE_SCENE_PRIMITIVES_H
#define DSPACE_SCENE_PRIMITIVES_H

#include <vector>

#include <Eigen/Core>

#include <dspace/import/model/Model.h>

namespace dspace {

// Surfaces have outward winding (counter-clockwise seen from outside), normals of the shape meant
// (a sphere's are radial, not its facets'), texture coordinates in [0, 1], and no material of their
// own. Solids are closed: vertices that meet have equal coordinates to the bit.
// Lengths are metres, 1e-9 to 1e15; `resolution` is the number of sectors round, 3 to 1024.
// All throw Error(InvalidArgument) naming the primitive and the value.

// Centred on the origin; each face shows the whole texture.
Mesh MakeBox(const Eigen::Vector3d& size);

// Centred on the origin, poles on Z, resolution / 2 (at least 2) bands; vertices on the sphere.
// Texture: a cylindrical map, longitude 0 (+X) in the middle, north (+Z) at the top.
Mesh MakeSphere(double radius, int resolution = 32);

// Centred on the origin, along Z, with caps. Texture: once round the side from +X, and on each cap.
Mesh MakeCylinder(double radius, double height, int resolution = 32);

// Along Z: base at -height / 2, apex at +height / 2. Texture as the cylinder's.
Mesh MakeCone(double radius, double height, int resolution = 32);

// Centred on the origin in XY, facing +Z; texture's bottom left at (-width / 2, -height / 2).
Mesh MakePlane(double width, double height);

// Centred on the origin in XY, facing +Z.
Mesh MakeDisc(double radius, int resolution = 32);

// Ring about Z: `radius` to the middle of a tube of radius `tube` < radius.
Mesh MakeTorus(double radius, double tube, int resolution = 32);

// From the origin along +X: shaft to 0.8 length (radius 0.02 length), head of radius 0.06 length.
Mesh MakeArrow(double length, int resolution = 24);

// Lines from point to point, back to the first when closed; at least 2 points, 3 when closed.
Mesh MakeLineSet(const std::vector<Eigen::Vector3d>& points, bool closed = false);

// At least 1 point.
Mesh MakePointSet(const std::vector<Eigen::Vector3d>& points);

} // namespace dspace

#endif
