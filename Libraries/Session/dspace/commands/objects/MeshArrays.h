// Meshes from the arrays of commands, and back.
#ifndef DSPACE_SESSION_MESH_ARRAYS_H
#define DSPACE_SESSION_MESH_ARRAYS_H

#include <string>
#include <vector>

#include <google/protobuf/repeated_field.h>

#include <dspace/proto/objects.pb.h>
#include <dspace/scene/GraphicsObject.h>
#include <dspace/state/State.h>

namespace dspace::session {

// The levels of a message, checked completely. Equal arrays become one shared mesh. Sets the digest
// of every mesh and makes texture paths absolute. Triangles without normals get them from
// ComputeNormals. Throws Error(InvalidArgument) that names `object`, the part, the value and what
// is accepted: no level, a level without meshes, a mesh without points, arrays of wrong size,
// numbers that are not finite, normals that are not unit within 0.01, indices out of range; and
// the errors of ApplyMaterial.
std::vector<DetailLevel> LevelsOf(google::protobuf::RepeatedPtrField<v1::MeshLevel>& levels,
                                  State& state, const std::string& object);

// A part of `object` as arrays in the object's axes, with its resulting material.
void PutMesh(const GraphicsObject& object, const Part& part, v1::MeshData* data);

} // namespace dspace::session

#endif
