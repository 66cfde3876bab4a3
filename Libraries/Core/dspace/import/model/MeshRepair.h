// Small repairs that several importers need: internal.
#ifndef DSPACE_IMPORT_MESH_REPAIR_H
#define DSPACE_IMPORT_MESH_REPAIR_H

#include <dspace/import/model/Model.h>

namespace dspace {

// Makes the normals unit length. If one has no length or is not finite, drops all normals of the
// mesh, so that they are computed later, and returns false.
bool NormalizeNormals(Mesh& mesh);

// Drops the vertices that no index names, keeping the order of the others. Meshes with an index
// out of range are left as they are, for CheckModel to name.
void DropUnusedVertices(Mesh& mesh);

} // namespace dspace

#endif
