// Polygons to triangles. Internal, not installed.
#ifndef DSPACE_IMPORT_POLYGON_H
#define DSPACE_IMPORT_POLYGON_H

#include <array>
#include <vector>

#include <Eigen/Core>

namespace dspace {

// Twice the area vector of a polygon in space (Newell's method): its length is twice the area, its
// direction the side from which the corners run counter-clockwise.
Eigen::Vector3d PolygonNormal(const std::vector<Eigen::Vector3d>& corners);

// Appends triangles, as indices into `corners`, that cover the polygon and keep its direction; the
// polygon is taken as planar and seen along its normal. A convex one gives the fan from its first
// corner; otherwise ears are cut, and where no ear is left (it crosses itself), or it has more
// than 4096 corners, the rest is a fan. Always corners - 2 triangles; none below three corners.
void TriangulatePolygon(const std::vector<Eigen::Vector3d>& corners, bool convex,
                        std::vector<std::array<int, 3>>& triangles);

} // namespace dspace

#endif
