#include <dspace/import/gltf/StatedBounds.h>

#include <dspace/Error.h>

#include <dspace/import/gltf/GltfDocument.h>
#include <dspace/import/gltf/GltfNodes.h>

namespace dspace {

namespace {

// What a stored number counts for when it is normalized (section 3.11).
double NormalizedUnit(std::size_t componentType) {
  switch (componentType) {
  case 5120:
    return 1.0 / 127.0;
  case 5121:
    return 1.0 / 255.0;
  case 5122:
    return 1.0 / 32767.0;
  case 5123:
    return 1.0 / 65535.0;
  default:
    return 1.0;
  }
}

// Of one mesh of the file; empty unless every primitive that has positions states both ends.
Eigen::AlignedBox3d MeshBounds(const GltfDocument& document, std::size_t mesh) {
  const std::string where = "meshes[" + std::to_string(mesh) + "]";
  Eigen::AlignedBox3d bounds;
  const Json::Value& primitives = document.Element("meshes", mesh)["primitives"];
  if (!primitives.isArray()) {
    document.Fail(where + ".primitives is not an array");
  }
  for (const Json::Value& primitive : primitives) {
    if (!primitive.isObject() || !primitive["attributes"].isObject()) {
      document.Fail(where + " has a primitive without attributes");
    }
    const Json::Value& attributes = primitive["attributes"];
    if (attributes["POSITION"].isNull()) {
      continue;
    }
    const std::size_t index = document.Index(attributes, "POSITION", "accessors", where);
    const std::string name = "accessors[" + std::to_string(index) + "]";
    const Json::Value& accessor = document.Element("accessors", index);
    const std::vector<double> low = document.Numbers(accessor, "min", 3, {}, name);
    const std::vector<double> high = document.Numbers(accessor, "max", 3, {}, name);
    if (low.empty() || high.empty()) {
      return {};
    }
    const bool normalized = accessor["normalized"].isBool() && accessor["normalized"].asBool();
    const double unit =
        normalized ? NormalizedUnit(document.Count(accessor, "componentType", 0, name)) : 1.0;
    bounds.extend(unit * Eigen::Map<const Eigen::Vector3d>(low.data()));
    bounds.extend(unit * Eigen::Map<const Eigen::Vector3d>(high.data()));
  }
  return bounds;
}

Eigen::AlignedBox3d GltfBounds(const GltfDocument& document) {
  std::vector<std::vector<int>> meshesOf(document.Array("meshes").size());
  for (std::size_t i = 0; i < meshesOf.size(); ++i) {
    meshesOf[i] = {static_cast<int>(i)};
  }
  const std::vector<ModelNode> nodes = ReadGltfNodes(document, meshesOf).nodes;
  std::vector<Eigen::Affine3d> toModel;
  Eigen::AlignedBox3d bounds;
  for (const ModelNode& node : nodes) {
    toModel.push_back(
        node.parent < 0 ? node.local : toModel[static_cast<std::size_t>(node.parent)] * node.local);
    for (const int mesh : node.meshes) {
      const Eigen::AlignedBox3d box = MeshBounds(document, static_cast<std::size_t>(mesh));
      for (int corner = 0; !box.isEmpty() && corner < 8; ++corner) {
        bounds.extend(toModel.back() *
                      box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
      }
    }
  }
  return bounds;
}

} // namespace

Eigen::AlignedBox3d ReadStatedBounds(const std::string& path) {
  try {
    return GltfBounds(GltfDocument(path, GltfDocument::Contents::Json));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) { // no glTF, or a damaged one
    return {};
  }
}

} // namespace dspace
