#include <dspace/import/gltf/GltfNodes.h>

#include <deque>

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

class NodeReader {
public:
  NodeReader(const GltfDocument& document, const std::vector<std::vector<int>>& meshesOf)
      : Document_(document), MeshesOf_(meshesOf), Seen_(document.Array("nodes").size(), false) {}

  // Parents first, without recursion: a file may be as deep as it likes.
  std::vector<ModelNode> Read() {
    std::vector<ModelNode> nodes;
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
      nodes.push_back(std::move(node));
      for (const std::size_t child : this->Indices(json["children"], where + ".children")) {
        waiting.emplace_back(child, static_cast<int>(nodes.size()) - 1);
      }
    }
    return nodes;
  }

private:
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
};

} // namespace

std::vector<ModelNode> ReadGltfNodes(const GltfDocument& document,
                                     const std::vector<std::vector<int>>& meshesOf) {
  return NodeReader(document, meshesOf).Read();
}

} // namespace dspace
