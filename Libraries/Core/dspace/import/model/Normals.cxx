#include <dspace/import/model/Normals.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <unordered_map>

#include <dspace/Error.h>

namespace dspace {

namespace {

constexpr double RadiansPerDegree = 3.14159265358979323846 / 180.0;

Eigen::Vector3d Position(const Mesh& mesh, std::uint32_t vertex) {
  const float* p = &mesh.positions[3 * std::size_t(vertex)];
  return {p[0], p[1], p[2]};
}

// Vertices at the same place get the same number: seams of texture or colour are no creases.
std::vector<std::uint32_t> WeldByPosition(const Mesh& mesh) {
  struct Hash {
    std::size_t operator()(const std::array<float, 3>& p) const {
      std::size_t h = 1469598103934665603ull;
      for (const float f : p) {
        std::uint32_t bits;
        std::memcpy(&bits, &f, sizeof bits);
        h = (h ^ bits) * 1099511628211ull;
        h ^= h >> 29;
      }
      return h;
    }
  };
  std::unordered_map<std::array<float, 3>, std::uint32_t, Hash> seen;
  seen.reserve(mesh.VertexCount());
  std::vector<std::uint32_t> weld(mesh.VertexCount());
  for (std::size_t v = 0; v < weld.size(); ++v) {
    // Adding zero turns -0 into +0, which compare equal but hash apart.
    const std::array<float, 3> p = {mesh.positions[3 * v] + 0.0f, mesh.positions[3 * v + 1] + 0.0f,
                                    mesh.positions[3 * v + 2] + 0.0f};
    weld[v] = seen.emplace(p, static_cast<std::uint32_t>(v)).first->second;
  }
  return weld;
}

// Sets of corners that share one normal.
class CornerSets {
public:
  explicit CornerSets(std::size_t corners) : Parent_(corners) {
    std::iota(this->Parent_.begin(), this->Parent_.end(), 0u);
  }
  std::uint32_t Find(std::uint32_t c) {
    while (this->Parent_[c] != c) {
      c = this->Parent_[c] = this->Parent_[this->Parent_[c]];
    }
    return c;
  }
  void Join(std::uint32_t a, std::uint32_t b) {
    a = this->Find(a);
    b = this->Find(b);
    this->Parent_[std::max(a, b)] = std::min(a, b);
  }

private:
  std::vector<std::uint32_t> Parent_;
};

// A triangle's side between two welded vertices, the lower one first.
struct Side {
  std::uint32_t low, high;             // welded vertices
  std::uint32_t lowCorner, highCorner; // positions in mesh.indices
  bool operator<(const Side& o) const {
    return std::tie(this->low, this->high, this->lowCorner) < std::tie(o.low, o.high, o.lowCorner);
  }
};

std::vector<Side> SortedSides(const Mesh& mesh, const std::vector<std::uint32_t>& weld) {
  std::vector<Side> sides;
  sides.reserve(mesh.indices.size());
  for (std::uint32_t c = 0; c < mesh.indices.size(); ++c) {
    const std::uint32_t d = c % 3 == 2 ? c - 2 : c + 1;
    const std::uint32_t a = weld[mesh.indices[c]], b = weld[mesh.indices[d]];
    if (a != b) {
      sides.push_back(a < b ? Side{a, b, c, d} : Side{b, a, d, c});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

// Joins the corners on both ends of every edge that is flatter than the crease angle.
void JoinFlatEdges(const std::vector<Side>& sides, const std::vector<Eigen::Vector3d>& faceNormals,
                   double cosCrease, CornerSets& sets) {
  // Beyond this many triangles on one edge only neighbours in file order are compared, so that a
  // file with all its triangles on one edge does not take quadratic time.
  constexpr std::size_t maximumPairs = 8;
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].low == sides[begin].low &&
           sides[end].high == sides[begin].high) {
      ++end;
    }
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t last = end - begin <= maximumPairs ? end : std::min(end, i + 2);
      for (std::size_t j = i + 1; j < last; ++j) {
        if (faceNormals[sides[i].lowCorner / 3].dot(faceNormals[sides[j].lowCorner / 3]) >=
            cosCrease) {
          sets.Join(sides[i].lowCorner, sides[j].lowCorner);
          sets.Join(sides[i].highCorner, sides[j].highCorner);
        }
      }
    }
    begin = end;
  }
}

// Copies a vertex's attributes, all but its normal, to the end of the mesh.
std::uint32_t DuplicateVertex(Mesh& mesh, std::uint32_t v) {
  const auto copy = [v](auto& array, std::size_t n) {
    if (!array.empty()) {
      for (std::size_t k = 0; k < n; ++k) {
        array.push_back(array[n * v + k]);
      }
    }
  };
  copy(mesh.positions, 3);
  copy(mesh.tcoords, 2);
  copy(mesh.colors, 4);
  return static_cast<std::uint32_t>(mesh.VertexCount() - 1);
}

double AngleAt(const Mesh& mesh, std::size_t corner) {
  const std::size_t first = corner - corner % 3;
  const Eigen::Vector3d p = Position(mesh, mesh.indices[corner]);
  const Eigen::Vector3d a = Position(mesh, mesh.indices[first + (corner + 1) % 3]) - p;
  const Eigen::Vector3d b = Position(mesh, mesh.indices[first + (corner + 2) % 3]) - p;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

} // namespace

void ComputeNormals(Mesh& mesh, double creaseAngle_deg) {
  if (!(creaseAngle_deg >= 0.0 && creaseAngle_deg <= 180.0)) {
    throw Error(Error::Kind::InvalidArgument, "mesh '" + mesh.name + "'",
                "crease angle " + std::to_string(creaseAngle_deg) + " is outside [0, 180] degrees");
  }
  if (mesh.primitive != Mesh::Primitive::Triangles || !mesh.normals.empty() ||
      mesh.indices.empty()) {
    return;
  }
  const std::size_t corners = mesh.indices.size();
  std::vector<Eigen::Vector3d> faceNormals(corners / 3);
  for (std::size_t f = 0; f < faceNormals.size(); ++f) {
    const Eigen::Vector3d p = Position(mesh, mesh.indices[3 * f]);
    const Eigen::Vector3d n = (Position(mesh, mesh.indices[3 * f + 1]) - p)
                                  .cross(Position(mesh, mesh.indices[3 * f + 2]) - p);
    const double length = n.norm();
    faceNormals[f] = length > 0.0 ? Eigen::Vector3d(n / length) : Eigen::Vector3d::Zero();
  }

  CornerSets sets(corners);
  // The slack lets faces that are flat but for rounding pass at a crease angle of zero.
  const double cosCrease = std::cos(creaseAngle_deg * RadiansPerDegree) - 1e-12;
  JoinFlatEdges(SortedSides(mesh, WeldByPosition(mesh)), faceNormals, cosCrease, sets);

  // Weighted by the angle at the corner, the sum does not depend on how a surface is triangulated.
  std::vector<Eigen::Vector3d> sums(corners, Eigen::Vector3d::Zero());
  for (std::uint32_t c = 0; c < corners; ++c) {
    sums[sets.Find(c)] += AngleAt(mesh, c) * faceNormals[c / 3];
  }

  // The first set that reaches a vertex keeps it; each further set gets a copy.
  std::unordered_map<std::uint64_t, std::uint32_t> copies;
  constexpr std::uint32_t none = 0xffffffffu;
  std::vector<std::uint32_t> setOfVertex(mesh.VertexCount(), none);
  for (std::uint32_t c = 0; c < corners; ++c) {
    const std::uint32_t set = sets.Find(c), vertex = mesh.indices[c];
    if (setOfVertex[vertex] == none) {
      setOfVertex[vertex] = set;
    } else if (setOfVertex[vertex] != set) {
      const auto [found, isNew] = copies.emplace((std::uint64_t(vertex) << 32) | set, 0u);
      if (isNew) {
        found->second = DuplicateVertex(mesh, vertex);
        setOfVertex.push_back(set);
      }
      mesh.indices[c] = found->second;
    }
  }
  mesh.normals.resize(mesh.positions.size());
  for (std::size_t v = 0; v < setOfVertex.size(); ++v) {
    const Eigen::Vector3d sum =
        setOfVertex[v] == none ? Eigen::Vector3d::Zero() : sums[setOfVertex[v]];
    const double length = sum.norm();
    // A vertex of degenerate triangles only has no normal; any unit vector serves.
    const Eigen::Vector3d n =
        length > 1e-12 ? Eigen::Vector3d(sum / length) : Eigen::Vector3d::UnitZ();
    for (int k = 0; k < 3; ++k) {
      mesh.normals[3 * v + std::size_t(k)] = static_cast<float>(n[k]);
    }
  }
}

} // namespace dspace
