#include <dspace/scene/GraphicsObject.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/FrameRules.h>

namespace dspace {

namespace {

void CheckImage(const Image& image, const std::string& object) {
  const bool sized =
      image.width >= 1 && image.height >= 1 && image.channels >= 1 && image.channels <= 4;
  if (!sized ||
      image.pixels.size() / std::size_t(image.width) / std::size_t(image.height) !=
          std::size_t(image.channels) ||
      image.pixels.size() % (std::size_t(image.width) * std::size_t(image.height)) != 0) {
    Reject(object, "texture '" + image.name + "' has " + std::to_string(image.pixels.size()) +
                       " bytes for " + std::to_string(image.width) + " x " +
                       std::to_string(image.height) + " pixels of " +
                       std::to_string(image.channels) +
                       " channels; accepted: width x height x 1 to 4");
  }
}

void CheckArray(const std::vector<float>& values, std::size_t expected, const char* what,
                const std::string& object) {
  if (values.size() != expected) {
    Reject(object, "it has " + std::to_string(values.size()) + " numbers of " + what +
                       "; accepted: " + std::to_string(expected));
  }
  const auto bad =
      std::find_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); });
  if (bad != values.end()) {
    Reject(object, std::string("a number of its ") + what + " is " + NumberText(*bad) +
                       " (number " + std::to_string(bad - values.begin()) +
                       "); accepted: finite numbers");
  }
}

Eigen::Vector3d Vertex(const Part& part, std::size_t i) {
  const float* p = part.mesh->positions.data() + 3 * i;
  return part.X_OP * Eigen::Vector3d(p[0], p[1], p[2]);
}

// A node's range in O, within that of the nodes above it. Nested ranges keep the inner centre, from
// which the outer distances are off by no more than the centres are apart.
std::optional<DistanceRange> RangeOf(const ModelNode& node, const Eigen::Affine3d& X_ON,
                                     const std::optional<DistanceRange>& above) {
  if (!node.range) {
    return above;
  }
  const double scale = std::cbrt(std::abs(X_ON.linear().determinant()));
  DistanceRange range;
  range.center = X_ON * node.range->center;
  range.from = scale * node.range->from;
  range.to = std::isinf(node.range->to) ? node.range->to : scale * node.range->to;
  if (above) {
    range.from = std::max(range.from, above->from);
    range.to = std::max(range.from, std::min(range.to, above->to));
  }
  return range;
}

} // namespace

void MaterialOverride::Check(const std::string& object) const {
  if (this->color) {
    for (const double c : *this->color) {
      RequireFraction(object, "colour", c);
    }
  }
  if (this->emissive) {
    for (const double c : *this->emissive) {
      RequireFraction(object, "emissive", c);
    }
  }
  RequireFraction(object, "opacity", this->opacity.value_or(1.0));
  RequireFraction(object, "metallic", this->metallic.value_or(0.0));
  RequireFraction(object, "roughness", this->roughness.value_or(0.0));
  if (this->texture && *this->texture) {
    CheckImage(**this->texture, object);
  }
  if (this->reflectance) {
    this->reflectance->Check(object);
  }
}

void CheckMaterial(const Material& material, const std::string& object) {
  for (std::size_t c = 0; c < 3; ++c) {
    RequireFraction(object, "colour", material.color[c]);
    RequireFraction(object, "emissive", material.emissive[c]);
  }
  RequireFraction(object, "opacity", material.opacity);
  RequireFraction(object, "metallic", material.metallic);
  RequireFraction(object, "roughness", material.roughness);
  material.reflectance.Check(object);
  if (material.texture) {
    CheckImage(*material.texture, object);
  }
  if (material.normalTexture) {
    CheckImage(*material.normalTexture, object);
    Require(std::isfinite(material.normalScale), object, "the scale of its normal texture",
            material.normalScale, "a finite number");
  }
}

void CheckMesh(const Mesh& mesh, const std::string& object) {
  const std::string name = object + ", mesh '" + mesh.name + "'";
  const std::size_t n = mesh.VertexCount();
  CheckArray(mesh.positions, 3 * n, "positions", name);
  CheckArray(mesh.normals, mesh.normals.empty() ? 0 : 3 * n, "normals", name);
  CheckArray(mesh.tcoords, mesh.tcoords.empty() ? 0 : 2 * n, "texture coordinates", name);
  if (!mesh.colors.empty() && mesh.colors.size() != 4 * n) {
    Reject(name, "it has " + std::to_string(mesh.colors.size()) +
                     " bytes of colours; accepted: none or " + std::to_string(4 * n));
  }
  const std::size_t corners = mesh.primitive == Mesh::Primitive::Triangles ? 3
                              : mesh.primitive == Mesh::Primitive::Lines   ? 2
                                                                           : 1;
  if (mesh.indices.size() % corners != 0) {
    Reject(name, "it has " + std::to_string(mesh.indices.size()) +
                     " indices; accepted: a multiple of " + std::to_string(corners));
  }
  const auto bad = std::find_if(mesh.indices.begin(), mesh.indices.end(),
                                [n](std::uint32_t i) { return i >= n; });
  if (bad != mesh.indices.end()) {
    Reject(name, "index " + std::to_string(*bad) + " (number " +
                     std::to_string(bad - mesh.indices.begin()) + "); accepted: less than " +
                     std::to_string(n) + ", the number of vertices");
  }
}

Eigen::AlignedBox3d BoxOf(const DetailLevel& level) {
  Eigen::AlignedBox3d box;
  for (const Part& part : level.parts) {
    for (std::size_t i = 0; i < part.mesh->VertexCount(); ++i) {
      box.extend(Vertex(part, i));
    }
  }
  return box;
}

BoundingSphere BoundsOf(const DetailLevel& level) {
  const Eigen::AlignedBox3d box = BoxOf(level);
  BoundingSphere sphere;
  if (box.isEmpty()) {
    return sphere;
  }
  sphere.center = box.center();
  double squared = 0.0;
  for (const Part& part : level.parts) {
    for (std::size_t i = 0; i < part.mesh->VertexCount(); ++i) {
      squared = std::max(squared, (Vertex(part, i) - sphere.center).squaredNorm());
    }
  }
  sphere.radius = std::sqrt(squared);
  return sphere;
}

int LevelFor(const std::vector<DetailLevel>& levels, double pixels) {
  const auto found = std::find_if(levels.begin(), levels.end(), [pixels](const DetailLevel& level) {
    return pixels >= level.minimumPixels;
  });
  return found == levels.end() ? -1 : static_cast<int>(found - levels.begin());
}

std::vector<Part> PartsOf(const std::shared_ptr<const Model>& model, double scale,
                          const Eigen::Quaterniond& rotation) {
  if (!model) {
    Reject("model", "no model is given; accepted: the result of ReadModel");
  }
  const std::string object = "file '" + model->path + "'";
  Require(std::abs(scale) >= MinimumScale && std::abs(scale) <= MaximumScale, object, "scale",
          scale, "1e-12 to 1e12, or the negative of it");
  Pose turn;
  turn.rotation = rotation;
  if (!IsValidPose(turn)) {
    RejectPose(object, turn);
  }
  const auto plain = std::make_shared<const Material>();
  Eigen::Affine3d X_OM = Eigen::Affine3d::Identity();
  X_OM.linear() = scale * rotation.normalized().toRotationMatrix();
  std::vector<Eigen::Affine3d> X_ON; // by node; parents come before children
  X_ON.reserve(model->nodes.size());
  std::vector<std::optional<DistanceRange>> ranges; // of each node with those above it, in O
  std::vector<Part> parts;
  for (const ModelNode& node : model->nodes) {
    X_ON.push_back((node.parent < 0 ? X_OM : X_ON[std::size_t(node.parent)]) * node.local);
    ranges.push_back(RangeOf(node, X_ON.back(),
                             node.parent < 0 ? std::nullopt : ranges[std::size_t(node.parent)]));
    for (const int index : node.meshes) {
      const Mesh& mesh = model->meshes[std::size_t(index)];
      Part part;
      part.mesh = std::shared_ptr<const Mesh>(model, &mesh);
      part.material = mesh.material < 0 ? plain
                                        : std::shared_ptr<const Material>(
                                              model, &model->materials[std::size_t(mesh.material)]);
      part.X_OP = X_ON.back();
      part.name = node.name.empty() ? mesh.name : node.name;
      part.range = ranges.back();
      parts.push_back(std::move(part));
    }
  }
  return parts;
}

} // namespace dspace
