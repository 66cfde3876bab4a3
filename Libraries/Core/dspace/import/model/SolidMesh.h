// Whether a mesh bounds solids, so that a camera outside them never sees its back faces.
#ifndef DSPACE_IMPORT_SOLID_MESH_H
#define DSPACE_IMPORT_SOLID_MESH_H

#include <dspace/import/model/Model.h>

namespace dspace {

// True when every connected piece of the mesh is closed (each edge belongs to exactly two
// triangles, which pass it in opposite directions), and its triangles all face away from the mean
// of its vertices. Seen from that point such a piece covers each direction exactly once: it is
// star-shaped, cannot intersect itself, and every ray from outside meets a front face first.
// Sufficient, not necessary: pieces of other shapes, pieces wound clockwise and lines or points are
// answered with false. Vertices closer than about a millionth of the mesh's size count as one.
bool IsSolid(const Mesh& mesh);

} // namespace dspace

#endif
