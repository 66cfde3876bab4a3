#include <dspace/render/shadows/CasterParts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <dspace/import/model/Model.h>

namespace dspace {

std::vector<Eigen::AlignedBox3f> PartsOf(const Mesh& mesh) {
  constexpr std::size_t Small = std::size_t(8) * TrianglesAPart;
  const std::size_t count = mesh.PrimitiveCount();
  if (mesh.primitive != Mesh::Primitive::Triangles || count < Small) {
    return {};
  }
  const auto corner = [&](std::size_t triangle, std::size_t k) {
    const float* at = mesh.positions.data() + std::size_t(mesh.indices[3 * triangle + k]) * 3;
    return Eigen::Vector3f(at[0], at[1], at[2]);
  };
  Eigen::AlignedBox3f bounds;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      bounds.extend(corner(i, k));
    }
  }
  // Most meshes are surfaces: as many cells lie over the two greatest extents as there are parts.
  std::array<float, 3> extent = {bounds.sizes()[0], bounds.sizes()[1], bounds.sizes()[2]};
  std::sort(extent.begin(), extent.end());
  const double parts = double(std::min<std::size_t>(count / TrianglesAPart, MostParts));
  const float cell = float(
      std::max(std::sqrt(double(extent[1]) * extent[2] / parts), double(extent[2]) / MostParts));
  if (!(cell > 0.0f) || !std::isfinite(cell)) {
    return {};
  }
  const Eigen::Array3i cells = (bounds.sizes().array() / cell).ceil().max(1.0f).cast<int>();
  std::vector<Eigen::AlignedBox3f> grid(std::size_t(cells[0]) * cells[1] * cells[2]);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::AlignedBox3f triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.extend(corner(i, k));
    }
    const Eigen::Array3i at =
        ((triangle.center() - bounds.min()).array() / cell).cast<int>().max(0).min(cells - 1);
    grid[(std::size_t(at[2]) * cells[1] + at[1]) * cells[0] + at[0]].extend(triangle);
  }
  grid.erase(std::remove_if(grid.begin(), grid.end(),
                            [](const Eigen::AlignedBox3f& box) { return box.isEmpty(); }),
             grid.end());
  return grid;
}

} // namespace dspace
