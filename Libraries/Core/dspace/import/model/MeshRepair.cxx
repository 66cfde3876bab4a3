#include <dspace/import/model/MeshRepair.h>

#include <cmath>

namespace dspace {

bool NormalizeNormals(Mesh& mesh) {
  for (std::size_t i = 0; i + 2 < mesh.normals.size(); i += 3) {
    float* n = &mesh.normals[i];
    const double length = std::hypot(double(n[0]), double(n[1]), double(n[2]));
    if (!(length > 1e-20) || !std::isfinite(length)) {
      mesh.normals.clear();
      return false;
    }
    for (int k = 0; k < 3; ++k) {
      n[k] = static_cast<float>(n[k] / length);
    }
  }
  return true;
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
