// Exact rays and distances against the triangles of a mesh.
#ifndef DSPACE_MEASURE_MESH_RAYS_H
#define DSPACE_MEASURE_MESH_RAYS_H

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/import/model/Model.h>

namespace dspace {

// A corner of a triangle of a mesh, in the mesh's own frame [m].
inline Eigen::Vector3d CornerOf(const Mesh& mesh, std::size_t triangle, int corner) {
  const float* p =
      mesh.positions.data() + 3 * std::size_t(mesh.indices[3 * triangle + std::size_t(corner)]);
  return {p[0], p[1], p[2]};
}

// Calls visit(a, b, c) with the corners of each triangle, in the mesh's order.
template<typename Visit> void ForEachTriangle(const Mesh& mesh, const Visit& visit) {
  for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
    visit(CornerOf(mesh, t, 0), CornerOf(mesh, t, 1), CornerOf(mesh, t, 2));
  }
}

// A tree of boxes over the triangles, in the mesh's own frame M. Arithmetic is double: a crossing's
// error is of the order of 1e-15 of the coordinates in M. Lines and points of a mesh are left out.
// Any thread may call.
class MeshRays {
public:
  // Keeps the mesh, which must not change.
  explicit MeshRays(std::shared_ptr<const Mesh> mesh);

  bool IsEmpty() const { return this->Order_.empty(); }
  // The first crossing with a triangle, of either side, of origin + t * direction for
  // first <= t <= last; +infinity: none. The direction is finite; t is in units of its length.
  double Intersect(const Eigen::Vector3d& origin_M, const Eigen::Vector3d& direction_M,
                   double first, double last) const {
    return this->Cross(origin_M, direction_M, first, last).t;
  }
  struct Crossing {
    double t = std::numeric_limits<double>::infinity();
    // Of the triangle, towards the side from which its corners run counter-clockwise; not unit.
    Eigen::Vector3d normal_M = Eigen::Vector3d::Zero();
  };
  Crossing Cross(const Eigen::Vector3d& origin_M, const Eigen::Vector3d& direction_M, double first,
                 double last) const;

  struct Near {
    double distance = std::numeric_limits<double>::infinity();
    Eigen::Vector3d point = Eigen::Vector3d::Zero(); // of the triangles
  };
  // The point of the triangles nearest to the segment from a to b, in frame W of the segment. Of
  // points that are not nearer than `within`, none: distance +infinity.
  Near Nearest(const Eigen::Affine3d& X_WM, const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W,
               double within) const;
  // The triangles in M.
  template<typename Visit> void ForEach(const Visit& visit) const {
    if (!this->IsEmpty()) {
      ForEachTriangle(*this->Mesh_, visit);
    }
  }

private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t first = 0; // of Order_ in a leaf; else the second child, the first one follows
    std::uint32_t count = 0; // of triangles; 0: not a leaf
  };
  // Visits the corners of each triangle in the boxes that `enter` lets in.
  template<typename Enter, typename Visit> void Walk(const Enter& enter, const Visit& visit) const;
  void Build(std::uint32_t first, std::uint32_t last,
             const std::vector<Eigen::AlignedBox3d>& boxes);

  std::shared_ptr<const Mesh> Mesh_;
  std::vector<std::uint32_t> Order_; // triangles
  std::vector<Node> Nodes_;
};

} // namespace dspace

#endif
