// A mesh in pieces, of which the tiles of shadow maps tell apart where it reaches high.
#ifndef DSPACE_RENDER_SHADOWS_CASTER_PARTS_H
#define DSPACE_RENDER_SHADOWS_CASTER_PARTS_H

#include <vector>

#include <Eigen/Geometry>

namespace dspace {

struct Mesh;

// Boxes, in the mesh's own axes, that hold all of its triangles: those whose middles lie in the
// same cell of a cubic grid have one. A mesh of n triangles has some n / TrianglesAPart of them,
// some MostParts for the largest. Empty for lines, points and small meshes, whose bounds serve.
constexpr int TrianglesAPart = 12;
constexpr int MostParts = 1024;
std::vector<Eigen::AlignedBox3f> PartsOf(const Mesh& mesh);

} // namespace dspace

#endif
