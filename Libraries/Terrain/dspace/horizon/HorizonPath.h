// The ground below a line of sight: a straight line over the posts of a plane, a great circle over
// those of a body.
#ifndef DSPACE_TERRAIN_HORIZONPATH_H
#define DSPACE_TERRAIN_HORIZONPATH_H

#include <dspace/posts/ChartAxes.h>
#include <dspace/posts/PostPlacement.h>

namespace dspace {

// A direction as an observer at a post sees it.
struct ChartDirection {
  double azimuth_deg;   // clockwise from the chart's north, 0 to 360
  double elevation_deg; // over the plane that is normal to the local vertical
};
ChartDirection ChartDirectionAt(const PostPlacement& placement, const Eigen::Vector2d& post,
                                const Eigen::Vector3d& direction_S);

// From a post in an azimuth of its chart. The elevation of ground of height h at `At(s)`, seen from
// height z at the post, has the tangent (fall + rise h - z) / (away + spread h): exact on a plane
// and on a sphere, on an ellipsoid to second order of its flattening.
class HorizonPath {
public:
  struct Point {
    Eigen::Vector2d post; // level-0 posts; on a degree grid within half a turn of the path's first
    double fall;          // [m]
    double rise;
    double away; // [m]
    double spread;
  };

  HorizonPath(const PostPlacement& placement, const Eigen::Vector2d& post, double azimuth_deg);

  // At a distance along the ground of height 0 [m]; of an ellipsoid along its greatest sphere.
  Point At(double distance) const;
  // The distance [m] from the place `from`, which is `s` metres away, to the next one, such that
  // the straight line between them in posts departs from the great circle by at most 2e-5 of the
  // distance from the observer, or a little more within half a post of a pole; at most 8 posts of
  // `post` metres.
  double FineStep(const Point& from, double s, double post) const;
  // Straight in posts.
  bool Straight() const { return !this->Placement_.OnBody(); }

private:
  const PostPlacement& Placement_;
  Eigen::Vector2d Post_;
  Eigen::Vector2d PerMetre_ = Eigen::Vector2d::Zero(); // plane: posts a metre
  Eigen::Vector3d Up_;
  Eigen::Vector3d Along_;                 // level, in the azimuth
  Eigen::Vector3d AlongNormals_;          // as the directions of verticals turn on the way
  Eigen::Vector3d Foot_;                  // of the post, on an ellipsoid
  Eigen::Vector2d Meridian_ = {1.0, 0.0}; // cosine and sine of the longitude of the post
};

} // namespace dspace

#endif
