#include <dspace/import/model/SolidMesh.h>

#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace dspace {
namespace {

constexpr double WeldCells = 1 << 20; // of the mesh's largest extent; fits 21 bits an axis

// A hash table from 64-bit keys (never ~0) to numbers, of a size known beforehand.
class KeyTable {
public:
  explicit KeyTable(std::size_t most) {
    std::size_t size = 16;
    for (this->Shift_ = 60; size < 2 * most; size *= 2) {
      --this->Shift_;
    }
    this->Keys_.assign(size, ~std::uint64_t(0));
    this->Values_.resize(size);
  }

  // The key's number, and whether it is `value`, put there now.
  std::pair<std::uint32_t, bool> Insert(std::uint64_t key, std::uint32_t value) {
    const std::size_t at = this->Find(key);
    const bool isNew = this->Keys_[at] != key;
    if (isNew) {
      this->Keys_[at] = key;
      this->Values_[at] = value;
    }
    return {this->Values_[at], isNew};
  }

  bool Has(std::uint64_t key) const { return this->Keys_[this->Find(key)] == key; }

private:
  // Where the key is, or the free place where it belongs.
  std::size_t Find(std::uint64_t key) const {
    const std::size_t mask = this->Keys_.size() - 1;
    std::size_t at = key * 0x9e3779b97f4a7c15u >> this->Shift_;
    while (this->Keys_[at] != key && this->Keys_[at] != ~std::uint64_t(0)) {
      at = (at + 1) & mask;
    }
    return at;
  }

  int Shift_ = 60;
  std::vector<std::uint64_t> Keys_;
  std::vector<std::uint32_t> Values_;
};

Eigen::Vector3d Position(const Mesh& mesh, std::size_t i) {
  return {mesh.positions[3 * i], mesh.positions[3 * i + 1], mesh.positions[3 * i + 2]};
}

Eigen::AlignedBox3d BoxOf(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < mesh.VertexCount(); ++i) {
    box.extend(Position(mesh, i));
  }
  return box;
}

// What most open meshes fail, without a table of vertices or edges. The integral of a constant over
// a closed surface is 0, and that of p n^T its volume times the identity (divergence theorem). The
// tolerance is what welding may move.
bool CouldBeClosed(const Mesh& mesh, const Eigen::AlignedBox3d& box) {
  const double size = box.sizes().maxCoeff();
  const Eigen::Vector3d middle = box.center();
  Eigen::Vector3d area = Eigen::Vector3d::Zero();   // twice
  Eigen::Matrix3d moment = Eigen::Matrix3d::Zero(); // six times
  double edges = 0.0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Eigen::Vector3d a = Position(mesh, mesh.indices[i]) - middle;
    const Eigen::Vector3d b = Position(mesh, mesh.indices[i + 1]) - middle;
    const Eigen::Vector3d c = Position(mesh, mesh.indices[i + 2]) - middle;
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    area += normal;
    moment += (a + b + c) * normal.transpose();
    edges += (b - a).norm() + (c - b).norm() + (a - c).norm();
  }
  const double slack = 32.0 / WeldCells * size * edges;
  const double volume = moment.trace() / 3.0;
  moment.diagonal().array() -= volume;
  return area.cwiseAbs().maxCoeff() <= slack &&
         moment.cwiseAbs().maxCoeff() <= 6.0 * slack * size && volume >= -6.0 * slack * size;
}

struct WeldedMesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> corners; // three a triangle, all different
  double size = 0.0;
};

WeldedMesh Weld(const Mesh& mesh, const Eigen::AlignedBox3d& box) {
  WeldedMesh welded;
  welded.size = box.sizes().maxCoeff();
  const double cells = WeldCells / welded.size;
  KeyTable found(mesh.VertexCount());
  std::vector<std::uint32_t> point(mesh.VertexCount());
  for (std::size_t i = 0; i < mesh.VertexCount(); ++i) {
    const Eigen::Vector3d p = Position(mesh, i);
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) {
      // NOLINTNEXTLINE(bugprone-incorrect-roundings): never negative, and lround is a call
      key = key << 21 | static_cast<std::uint64_t>((p[k] - box.min()[k]) * cells + 0.5);
    }
    const auto [at, isNew] = found.Insert(key, static_cast<std::uint32_t>(welded.points.size()));
    if (isNew) {
      welded.points.push_back(p);
    }
    point[i] = at;
  }
  welded.corners.reserve(mesh.indices.size());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = point[mesh.indices[i]];
    const std::uint32_t b = point[mesh.indices[i + 1]];
    const std::uint32_t c = point[mesh.indices[i + 2]];
    if (a != b && b != c && c != a) { // else it has no area, and its edges cancel
      welded.corners.insert(welded.corners.end(), {a, b, c});
    }
  }
  return welded;
}

bool IsClosed(const WeldedMesh& mesh) {
  const auto edge = [](std::uint32_t from, std::uint32_t to) {
    return static_cast<std::uint64_t>(from) << 32 | to;
  };
  KeyTable edges(mesh.corners.size());
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!edges.Insert(edge(mesh.corners[i + k], mesh.corners[i + (k + 1) % 3]), 0).second) {
        return false; // two triangles pass it in the same direction
      }
    }
  }
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!edges.Has(edge(mesh.corners[i + (k + 1) % 3], mesh.corners[i + k]))) {
        return false; // an edge of a hole
      }
    }
  }
  return true;
}

// A representative of the connected piece that each point belongs to.
std::vector<std::uint32_t> Pieces(const WeldedMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.points.size());
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    parent[i] = i;
  }
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) {
      i = parent[i] = parent[parent[i]];
    }
    return i;
  };
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    parent[root(mesh.corners[i])] = root(mesh.corners[i + 1]);
    parent[root(mesh.corners[i + 1])] = root(mesh.corners[i + 2]);
  }
  for (std::uint32_t i = 0; i < parent.size(); ++i) {
    parent[i] = root(i);
  }
  return parent;
}

bool FacesOutwards(const WeldedMesh& mesh) {
  const std::vector<std::uint32_t> piece = Pieces(mesh);
  std::vector<Eigen::Vector4d> sums(mesh.points.size(), Eigen::Vector4d::Zero());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    sums[piece[i]] += mesh.points[i].homogeneous();
  }
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    const Eigen::Vector3d& a = mesh.points[mesh.corners[i]];
    const Eigen::Vector3d& b = mesh.points[mesh.corners[i + 1]];
    const Eigen::Vector3d& c = mesh.points[mesh.corners[i + 2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double length = normal.norm();
    if (length <= 1e-12 * mesh.size * mesh.size) {
      continue; // a sliver that no pixel shows
    }
    const Eigen::Vector3d middle = sums[piece[mesh.corners[i]]].hnormalized();
    if (normal.dot(a - middle) <= 1e-6 * length * mesh.size) {
      return false;
    }
  }
  return true;
}

} // namespace

bool IsSolid(const Mesh& mesh) {
  if (mesh.primitive != Mesh::Primitive::Triangles || mesh.indices.empty()) {
    return false;
  }
  const Eigen::AlignedBox3d box = BoxOf(mesh);
  if (!(box.sizes().maxCoeff() > 0.0) || !CouldBeClosed(mesh, box)) {
    return false;
  }
  const WeldedMesh welded = Weld(mesh, box);
  // The edges last: theirs is the largest table.
  return !welded.corners.empty() && FacesOutwards(welded) && IsClosed(welded);
}

} // namespace dspace
