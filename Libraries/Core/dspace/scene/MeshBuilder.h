// Writes vertices and triangles into a Mesh.
#ifndef DSPACE_SCENE_MESH_BUILDER_H
#define DSPACE_SCENE_MESH_BUILDER_H

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/Checks.h>
#include <dspace/import/model/Model.h>
#include <dspace/import/model/SolidMesh.h>

namespace dspace {

inline void RequireResolution(const std::string& object, int resolution) {
  Require(resolution >= 3 && resolution <= 1024, object, "resolution", resolution, "3 to 1024");
}

class MeshBuilder {
public:
  explicit MeshBuilder(std::string name) { this->Mesh_.name = std::move(name); }

  std::uint32_t Vertex(const Eigen::Vector3d& p, const Eigen::Vector3d& normal, double u,
                       double v) {
    const auto index = static_cast<std::uint32_t>(this->Mesh_.VertexCount());
    for (int i = 0; i < 3; ++i) {
      this->Mesh_.positions.push_back(static_cast<float>(p[i]));
      this->Mesh_.normals.push_back(static_cast<float>(normal[i]));
    }
    this->Mesh_.tcoords.push_back(static_cast<float>(u));
    this->Mesh_.tcoords.push_back(static_cast<float>(v));
    return index;
  }

  void Triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    this->Mesh_.indices.insert(this->Mesh_.indices.end(), {a, b, c});
  }

  // A flat, convex face with vertices of its own, counter-clockwise seen from outside, the first
  // three not in line. Texture: the unit square's corners in turn from the bottom left.
  void Face(const std::vector<Eigen::Vector3d>& corners) {
    static constexpr double U[] = {0, 1, 1, 0};
    static constexpr double V[] = {0, 0, 1, 1};
    const Eigen::Vector3d normal =
        (corners[1] - corners[0]).cross(corners[2] - corners[1]).stableNormalized();
    std::vector<std::uint32_t> at;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      at.push_back(this->Vertex(corners[i], normal, U[i % 4], V[i % 4]));
    }
    for (std::size_t i = 2; i < at.size(); ++i) {
      this->Triangle(at[0], at[i - 1], at[i]);
    }
  }

  Mesh Take() {
    this->Mesh_.solid = IsSolid(this->Mesh_);
    return std::move(this->Mesh_);
  }

private:
  Mesh Mesh_;
};

} // namespace dspace

#endif
