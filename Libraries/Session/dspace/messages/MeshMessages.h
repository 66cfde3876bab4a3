// The arrays of meshes in commands.
#ifndef DSPACE_SESSION_MESH_MESSAGES_H
#define DSPACE_SESSION_MESH_MESSAGES_H

#include <functional>
#include <string>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Calls `visit` with every mesh of the command, in its order.
void ForEachMesh(v1::Command& command, const std::function<void(v1::MeshData&)>& visit);
bool HoldsMeshes(const v1::Command& command);

// Whether the mesh has any array.
bool HasArrays(const v1::MeshData& mesh);

// Sets MeshData.digest to the SHA-256 of what TakeArrays returns. Keeps the arrays.
void SetDigest(v1::MeshData& mesh);

// Moves the arrays out of a mesh whose digest is set: a serialized MeshData that has only the
// primitive and the arrays.
std::string TakeArrays(v1::MeshData& mesh);

// Puts the arrays back and keeps the other fields. False: the bytes are not those of TakeArrays.
bool PutArrays(const std::string& bytes, v1::MeshData& mesh);

} // namespace dspace::session

#endif
