// Turns of coordinate axes.
#ifndef DSPACE_ORIENTATION_AXIS_TURNS_H
#define DSPACE_ORIENTATION_AXIS_TURNS_H

#include <cmath>

#include <Eigen/Core>

#include <dspace/ephemeris/FrameTurns.h>

namespace dspace {

constexpr double Degree = M_PI / 180.0; // [rad]

// NAIF's [angle]axis: from a frame's components to those of the frame that is turned by `angle`
// [rad] about its axis 1 (x), 2 (y) or 3 (z).
inline Eigen::Matrix3d AxisTurn(double angle, int axis) {
  const int i = axis % 3; // the two other axes, in cyclic order
  const int j = (axis + 1) % 3;
  Eigen::Matrix3d out = Eigen::Matrix3d::Identity();
  out(i, i) = out(j, j) = std::cos(angle);
  out(i, j) = std::sin(angle);
  out(j, i) = -out(i, j);
  return out;
}

// The same with the angle's rate [rad/s].
inline StateTurn AxisTurn(double angle, double rate, int axis) {
  StateTurn out;
  out.rotation = AxisTurn(angle, axis);
  const int i = axis % 3;
  const int j = (axis + 1) % 3;
  out.rate(i, i) = out.rate(j, j) = -rate * std::sin(angle);
  out.rate(i, j) = rate * std::cos(angle);
  out.rate(j, i) = -out.rate(i, j);
  return out;
}

// [w]3 [delta]1 [phi]3, by which PCKs turn inertial axes to body-fixed ones.
inline StateTurn PoleTurn(double phi, double phiRate, double delta, double deltaRate, double w,
                          double wRate) {
  return AxisTurn(w, wRate, 3) * (AxisTurn(delta, deltaRate, 1) * AxisTurn(phi, phiRate, 3));
}

} // namespace dspace

#endif
