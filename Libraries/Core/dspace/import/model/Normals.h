// Vertex normals with creases.
#ifndef DSPACE_IMPORT_NORMALS_H
#define DSPACE_IMPORT_NORMALS_H

#include <dspace/import/model/Model.h>
#include <dspace/import/model/Normals.h>

namespace dspace {

// Appends normals to `mesh` when it has none: smooth across edges flatter than the crease angle
// (degrees), splitting vertices where sharper. Triangles only; others are left alone.
void ComputeNormals(Mesh& mesh, double creaseAngle_deg = 30.0);

} // namespace dspace

#endif
