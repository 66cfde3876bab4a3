#include <dspace/import/model/MeshRepair.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace dspace {

namespace {

std::size_t CornersOf(const Mesh& mesh) {
  return mesh.primitive == Mesh::Primitive::Triangles ? 3
         : mesh.primitive == Mesh::Primitive::Lines   ? 2
                                                      : 1;
}

// Whether every array has the size that its use needs.
bool IsWhole(const Mesh& mesh) {
  const std::size_t n = mesh.VertexCount();
  const auto fits = [n](const auto& array, std::size_t width) {
    return array.empty() || array.size() == width * n;
  };
  return mesh.positions.size() == 3 * n && fits(mesh.normals, 3) && fits(mesh.tcoords, 2) &&
         fits(mesh.colors, 4) && mesh.indices.size() % CornersOf(mesh) == 0 &&
         std::all_of(mesh.indices.begin(), mesh.indices.end(),
                     [n](std::uint32_t i) { return i < n; });
}

bool IsFinite(const std::vector<float>& values, std::size_t first, std::size_t n) {
  return std::all_of(values.begin() + std::ptrdiff_t(first),
                     values.begin() + std::ptrdiff_t(first + n),
                     [](float v) { return std::isfinite(v); });
}

void Note(std::size_t at, std::size_t& count, std::size_t& first) {
  if (count++ == 0) {
    first = at;
  }
}

void DropBadPrimitives(Mesh& mesh, MeshFlaws& flaws) {
  std::vector<bool> bad(mesh.VertexCount(), false);
  bool any = false;
  for (std::size_t v = 0; v < bad.size(); ++v) {
    bad[v] = !IsFinite(mesh.positions, 3 * v, 3);
    any = any || bad[v];
  }
  if (!any) {
    return;
  }
  const std::size_t corners = CornersOf(mesh);
  std::size_t kept = 0;
  for (std::size_t i = 0; i + corners <= mesh.indices.size(); i += corners) {
    bool good = true;
    for (std::size_t k = 0; k < corners; ++k) {
      good = good && !bad[mesh.indices[i + k]];
      mesh.indices[kept + k] = mesh.indices[i + k];
    }
    if (good) {
      kept += corners;
    } else {
      Note(i / corners, flaws.primitives, flaws.firstPrimitive);
    }
  }
  mesh.indices.resize(kept);
  DropUnusedVertices(mesh);
}

Eigen::Vector3d At(const Mesh& mesh, std::uint32_t i) {
  return {mesh.positions[3 * std::size_t(i)], mesh.positions[3 * std::size_t(i) + 1],
          mesh.positions[3 * std::size_t(i) + 2]};
}

void RepairNormals(Mesh& mesh, MeshFlaws& flaws) {
  std::vector<std::uint32_t> bad;
  for (std::size_t v = 0; 3 * v < mesh.normals.size(); ++v) {
    float* n = &mesh.normals[3 * v];
    const double length = std::hypot(double(n[0]), double(n[1]), double(n[2]));
    if (length > 1e-20 && std::isfinite(length)) {
      for (int k = 0; k < 3; ++k) {
        n[k] = static_cast<float>(n[k] / length);
      }
    } else {
      Note(v, flaws.normals, flaws.firstNormal);
      bad.push_back(static_cast<std::uint32_t>(v));
    }
  }
  if (bad.empty()) {
    return;
  }
  if (bad.size() == mesh.VertexCount() || mesh.primitive != Mesh::Primitive::Triangles) {
    mesh.normals.clear();
    return;
  }
  std::vector<Eigen::Vector3d> sums(mesh.VertexCount(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Eigen::Vector3d a = At(mesh, mesh.indices[i]);
    const Eigen::Vector3d normal =
        (At(mesh, mesh.indices[i + 1]) - a).cross(At(mesh, mesh.indices[i + 2]) - a);
    for (std::size_t k = 0; k < 3; ++k) {
      sums[mesh.indices[i + k]] += normal; // twice the area: large faces count more
    }
  }
  for (const std::uint32_t v : bad) {
    const double length = sums[v].norm();
    const Eigen::Vector3d n = length > 0.0 && std::isfinite(length)
                                  ? Eigen::Vector3d(sums[v] / length)
                                  : Eigen::Vector3d::UnitZ(); // no triangle with an area uses it
    for (int k = 0; k < 3; ++k) {
      mesh.normals[3 * std::size_t(v) + std::size_t(k)] = static_cast<float>(n[k]);
    }
  }
}

} // namespace

MeshFlaws RepairMesh(Mesh& mesh) {
  MeshFlaws flaws;
  if (!IsWhole(mesh)) {
    return flaws;
  }
  DropBadPrimitives(mesh, flaws);
  RepairNormals(mesh, flaws);
  for (std::size_t v = 0; 2 * v < mesh.tcoords.size(); ++v) {
    if (!IsFinite(mesh.tcoords, 2 * v, 2)) {
      Note(v, flaws.tcoords, flaws.firstTcoord);
      mesh.tcoords[2 * v] = mesh.tcoords[2 * v + 1] = 0.0f;
    }
  }
  return flaws;
}

void DropUnusedVertices(Mesh& mesh) {
  const std::size_t count = mesh.VertexCount();
  constexpr std::uint32_t unused = 0xffffffffu;
  std::vector<std::uint32_t> moved(count, unused);
  for (const std::uint32_t i : mesh.indices) {
    if (i >= count) {
      return;
    }
    moved[i] = 0;
  }
  std::uint32_t kept = 0;
  const auto move = [&](auto& array, std::size_t n, std::size_t from) {
    for (std::size_t k = 0; k < n && !array.empty(); ++k) {
      array[n * kept + k] = array[n * from + k];
    }
  };
  for (std::size_t v = 0; v < count; ++v) {
    if (moved[v] != unused) {
      move(mesh.positions, 3, v);
      move(mesh.normals, 3, v);
      move(mesh.tcoords, 2, v);
      move(mesh.colors, 4, v);
      moved[v] = kept++;
    }
  }
  if (kept == count) {
    return;
  }
  const auto cut = [kept](auto& array, std::size_t n) {
    if (!array.empty()) {
      array.resize(n * kept);
      array.shrink_to_fit();
    }
  };
  cut(mesh.positions, 3);
  cut(mesh.normals, 3);
  cut(mesh.tcoords, 2);
  cut(mesh.colors, 4);
  for (std::uint32_t& i : mesh.indices) {
    i = moved[i];
  }
}

} // namespace dspace
