// Sunlit area of triangles.
#ifndef DSPACE_MEASURE_LIT_AREA_H
#define DSPACE_MEASURE_LIT_AREA_H

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include <dspace/measure/Obstacles.h>

namespace dspace {

// A disc of even radiance, infinitely far.
struct SunDisc {
  Eigen::Vector3d towards_R = Eigen::Vector3d::UnitZ(); // its centre, unit
  double radius = 0.0;                                  // angular [rad], 0 to pi / 2
};

// Corners in the root [m], counter-clockwise seen from the front.
using Face = std::array<Eigen::Vector3d, 3>;

// Sums over faces [m^2].
struct LitArea {
  double area = 0.0;
  double lit = 0.0;       // each place's area times the part of the disc that it sees
  double projected = 0.0; // times the irradiance of a surface that faces the disc: the power
  double buried = 0.0;    // of places that face the disc, and are below the ground
};

// Each face is cut into congruent triangles, some `samples` of all faces together in proportion to
// their areas, at least one a face. One point in each, the same at every call, is tested with rays
// to 16 points of the disc, turned from place to place. The error is about the area of the pieces
// that an edge of a shadow crosses, over the square root of their number.
//
// `progress` is called at each place with the part of the area that is done, 0 to 1.
//
// A place below the ground of an obstacle is dark. With `bothSides` the back of each face counts as
// another face, so that the area is twice as large.
LitArea MeasureLitArea(const Obstacles& obstacles, const SunDisc& sun,
                       const std::vector<Face>& faces_R, bool bothSides, std::size_t samples,
                       const std::function<void(double)>& progress = {});

} // namespace dspace

#endif
