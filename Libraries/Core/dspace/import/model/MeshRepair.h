// Small repairs that several importers need: internal.
#ifndef DSPACE_IMPORT_MESH_REPAIR_H
#define DSPACE_IMPORT_MESH_REPAIR_H

#include <dspace/import/model/Model.h>

namespace dspace {

// Makes the normals unit length. Where one has no length (or is not finite) the mesh's normals are
// dropped, so that whoever draws it computes them, and false is returned.
bool NormalizeNormals(Mesh& mesh);

// Drops the vertices that no index names, keeping the order of the others. Meshes with an index
// out of range are left as they are, for CheckModel to name.
void DropUnusedVertices(Mesh& mesh);

} // namespace dspace

#endif
