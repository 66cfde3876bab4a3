#include <dspace/import/vrml/VrmlSolids.h>

#include <cmath>

namespace dspace {

namespace {

std::uint32_t AddVertex(Mesh& mesh, const Eigen::Vector3d& p, const Eigen::Vector3d& n, double u,
                        double v) {
  for (int i = 0; i < 3; ++i) {
    mesh.positions.push_back(static_cast<float>(p[i]));
    mesh.normals.push_back(static_cast<float>(n[i]));
  }
  mesh.tcoords.push_back(static_cast<float>(u));
  mesh.tcoords.push_back(static_cast<float>(v));
  return static_cast<std::uint32_t>(mesh.VertexCount() - 1);
}

void AddTriangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

// Direction at which the texture coordinate u stands: from the back (-Z) counter-clockwise seen
// from above, so by -X, +Z and +X.
Eigen::Vector3d Around(int slice) {
  const int s = slice % VrmlSlices; // the seam's two sides are the same to the bit
  const double angle = 2.0 * M_PI * s / VrmlSlices;
  return {-std::sin(angle), 0.0, -std::cos(angle)};
}

// A disc at height y, seen from above (up) or from below.
void AddCap(Mesh& mesh, double radius, double y, bool up) {
  const Eigen::Vector3d normal(0.0, up ? 1.0 : -1.0, 0.0);
  const auto first = static_cast<std::uint32_t>(mesh.VertexCount());
  for (int s = 0; s < VrmlSlices; ++s) {
    const Eigen::Vector3d d = Around(s);
    AddVertex(mesh, radius * d + Eigen::Vector3d(0.0, y, 0.0), normal, 0.5 + 0.5 * d.x(),
              0.5 + (up ? -0.5 : 0.5) * d.z());
  }
  for (std::uint32_t s = 1; s + 1 < VrmlSlices; ++s) {
    AddTriangle(mesh, first, first + (up ? s : s + 1), first + (up ? s + 1 : s));
  }
}

} // namespace

Mesh MakeVrmlBox(const Eigen::Vector3d& size) {
  // Normal and the texture's right-hand direction of each side.
  const Eigen::Vector3d sides[6][2] = {{{0, 0, 1}, {1, 0, 0}},  {{0, 0, -1}, {-1, 0, 0}},
                                       {{1, 0, 0}, {0, 0, -1}}, {{-1, 0, 0}, {0, 0, 1}},
                                       {{0, 1, 0}, {1, 0, 0}},  {{0, -1, 0}, {1, 0, 0}}};
  Mesh mesh;
  for (const auto& [normal, right] : sides) {
    const Eigen::Vector3d up = normal.cross(right);
    std::uint32_t v[4];
    const double corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i < 4; ++i) {
      const double* c = corners[i];
      const Eigen::Vector3d p =
          0.5 * normal + (c[0] - 0.5) * right + (c[1] - 0.5) * up; // of the unit cube
      v[i] = AddVertex(mesh, p.cwiseProduct(size), normal, c[0], c[1]);
    }
    AddTriangle(mesh, v[0], v[1], v[2]);
    AddTriangle(mesh, v[0], v[2], v[3]);
  }
  return mesh;
}

Mesh MakeVrmlSphere(double radius) {
  Mesh mesh;
  const auto vertex = [](int stack, int slice) {
    return static_cast<std::uint32_t>(stack * (VrmlSlices + 1) + slice);
  };
  for (int stack = 0; stack <= VrmlStacks; ++stack) { // from the south pole
    const double v = static_cast<double>(stack) / VrmlStacks;
    const bool pole = stack == 0 || stack == VrmlStacks;
    const double ring = pole ? 0.0 : std::sin(M_PI * v);
    for (int slice = 0; slice <= VrmlSlices; ++slice) {
      const Eigen::Vector3d n =
          ring * Around(slice) + Eigen::Vector3d(0.0, -std::cos(M_PI * v), 0.0);
      // At a pole the texture coordinate of the middle of the triangle that ends there.
      const double u = (slice + (pole ? 0.5 : 0.0)) / VrmlSlices;
      AddVertex(mesh, radius * n, n, u, v);
    }
  }
  for (int stack = 0; stack < VrmlStacks; ++stack) {
    for (int slice = 0; slice < VrmlSlices; ++slice) {
      if (stack > 0) {
        AddTriangle(mesh, vertex(stack, slice), vertex(stack, slice + 1), vertex(stack + 1, slice));
      }
      if (stack + 1 < VrmlStacks) {
        AddTriangle(mesh, vertex(stack, stack > 0 ? slice + 1 : slice),
                    vertex(stack + 1, slice + 1), vertex(stack + 1, slice));
      }
    }
  }
  return mesh;
}

Mesh MakeVrmlCylinder(double radius, double height, bool side, bool top, bool bottom) {
  Mesh mesh;
  for (int s = 0; side && s <= VrmlSlices; ++s) {
    const Eigen::Vector3d n = Around(s);
    const double u = static_cast<double>(s) / VrmlSlices;
    const Eigen::Vector3d half(0.0, 0.5 * height, 0.0);
    const std::uint32_t low = AddVertex(mesh, radius * n - half, n, u, 0.0);
    AddVertex(mesh, radius * n + half, n, u, 1.0);
    if (s > 0) {
      AddTriangle(mesh, low - 2, low, low + 1);
      AddTriangle(mesh, low - 2, low + 1, low - 1);
    }
  }
  if (top) {
    AddCap(mesh, radius, 0.5 * height, true);
  }
  if (bottom) {
    AddCap(mesh, radius, -0.5 * height, false);
  }
  return mesh;
}

Mesh MakeVrmlCone(double bottomRadius, double height, bool side, bool bottom) {
  Mesh mesh;
  const double slant = std::hypot(bottomRadius, height);
  for (int s = 0; side && s < VrmlSlices; ++s) {
    const auto normal = [&](const Eigen::Vector3d& d) {
      return Eigen::Vector3d((height * d + Eigen::Vector3d(0.0, bottomRadius, 0.0)) / slant);
    };
    const Eigen::Vector3d half(0.0, 0.5 * height, 0.0);
    const double u = static_cast<double>(s) / VrmlSlices;
    const double du = 1.0 / VrmlSlices;
    const Eigen::Vector3d a = Around(s);
    const Eigen::Vector3d b = Around(s + 1);
    const std::uint32_t v = AddVertex(mesh, bottomRadius * a - half, normal(a), u, 0.0);
    AddVertex(mesh, bottomRadius * b - half, normal(b), u + du, 0.0);
    AddVertex(mesh, half, normal((a + b).normalized()), u + 0.5 * du, 1.0);
    AddTriangle(mesh, v, v + 1, v + 2);
  }
  if (bottom) {
    AddCap(mesh, bottomRadius, -0.5 * height, false);
  }
  return mesh;
}

bool MakeVrmlElevationGrid(const VrmlElevationGrid& grid, VrmlFaces& faces,
                           VrmlComplaints& complaints) {
  const long long nx = grid.xDimension;
  const long long nz = grid.zDimension;
  const auto heights = static_cast<long long>(grid.heights.size());
  // Compared without a product, which may overflow.
  if (nx < 2 || nz < 2 || nx > heights || nz > heights / nx) {
    complaints.push_back("an ElevationGrid of " + std::to_string(nx) + " x " + std::to_string(nz) +
                         " with " + std::to_string(heights) + " heights is left out");
    return false;
  }
  for (long long z = 0; z < nz; ++z) {
    for (long long x = 0; x < nx; ++x) {
      faces.points.emplace_back(static_cast<float>(static_cast<double>(x) * grid.xSpacing),
                                grid.heights[static_cast<std::size_t>(x + z * nx)],
                                static_cast<float>(static_cast<double>(z) * grid.zSpacing));
      faces.tcoords.values.emplace_back(static_cast<float>(x) / static_cast<float>(nx - 1),
                                        static_cast<float>(z) / static_cast<float>(nz - 1));
    }
  }
  for (long long z = 0; z + 1 < nz; ++z) {
    for (long long x = 0; x + 1 < nx; ++x) {
      const int i = static_cast<int>(x + z * nx);
      const int n = static_cast<int>(nx);
      faces.coordIndex.insert(faces.coordIndex.end(), {i, i + n, i + n + 1, i + 1, -1});
    }
  }
  faces.tcoords.binding = VrmlBinding::PerCornerIndexed;
  return true;
}

} // namespace dspace
