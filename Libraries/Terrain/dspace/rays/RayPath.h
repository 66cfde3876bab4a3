// A ray as a lattice of posts sees it: where it is in post coordinates, and where it crosses lines.
#ifndef DSPACE_TERRAIN_RAYPATH_H
#define DSPACE_TERRAIN_RAYPATH_H

#include <utility>
#include <vector>

#include <dspace/posts/PostLattice.h>
#include <dspace/posts/PostPlacement.h>

namespace dspace {

// t is the distance [m] along the ray from an origin of its own. Lines of the lattice are lines on
// a plane, half-planes of longitude and cones of latitude on a degree grid, and around a pole cones
// from the centre through circles that meet at the other pole.
class RayPath {
public:
  // `unit_S` is of length 1. Heights outside [low, high] are of no interest. A pole's chart must be
  // of a sphere.
  RayPath(const PostPlacement& placement, const PostLattice& lattice,
          const Eigen::Vector3d& origin_S, const Eigen::Vector3d& unit_S, double maximum,
          double low, double high);

  // The part that may meet the surface; empty where first > last.
  double First() const { return this->First_; }
  double Last() const { return this->Last_; }
  // Where the ray is nearest to a body's centre, through which directions jump; on a plane First().
  double Nearest() const { return this->Nearest_; }
  // From t to the distance from the origin given.
  double Distance(double t) const { return this->Entry_ + t; }

  // (c, r); on a sphere with c within half a turn of `column`.
  Eigen::Vector2d Post(double t, double column) const;
  double Height(double t) const; // [m] above the datum
  bool Rises(double t) const;
  std::pair<double, double> Heights(double t0, double t1) const; // least and greatest between
  // All t at which it may cross a column's or a row's line, in any order; also some where it does
  // not.
  void ColumnCrossings(double column, std::vector<double>& t) const;
  void RowCrossings(double row, std::vector<double>& t) const;
  bool Curved() const { return this->Curved_; } // not a straight line over the posts
  // The rounding error of heights along the ray.
  double Slack() const { return this->Slack_; }

private:
  bool Clip(double o, double d, double low, double high);
  BodyEllipsoid::Foot FootAt(double t) const { // of an ellipsoid
    return this->Placement_.Body().FootOf(this->Origin_ + t * this->Direction_);
  }
  void FindNearest();
  void RowCrossingsOfEllipsoid(double latitude, std::vector<double>& t) const;
  void CrossingsAtPole(int axis, double line, std::vector<double>& t) const;

  const PostPlacement& Placement_;
  bool Curved_;
  bool Flattened_; // on an ellipsoid
  bool AtPole_;    // on a pole's chart
  double Entry_ = 0.0;
  double First_ = 0.0;
  double Last_ = 0.0;
  double Slack_ = 0.0;
  // Plane: (c, r, height) and its change a metre. Degree grid: in the scene. Pole: in the chart's
  // axes.
  Eigen::Vector3d Origin_;
  Eigen::Vector3d Direction_;
  // Body: the t of the ray's lowest place. Sphere: how far it is from the centre, and the sine of
  // latitude at angle a past it, Amplitude cos(a - Phase).
  double Nearest_ = 0.0;
  double NearestRadius_ = 0.0;
  double Amplitude_ = 0.0;
  double Phase_ = 0.0;
};

} // namespace dspace

#endif
