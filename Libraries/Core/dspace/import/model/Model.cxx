#include <dspace/import/model/Model.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>

namespace dspace {

namespace {

// A model under check: says where it is wrong.
class Checker {
public:
  explicit Checker(const Model& model) : Model_(model) {}

  void Run() const {
    for (std::size_t i = 0; i < this->Model_.materials.size(); ++i) {
      this->CheckMaterial(this->Model_.materials[i], i);
    }
    for (std::size_t i = 0; i < this->Model_.meshes.size(); ++i) {
      this->CheckMesh(this->Model_.meshes[i], i);
    }
    for (std::size_t i = 0; i < this->Model_.nodes.size(); ++i) {
      this->CheckNode(this->Model_.nodes[i], i);
    }
  }

private:
  [[noreturn]] void Fail(const char* what, std::size_t index, const std::string& name,
                         const std::string& message) const {
    throw Error(Error::Kind::Corrupt, "file '" + this->Model_.path + "'",
                std::string(what) + " " + std::to_string(index) +
                    (name.empty() ? "" : " '" + name + "'") + ": " + message);
  }

  void CheckArray(const std::vector<float>& values, std::size_t expected, const char* array,
                  std::size_t index, const std::string& name) const {
    if (values.size() != expected) {
      this->Fail("mesh", index, name,
                 "has " + std::to_string(values.size()) + " numbers of " + array + ", expected " +
                     std::to_string(expected));
    }
    const auto bad =
        std::find_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); });
    if (bad != values.end()) {
      this->Fail("mesh", index, name,
                 std::string("a number of its ") + array + " is " + std::to_string(*bad) +
                     " (number " + std::to_string(bad - values.begin()) + "); finite is accepted");
    }
  }

  void CheckMesh(const Mesh& mesh, std::size_t index) const {
    const std::size_t n = mesh.positions.size() / 3;
    this->CheckArray(mesh.positions, 3 * n, "positions", index, mesh.name);
    this->CheckArray(mesh.normals, mesh.normals.empty() ? 0 : 3 * n, "normals", index, mesh.name);
    this->CheckArray(mesh.tcoords, mesh.tcoords.empty() ? 0 : 2 * n, "tcoords", index, mesh.name);
    if (!mesh.colors.empty() && mesh.colors.size() != 4 * n) {
      this->Fail("mesh", index, mesh.name,
                 "has " + std::to_string(mesh.colors.size()) + " bytes of colours, expected " +
                     std::to_string(4 * n));
    }
    const std::size_t corners = mesh.primitive == Mesh::Primitive::Triangles ? 3
                                : mesh.primitive == Mesh::Primitive::Lines   ? 2
                                                                             : 1;
    if (mesh.indices.size() % corners != 0) {
      this->Fail("mesh", index, mesh.name,
                 std::to_string(mesh.indices.size()) + " indices are no multiple of " +
                     std::to_string(corners));
    }
    const auto bad = std::find_if(mesh.indices.begin(), mesh.indices.end(),
                                  [n](std::uint32_t i) { return i >= n; });
    if (bad != mesh.indices.end()) {
      this->Fail("mesh", index, mesh.name,
                 "index " + std::to_string(*bad) + " (number " +
                     std::to_string(bad - mesh.indices.begin()) + ") of " + std::to_string(n) +
                     " vertices");
    }
    if (mesh.material < -1 || mesh.material >= static_cast<int>(this->Model_.materials.size())) {
      this->Fail("mesh", index, mesh.name,
                 "material " + std::to_string(mesh.material) + " of " +
                     std::to_string(this->Model_.materials.size()));
    }
  }

  void CheckMaterial(const Material& material, std::size_t index) const {
    const auto unit = [&](double value, const char* what) {
      if (!(value >= 0.0 && value <= 1.0)) {
        this->Fail("material", index, material.name,
                   std::string(what) + " is " + std::to_string(value) + ", outside [0, 1]");
      }
    };
    for (int c = 0; c < 3; ++c) {
      unit(material.color[c], "color");
      unit(material.emissive[c], "emissive");
    }
    unit(material.opacity, "opacity");
    unit(material.metallic, "metallic");
    unit(material.roughness, "roughness");
    if (material.texture) {
      const Image& image = *material.texture;
      if (image.width < 1 || image.height < 1 || image.channels < 1 || image.channels > 4 ||
          image.pixels.size() !=
              std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels)) {
        this->Fail("material", index, material.name,
                   "texture '" + image.name + "' has " + std::to_string(image.pixels.size()) +
                       " bytes for " + std::to_string(image.width) + " x " +
                       std::to_string(image.height) + " x " + std::to_string(image.channels));
      }
    }
  }

  void CheckNode(const ModelNode& node, std::size_t index) const {
    if (node.parent < -1 || node.parent >= static_cast<int>(index)) {
      this->Fail("node", index, node.name,
                 "parent " + std::to_string(node.parent) + " is not an earlier node");
    }
    if (!node.local.matrix().allFinite()) {
      this->Fail("node", index, node.name, "its transform is not finite");
    }
    if (node.range && (!node.range->center.allFinite() || !(node.range->from >= 0.0) ||
                       !(node.range->to >= node.range->from))) {
      this->Fail("node", index, node.name, "its range of distances is not ascending");
    }
    for (const int mesh : node.meshes) {
      if (mesh < 0 || mesh >= static_cast<int>(this->Model_.meshes.size())) {
        this->Fail("node", index, node.name,
                   "mesh " + std::to_string(mesh) + " of " +
                       std::to_string(this->Model_.meshes.size()));
      }
    }
  }

  const Model& Model_;
};

} // namespace

std::size_t Model::TriangleCount() const {
  std::size_t count = 0;
  for (const ModelNode& node : this->nodes) {
    for (const int mesh : node.meshes) {
      const Mesh& m = this->meshes[static_cast<std::size_t>(mesh)];
      count += m.primitive == Mesh::Primitive::Triangles ? m.PrimitiveCount() : 0;
    }
  }
  return count;
}

Eigen::AlignedBox3d Model::Bounds() const {
  Eigen::AlignedBox3d box;
  std::vector<Eigen::Affine3d> X_FN(this->nodes.size()); // node to file; parents come first
  for (std::size_t i = 0; i < this->nodes.size(); ++i) {
    const ModelNode& node = this->nodes[i];
    X_FN[i] = node.parent < 0 ? node.local : X_FN[std::size_t(node.parent)] * node.local;
    for (const int mesh : node.meshes) {
      const std::vector<float>& p = this->meshes[static_cast<std::size_t>(mesh)].positions;
      for (std::size_t k = 0; k + 2 < p.size(); k += 3) {
        box.extend(X_FN[i] * Eigen::Vector3d(p[k], p[k + 1], p[k + 2]));
      }
    }
  }
  return box;
}

Eigen::Affine3d Model::NodeToModel(int node) const {
  if (node < 0 || node >= static_cast<int>(this->nodes.size())) {
    throw Error(Error::Kind::InvalidArgument, "file '" + this->path + "'",
                "node " + std::to_string(node) + " of " + std::to_string(this->nodes.size()));
  }
  Eigen::Affine3d X_FN = Eigen::Affine3d::Identity();
  for (int i = node; i >= 0; i = this->nodes[static_cast<std::size_t>(i)].parent) {
    X_FN = this->nodes[static_cast<std::size_t>(i)].local * X_FN;
  }
  return X_FN;
}

std::string LeftOutWarning(const Model& model, bool usesLights, bool usesAnimations) {
  std::vector<std::string> all = model.leftOut;
  const auto add = [&all](std::size_t count, const char* what) {
    if (count > 0) {
      all.push_back(std::to_string(count) + " " + what + (count > 1 ? "s" : ""));
    }
  };
  add(usesLights ? 0 : model.lights.size(), "light");
  add(usesAnimations ? 0 : model.animations.size(), "animation");
  std::string text;
  for (const std::string& each : all) {
    text += (text.empty() ? "" : ", ") + each;
  }
  return text.empty() ? text : "file '" + model.path + "': left out: " + text;
}

void CheckModel(const Model& model) {
  Checker(model).Run();
}

} // namespace dspace
