// An ellipsoid of revolution as a body's reference surface.
#ifndef DSPACE_TERRAIN_BODYELLIPSOID_H
#define DSPACE_TERRAIN_BODYELLIPSOID_H

#include <Eigen/Core>

namespace dspace {

// Body-fixed frame: Z to the north pole, X to longitude 0; metres. `up` is the unit normal of the
// ellipsoid, whose angle with the equator is the geodetic latitude. A sphere has equal axes.
class BodyEllipsoid {
public:
  BodyEllipsoid() = default; // a sphere of 1 m
  // Throws Error(InvalidArgument) unless 0 < equatorial <= 1e12 and half of it <= polar <= all.
  BodyEllipsoid(double equatorial, double polar);

  bool Spherical() const { return this->Squash_ == 0.0; }
  double Equatorial() const { return this->Equatorial_; }
  double Polar() const { return this->Polar_; }
  double Squash() const { return this->Squash_; } // eccentricity squared
  // Radii of curvature along the parallel and the meridian where the sine of latitude is `sine`.
  double EastRadius(double sine) const;
  double NorthRadius(double sine) const;

  Eigen::Vector3d Point(const Eigen::Vector3d& up, double height) const;
  struct Foot {
    Eigen::Vector3d up;
    double height; // along it
  };
  // Up is Z at the centre.
  Foot FootOf(const Eigen::Vector3d& p) const;

private:
  double Equatorial_ = 1.0;
  double Polar_ = 1.0;
  double Squash_ = 0.0;
};

} // namespace dspace

#endif
