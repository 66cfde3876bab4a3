#include <dspace/commands/objects/MeshArrays.h>

#include <cmath>
#include <cstring>
#include <numeric>

#include <dspace/Checks.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/import/model/Normals.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/MeshMessages.h>

namespace dspace::session {
namespace {

constexpr double LengthTolerance = 0.01; // of normals, as 8-bit encodings have

// The numbers of an array; `row` is their number per vertex or primitive.
template<class T>
std::vector<T> NumbersOf(const std::string& bytes, std::size_t row, const char* what,
                         const std::string& object) {
  const std::size_t size = row * sizeof(T);
  if (bytes.size() % size != 0) {
    Reject(object, std::string("the array of its ") + what + " has " +
                       std::to_string(bytes.size()) + " bytes; accepted: a multiple of " +
                       std::to_string(size));
  }
  std::vector<T> numbers(bytes.size() / sizeof(T));
  if (!numbers.empty()) {
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
  }
  return numbers;
}

std::string BytesOf(const void* data, std::size_t size) {
  return {static_cast<const char*>(data), size};
}

template<class T> std::string BytesOf(const std::vector<T>& values) {
  return BytesOf(values.data(), values.size() * sizeof(T));
}

Mesh::Primitive PrimitiveOf(const v1::MeshData& data, const std::string& object) {
  switch (data.primitive()) {
  case v1::MeshData::TRIANGLES:
    return Mesh::Primitive::Triangles;
  case v1::MeshData::LINES:
    return Mesh::Primitive::Lines;
  case v1::MeshData::POINTS:
    return Mesh::Primitive::Points;
  default:
    Reject(object, "its primitive is " + std::to_string(data.primitive()) +
                       "; accepted: triangles (0), lines (1), points (2)");
  }
}

void RequireUnitNormals(const Mesh& mesh, const std::string& object) {
  for (std::size_t i = 0; i + 2 < mesh.normals.size(); i += 3) {
    const double length =
        Eigen::Vector3d(mesh.normals[i], mesh.normals[i + 1], mesh.normals[i + 2]).norm();
    if (!(std::abs(length - 1.0) <= LengthTolerance)) {
      Reject(object, "the normal of vertex " + std::to_string(i / 3) + " has length " +
                         NumberText(length) + "; accepted: 1 within 0.01");
    }
  }
}

std::shared_ptr<const Mesh> MeshOf(const v1::MeshData& data, const std::string& object) {
  auto mesh = std::make_shared<Mesh>();
  mesh->name = data.part();
  mesh->primitive = PrimitiveOf(data, object);
  mesh->positions = NumbersOf<float>(data.position(), 3, "positions", object);
  mesh->normals = NumbersOf<float>(data.normal(), 3, "normals", object);
  mesh->tcoords = NumbersOf<float>(data.tcoord(), 2, "texture coordinates", object);
  mesh->colors = NumbersOf<std::uint8_t>(data.color(), 4, "colours", object);
  mesh->indices = NumbersOf<std::uint32_t>(data.index(), 1, "indices", object);
  if (mesh->indices.empty()) {
    mesh->indices.resize(mesh->VertexCount());
    std::iota(mesh->indices.begin(), mesh->indices.end(), 0u);
  }
  CheckMesh(*mesh, object);
  RequireUnitNormals(*mesh, object);
  if (mesh->primitive == Mesh::Primitive::Triangles) {
    ComputeNormals(*mesh);
  }
  return mesh;
}

std::shared_ptr<const Material> MaterialOf(v1::Material& from, State& state,
                                           const std::string& object) {
  if (from.has_wireframe()) {
    Reject(object, "its material has wireframe; accepted: wireframe in the object's material");
  }
  const MaterialOverride over = ApplyMaterial(from, {}, state, object);
  auto material = std::make_shared<Material>();
  material->color = over.color.value_or(material->color);
  material->opacity = over.opacity.value_or(material->opacity);
  material->metallic = over.metallic.value_or(material->metallic);
  material->roughness = over.roughness.value_or(material->roughness);
  material->emissive = over.emissive.value_or(material->emissive);
  material->texture = over.texture.value_or(material->texture);
  material->lit = over.lit.value_or(material->lit);
  material->reflectance = over.reflectance.value_or(material->reflectance);
  return material;
}

Part PartOfArrays(v1::MeshData& data, State& state, const std::string& object) {
  const std::string label = data.part().empty() ? object : object + ", part '" + data.part() + "'";
  if (data.position().empty()) {
    Reject(label, !data.digest().empty() && !HasArrays(data)
                      ? "its arrays are in a recording; accepted: the arrays themselves, as "
                        "playback fills them in"
                      : "it has no points; accepted: 1 or more");
  }
  Part part;
  part.name = data.part();
  if (data.has_origin()) {
    part.X_OP.translation() = ToVector(data.origin());
    RequirePosition(label, "its origin", part.X_OP.translation());
  }
  if (data.has_material()) {
    part.material = MaterialOf(*data.mutable_material(), state, label);
  }
  SetDigest(data);
  part.mesh = state.meshes.Get(data.digest(), [&] { return MeshOf(data, label); });
  return part;
}

// Of the part's own material, under the overrides of the object and of the part.
void PutResult(const GraphicsObject& object, const Part& part, v1::Material* to) {
  const Material own = part.material ? *part.material : Material();
  MaterialOverride made;
  made.color = own.color;
  made.opacity = own.opacity;
  made.metallic = own.metallic;
  made.roughness = own.roughness;
  made.emissive = own.emissive;
  made.lit = own.lit;
  if (own.reflectance != Reflectance()) {
    made.reflectance = own.reflectance;
  }
  if (own.texture) {
    made.texture = own.texture;
  }
  PutMaterial(made, to);
  v1::Material over;
  PutMaterial(object.material, &over);
  const auto found = object.parts.find(part.name);
  if (found != object.parts.end()) {
    MergeMaterial(over, to);
    over.Clear();
    PutMaterial(found->second.material, &over);
  }
  MergeMaterial(over, to);
}

} // namespace

std::vector<DetailLevel> LevelsOf(google::protobuf::RepeatedPtrField<v1::MeshLevel>& levels,
                                  State& state, const std::string& object) {
  if (levels.empty()) {
    Reject(object, "it has no level of detail; accepted: 1 or more");
  }
  std::vector<DetailLevel> made;
  for (v1::MeshLevel& level : levels) {
    if (level.mesh_size() == 0) {
      Reject(object,
             "level " + std::to_string(made.size()) + " has no points; accepted: 1 mesh or more");
    }
    made.emplace_back().minimumPixels = level.minimum_pixels();
    for (v1::MeshData& data : *level.mutable_mesh()) {
      made.back().parts.push_back(PartOfArrays(data, state, object));
    }
  }
  return made;
}

void PutMesh(const GraphicsObject& object, const Part& part, v1::MeshData* data) {
  const Mesh& mesh = *part.mesh;
  data->set_part(part.name);
  data->set_primitive(v1::MeshData::Primitive(int(mesh.primitive)));
  if (!part.X_OP.translation().isZero(0.0)) {
    Put(Eigen::Vector3d(part.X_OP.translation()), data->mutable_origin());
  }
  const Eigen::Matrix3d axes = part.X_OP.linear();
  std::vector<float> positions = mesh.positions;
  std::vector<float> normals = mesh.normals;
  std::vector<std::uint32_t> indices = mesh.indices;
  if (!axes.isIdentity(0.0)) {
    const Eigen::Matrix3d turn = axes.inverse().transpose(); // normals stay on their side
    const auto apply = [](const Eigen::Matrix3d& m, std::vector<float>& values, bool unit) {
      for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
        Eigen::Map<Eigen::Vector3f> v(values.data() + i);
        const Eigen::Vector3d turned = m * v.cast<double>();
        v = (unit ? turned.normalized() : turned).cast<float>();
      }
    };
    apply(axes, positions, false);
    apply(turn, normals, true);
    if (axes.determinant() < 0.0 && mesh.primitive == Mesh::Primitive::Triangles) {
      for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        std::swap(indices[i + 1], indices[i + 2]);
      }
    }
  }
  data->set_position(BytesOf(positions));
  data->set_normal(BytesOf(normals));
  data->set_tcoord(BytesOf(mesh.tcoords));
  data->set_color(BytesOf(mesh.colors));
  data->set_index(BytesOf(indices));
  PutResult(object, part, data->mutable_material());
}

} // namespace dspace::session
