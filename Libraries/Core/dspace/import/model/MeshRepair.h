// Small repairs that several importers need: internal.
#ifndef DSPACE_IMPORT_MESH_REPAIR_H
#define DSPACE_IMPORT_MESH_REPAIR_H

#include <cstddef>

#include <dspace/import/model/Model.h>

namespace dspace {

// What RepairMesh found: how many, and the first vertex or primitive of each.
struct MeshFlaws {
  std::size_t primitives = 0, firstPrimitive = 0; // with a position that is not finite: left out
  std::size_t normals = 0, firstNormal = 0; // not finite or without length: made from the faces
  std::size_t tcoords = 0, firstTcoord = 0; // not finite: 0
  bool Any() const { return this->primitives + this->normals + this->tcoords > 0; }
};

// Repairs what of a mesh is not finite, and makes its normals unit length. Normals of which none
// is good, or that no triangle uses, are dropped, to be computed later. Arrays whose sizes do not
// fit, and indices out of range, are left as they are, for CheckModel to name.
MeshFlaws RepairMesh(Mesh& mesh);

// Drops the vertices that no index names, keeping the order of the others. Meshes with an index
// out of range are left as they are, for CheckModel to name.
void DropUnusedVertices(Mesh& mesh);

} // namespace dspace

#endif
