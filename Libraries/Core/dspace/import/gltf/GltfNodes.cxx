#include <dspace/import/gltf/GltfNodes.h>

#include <cmath>
#include <deque>

#include <dspace/import/gltf/GltfAccessor.h>

namespace dspace {

namespace {

Eigen::Affine3d NodeTransform(const GltfDocument& document, const Json::Value& node,
                              const std::string& where) {
  Eigen::Affine3d local = Eigen::Affine3d::Identity();
  if (!node["matrix"].isNull()) {
    // Column-major (section 3.5.3).
    const std::vector<double> m = document.Numbers(node, "matrix", 16, {}, where);
    local.matrix().topRows<3>() = Eigen::Map<const Eigen::Matrix4d>(m.data()).topRows<3>();
    return local;
  }
  const std::vector<double> t = document.Numbers(node, "translation", 3, {0, 0, 0}, where);
  const std::vector<double> r = document.Numbers(node, "rotation", 4, {0, 0, 0, 1}, where);
  const std::vector<double> s = document.Numbers(node, "scale", 3, {1, 1, 1}, where);
  const Eigen::Quaterniond q(r[3], r[0], r[1], r[2]); // the file lists x y z w
  if (!(q.norm() > 1e-6) || !std::isfinite(q.norm())) {
    document.Fail(where + ".rotation is not a rotation");
  }
  local =
      Eigen::Translation3d(t[0], t[1], t[2]) * q.normalized() * Eigen::Scaling(s[0], s[1], s[2]);
  return local;
}

constexpr std::size_t MaximumInstances = 1000000; // of a file

class NodeReader {
public:
  NodeReader(const GltfDocument& document, const std::vector<std::vector<int>>& meshesOf)
      : Document_(document), MeshesOf_(meshesOf), Seen_(document.Array("nodes").size(), false) {}

  // Parents first, without recursion: a file may be as deep as it likes.
  GltfNodes Read() {
    GltfNodes out;
    out.indexOf.assign(this->Seen_.size(), -1);
    std::vector<ModelNode>& nodes = out.nodes;
    std::deque<std::pair<std::size_t, int>> waiting; // node of the file, parent in `nodes`
    for (const std::size_t root : this->Roots()) {
      waiting.emplace_back(root, -1);
    }
    while (!waiting.empty()) {
      const auto [index, parent] = waiting.front();
      waiting.pop_front();
      const std::string where = "nodes[" + std::to_string(index) + "]";
      if (this->Seen_[index]) {
        this->Document_.Fail(where + " has two parents or is its own ancestor");
      }
      this->Seen_[index] = true;
      const Json::Value& json = this->Document_.Element("nodes", index);
      ModelNode node;
      node.parent = parent;
      node.name = json["name"].isString() ? json["name"].asString() : "";
      node.local = NodeTransform(this->Document_, json, where);
      if (!json["mesh"].isNull()) {
        node.meshes = this->MeshesOf_[this->Document_.Index(json, "mesh", "meshes", where)];
      }
      out.indexOf[index] = static_cast<int>(nodes.size());
      const int own = static_cast<int>(nodes.size());
      nodes.push_back(std::move(node));
      const Json::Value& instancing = json["extensions"]["EXT_mesh_gpu_instancing"];
      if (instancing.isObject() && !this->Document_.Buffers().empty()) {
        this->AddInstances(instancing["attributes"], own, where, nodes);
      }
      for (const std::size_t child : this->Indices(json["children"], where + ".children")) {
        waiting.emplace_back(child, own);
      }
    }
    return out;
  }

private:
  // A child for each instance, which draws the node's meshes in its place.
  void AddInstances(const Json::Value& attributes, int parent, const std::string& where,
                    std::vector<ModelNode>& nodes) {
    if (!attributes.isObject()) {
      this->Document_.Fail(where + ".EXT_mesh_gpu_instancing has no attributes");
    }
    std::size_t count = 0;
    const auto values = [&](const char* name, std::size_t components) {
      if (attributes[name].isNull()) {
        return std::vector<float>();
      }
      const GltfAccessor accessor = CheckGltfAccessor(
          this->Document_, this->Document_.Index(attributes, name, "accessors", where),
          MaximumInstances - this->Instances_);
      if (accessor.components != components || (count != 0 && accessor.count != count)) {
        this->Document_.Fail(where + "." + name + " does not fit the other attributes");
      }
      count = accessor.count;
      return GltfAccessorFloats(this->Document_, accessor, components, 0.0f);
    };
    const std::vector<float> t = values("TRANSLATION", 3);
    const std::vector<float> r = values("ROTATION", 4);
    const std::vector<float> s = values("SCALE", 3);
    const std::vector<int> meshes = std::move(nodes[std::size_t(parent)].meshes);
    nodes[std::size_t(parent)].meshes.clear();
    this->Instances_ += count;
    for (std::size_t i = 0; i < count; ++i) {
      ModelNode node;
      node.parent = parent;
      node.meshes = meshes;
      const auto vector = [i](const std::vector<float>& v, double fallback) {
        return v.empty() ? Eigen::Vector3d(fallback, fallback, fallback)
                         : Eigen::Vector3d(v[3 * i], v[3 * i + 1], v[3 * i + 2]);
      };
      Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
      if (!r.empty()) {
        q = Eigen::Quaterniond(r[4 * i + 3], r[4 * i], r[4 * i + 1], r[4 * i + 2]);
      }
      if (!(q.norm() > 1e-6) || !std::isfinite(q.norm())) {
        this->Document_.Fail(where + ".ROTATION " + std::to_string(i) + " is not a rotation");
      }
      node.local =
          Eigen::Translation3d(vector(t, 0.0)) * q.normalized() * Eigen::Scaling(vector(s, 1.0));
      nodes.push_back(std::move(node));
    }
  }

  std::vector<std::size_t> Indices(const Json::Value& array, const std::string& where) const {
    std::vector<std::size_t> out;
    if (!array.isNull() && !array.isArray()) {
      this->Document_.Fail(where + " is not an array");
    }
    for (const Json::Value& value : array) {
      const std::size_t size = this->Seen_.size();
      if (!value.isUInt64() || value.asUInt64() >= size) {
        this->Document_.Fail(where + " names a node that is none of the " + std::to_string(size));
      }
      out.push_back(static_cast<std::size_t>(value.asUInt64()));
    }
    return out;
  }

  // Nodes of the default scene, or of the first; of a file without scenes, all that have no parent.
  std::vector<std::size_t> Roots() const {
    if (!this->Document_.Array("scenes").empty()) {
      const std::size_t scene =
          this->Document_.Root()["scene"].isNull()
              ? 0
              : this->Document_.Index(this->Document_.Root(), "scene", "scenes", "the file");
      return this->Indices(this->Document_.Element("scenes", scene)["nodes"],
                           "scenes[" + std::to_string(scene) + "].nodes");
    }
    std::vector<bool> isChild(this->Seen_.size(), false);
    for (std::size_t i = 0; i < isChild.size(); ++i) {
      const std::string where = "nodes[" + std::to_string(i) + "].children";
      for (const std::size_t child :
           this->Indices(this->Document_.Element("nodes", i)["children"], where)) {
        isChild[child] = true;
      }
    }
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < isChild.size(); ++i) {
      if (!isChild[i]) {
        roots.push_back(i);
      }
    }
    return roots;
  }

  const GltfDocument& Document_;
  const std::vector<std::vector<int>>& MeshesOf_;
  std::vector<bool> Seen_;
  std::size_t Instances_ = 0;
};

} // namespace

GltfNodes ReadGltfNodes(const GltfDocument& document,
                        const std::vector<std::vector<int>>& meshesOf) {
  return NodeReader(document, meshesOf).Read();
}

} // namespace dspace
