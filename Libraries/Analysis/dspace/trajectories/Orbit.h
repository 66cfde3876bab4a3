// Conics: orbital elements from a state and back, and motion along them.
#ifndef DSPACE_TRAJECTORIES_ORBIT_H
#define DSPACE_TRAJECTORIES_ORBIT_H

#include <string>
#include <vector>

#include <dspace/trajectories/Trajectory.h>

namespace dspace {

// Of a state about a centre, in the axes of the state's frame (D. Vallado, "Fundamentals of
// Astrodynamics and Applications", 4th ed., 2.5). Angles that a conic does not have are 0, and what
// they would tell is in the next one: of a circle the argument of periapsis, in the plane of X and
// Y the ascending node, which is then the X axis.
struct OrbitalElements {
  double mu = 0.0;                    // GM of the centre [m^3/s^2]
  double semiLatusRectum = 0.0;       // p = h^2 / mu [m]
  double eccentricity = 0.0;          // below 1: ellipse; 1: parabola; above 1: hyperbola
  double inclination_deg = 0.0;       // 0 to 180
  double ascendingNode_deg = 0.0;     // 0 to 360
  double periapsisArgument_deg = 0.0; // 0 to 360
  double trueAnomaly_deg = 0.0;       // 0 to 360; of open conics -180 to 180

  // [m]; negative: hyperbola; infinite: parabola.
  double SemiMajorAxis() const;
  double PeriapsisRadius() const; // [m]
  double ApoapsisRadius() const;  // [m]; infinite: open conics
  double Period() const;          // [s]; infinite: open conics
  // From periapsis, times the mean motion sqrt(mu / |a|^3) [deg]: 0 to 360, of hyperbolas of any
  // size and sign; NaN: parabola.
  double MeanAnomaly_deg() const;
};

// Throws Error(InvalidArgument) naming `object`: mu <= 0, a state that is not finite, a position at
// the centre, a velocity along the position (no plane).
OrbitalElements ElementsOf(const State& state, double mu, const std::string& object);
// Throws Error(InvalidArgument) naming `object` and the value: mu or p <= 0, e < 0, an inclination
// outside 0 to 180, a true anomaly that the open conic does not reach.
State StateOf(const OrbitalElements& elements, const std::string& object);

// The state after `dt` seconds of two-body motion, by universal variables (Vallado, algorithm 8,
// with Newton's steps kept within a bracket): all conics, forwards and backwards. Throws
// Error(InvalidArgument) as ElementsOf, except that there may be no plane.
State Propagate(const State& state, double mu, double dt_s, const std::string& object);

// Positions p_F on the conic for drawing it: the whole ellipse, ending where it begins, or an open
// conic out to `farthest` [m] from the centre, which must be beyond the periapsis. Evenly spaced in
// eccentric anomaly, of open conics in the square root of the distance from periapsis. count >= 3.
std::vector<Eigen::Vector3d> OrbitPoints(const OrbitalElements& elements, std::size_t count,
                                         double farthest, const std::string& object);

// Two-body motion about the centre from a state, at any time.
class Conic : public Trajectory {
public:
  // `state` at `epoch_s`. Throws as Propagate.
  Conic(std::string name, const State& state, double epoch_s, double mu);
  TimeSpan Span() const override;
  State At(double time_s) const override;

private:
  std::string Name_;
  State State_;
  double Epoch_s_;
  double Mu_;
};

} // namespace dspace

#endif
