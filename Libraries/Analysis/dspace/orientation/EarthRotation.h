// The Earth's axes without a kernel.
#ifndef DSPACE_ORIENTATION_EARTH_ROTATION_H
#define DSPACE_ORIENTATION_EARTH_ROTATION_H

#include <string>

#include <dspace/ephemeris/FrameTurns.h>
#include <dspace/time/TimeScales.h>

namespace dspace {

// From J2000 to the Earth's terrestrial axes: IAU 2006/2000A precession and nutation and the Earth
// rotation angle (ERFA's eraC2t06a), without polar motion. J2000 is taken as the GCRS, as SPICE
// does. UT1 is that of `scales` where they have it, else UTC. The rate is that of the Earth's
// rotation angle; that of precession and nutation (1e-11 rad/s) is left out.
// Throws Error(InvalidArgument) where there is no UTC (before 1960).
StateTurn EarthRotation(double tdb, const TimeScales& scales);

// Its error in words.
std::string EarthRotationAccuracy(double tdb, const TimeScales& scales);

} // namespace dspace

#endif
