// Constants of bodies: rotation, radii, GM.
#ifndef DSPACE_ORIENTATION_BODY_CONSTANTS_H
#define DSPACE_ORIENTATION_BODY_CONSTANTS_H

#include <optional>

#include <Eigen/Core>

#include <dspace/ephemeris/FrameTurns.h>
#include <dspace/kernels/KernelPool.h>

namespace dspace {

// The constants that ship: NAIF's pck00011.tpc (the IAU's report of 2015, Archinal et al. 2018:
// rotation and radii of the Sun, the planets, their moons and some asteroids) and gm_de440.tpc.
const KernelPool& StandardConstants();

// Of `pool` where it has the body's, else of StandardConstants().
// Radii of the ellipsoid [m] along the body-fixed axes. Throws Error(NotFound).
Eigen::Vector3d BodyRadii(const KernelPool& pool, int body);
// GM [m^3/s^2]; absent: not known.
std::optional<double> BodyGm(const KernelPool& pool, int body);

// A body's axes by its rotation elements (NAIF, "PCK Required Reading").
struct BodyTurn {
  int base = 1;       // the inertial frame that the elements refer to
  StateTurn turn;     // from `base` to the body-fixed axes
  const char* source; // "pck00011" or "the loaded PCK"
};

// Whether the pool or StandardConstants() has the body's rotation.
bool HasBodyRotation(const KernelPool& pool, int body);
// The pole's right ascension and declination are polynomials of TDB centuries, and the prime
// meridian's angle one of days, past J2000 (or past BODYnnn_CONSTANTS_JED_EPOCH), plus the sines
// and cosines of the system's angles BODYn_NUT_PREC_ANGLES. Throws Error(NotFound) for a body
// without, Error(Corrupt) that names the variable.
BodyTurn BodyRotation(const KernelPool& pool, int body, double tdb);

} // namespace dspace

#endif
