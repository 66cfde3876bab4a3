// A plane for the wheel tracks of a body.
#ifndef DSPACE_TERRAIN_TRACKCHART_H
#define DSPACE_TERRAIN_TRACKCHART_H

#include <Eigen/Geometry>

#include <dspace/crs/BodyEllipsoid.h>

namespace dspace {

// Stereographic about an anchor (Snyder 1987, p. 154): conformal, so that a rut keeps its shape and
// only its size depends on the place. An ellipsoid is first mapped to a sphere of its equatorial
// radius by conformal latitude (p. 16). X is east and Y north at the anchor; metres, to scale there
// on a sphere. Directions are unit verticals (BodyEllipsoid).
class TrackChart {
public:
  // [rad] from the anchor, on the sphere: the scale is below 4 there.
  static constexpr double Reach = 2.0 * M_PI / 3.0;
  // How much wider than on the ellipsoid a rut is in the chart, at most: ground lower than a fifth
  // of the radius below it shows narrower ones.
  static constexpr double Widest = 1.25;

  TrackChart(const BodyEllipsoid& body, const Eigen::Vector3d& anchor);

  const Eigen::Vector3d& Anchor() const { return this->Anchor_; } // its vertical
  // Of a direction on the sphere; without meaning at the antipode.
  Eigen::Vector2d ToChart(const Eigen::Vector3d& up) const;
  Eigen::Vector3d ToUp(const Eigen::Vector2d& place) const;
  // Metres of the chart per metre on the ellipsoid.
  double Scale(const Eigen::Vector3d& up) const;
  double Scale(const Eigen::Vector2d& place) const { return this->Scale(this->ToUp(place)); }
  // East at a place, as an angle counter-clockwise from the chart's X [rad].
  double East(const Eigen::Vector3d& up) const;

  // The conformal sphere's direction of a vertical, and back.
  Eigen::Vector3d ToSphere(const Eigen::Vector3d& up) const;
  Eigen::Vector3d FromSphere(const Eigen::Vector3d& s) const;
  // [rad] from the anchor, on the sphere.
  double Distance(const Eigen::Vector3d& up) const;

  // A box of the chart that holds all within `angle` [rad] of a direction on the sphere; infinite
  // around the antipode.
  Eigen::AlignedBox2d BoxOf(const Eigen::Vector3d& s, double angle) const;
  // [rad] on the sphere from the middle of a box of the chart to all of it.
  double AngleOf(const Eigen::AlignedBox2d& box) const;

private:
  BodyEllipsoid Body_;
  Eigen::Vector3d Anchor_;
  Eigen::Matrix3d Axes_; // rows: east, north, vertical of the anchor on the sphere
};

} // namespace dspace

#endif
