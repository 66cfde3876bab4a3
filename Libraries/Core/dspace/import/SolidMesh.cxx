#include <dspace/import/SolidMesh.h>

#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include <Eigen/Geometry>

namespace dspace {
namespace {

constexpr double WeldCells = 1 << 20; // of the mesh's largest extent; fits 21 bits an axis

struct WeldedMesh {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> corners; // three a triangle, all different
  double size = 0.0;
};

WeldedMesh Weld(const Mesh& mesh) {
  WeldedMesh welded;
  Eigen::AlignedBox3d box;
  const auto position = [&](std::size_t i) {
    return Eigen::Vector3d(mesh.positions[3 * i], mesh.positions[3 * i + 1],
                           mesh.positions[3 * i + 2]);
  };
  for (std::size_t i = 0; i < mesh.VertexCount(); ++i) {
    box.extend(position(i));
  }
  welded.size = box.sizes().maxCoeff();
  if (!(welded.size > 0.0)) {
    return welded;
  }
  std::unordered_map<std::uint64_t, std::uint32_t> found;
  found.reserve(mesh.VertexCount());
  std::vector<std::uint32_t> point(mesh.VertexCount());
  for (std::size_t i = 0; i < mesh.VertexCount(); ++i) {
    const Eigen::Vector3d cell = (position(i) - box.min()) / welded.size * WeldCells;
    std::uint64_t key = 0;
    for (int k = 0; k < 3; ++k) {
      key = key << 21 | static_cast<std::uint64_t>(std::llround(cell[k]));
    }
    const auto entry = found.emplace(key, static_cast<std::uint32_t>(welded.points.size()));
    if (entry.second) {
      welded.points.push_back(position(i));
    }
    point[i] = entry.first->second;
  }
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
  std::unordered_set<std::uint64_t> edges;
  edges.reserve(mesh.corners.size());
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!edges.insert(edge(mesh.corners[i + k], mesh.corners[i + (k + 1) % 3])).second) {
        return false; // two triangles pass it in the same direction
      }
    }
  }
  for (const std::uint64_t e : edges) {
    if (edges.count(e << 32 | e >> 32) == 0) {
      return false; // an edge of a hole
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
  const WeldedMesh welded = Weld(mesh);
  return !welded.corners.empty() && IsClosed(welded) && FacesOutwards(welded);
}

} // namespace dspace
