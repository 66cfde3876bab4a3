#include <dspace/messages/MeshMessages.h>

#include <dspace/messages/Sha256.h>

namespace dspace::session {
namespace {

// Moves the primitive and the arrays.
void Move(v1::MeshData& from, v1::MeshData& to) {
  to.set_primitive(from.primitive());
  to.mutable_position()->swap(*from.mutable_position());
  to.mutable_normal()->swap(*from.mutable_normal());
  to.mutable_tcoord()->swap(*from.mutable_tcoord());
  to.mutable_color()->swap(*from.mutable_color());
  to.mutable_index()->swap(*from.mutable_index());
}

template<class Levels>
void VisitLevels(Levels& levels, const std::function<void(v1::MeshData&)>& visit) {
  for (v1::MeshLevel& level : levels) {
    for (v1::MeshData& mesh : *level.mutable_mesh()) {
      visit(mesh);
    }
  }
}

} // namespace

void ForEachMesh(v1::Command& command, const std::function<void(v1::MeshData&)>& visit) {
  if (command.has_create_mesh()) {
    VisitLevels(*command.mutable_create_mesh()->mutable_level(), visit);
  } else if (command.has_set_mesh()) {
    VisitLevels(*command.mutable_set_mesh()->mutable_level(), visit);
  }
}

bool HoldsMeshes(const v1::Command& command) {
  return command.has_create_mesh() || command.has_set_mesh();
}

bool HasArrays(const v1::MeshData& mesh) {
  return !mesh.position().empty() || !mesh.normal().empty() || !mesh.tcoord().empty() ||
         !mesh.color().empty() || !mesh.index().empty();
}

void SetDigest(v1::MeshData& mesh) {
  v1::MeshData arrays;
  Move(mesh, arrays);
  const std::string bytes = arrays.SerializeAsString();
  Move(arrays, mesh);
  Sha256 sum;
  sum.Add(bytes.data(), bytes.size());
  mesh.set_digest(sum.Finish());
}

std::string TakeArrays(v1::MeshData& mesh) {
  v1::MeshData arrays;
  Move(mesh, arrays);
  return arrays.SerializeAsString();
}

bool PutArrays(const std::string& bytes, v1::MeshData& mesh) {
  v1::MeshData arrays;
  if (!arrays.ParseFromString(bytes)) {
    return false;
  }
  Move(arrays, mesh);
  return true;
}

} // namespace dspace::session
