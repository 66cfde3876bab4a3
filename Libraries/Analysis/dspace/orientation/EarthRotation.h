// The Earth's axes without a kernel.
#ifndef DSPACE_ORIENTATION_EARTH_ROTATION_H
#define DSPACE_ORIENTATION_EARTH_ROTATION_H

#include <string>

#include <dspace/ephemeris/FrameTurns.h>
#include <dspace/time/EarthOrientation.h>
#include <dspace/time/TimeScales.h>

namespace dspace {

// From J2000 to the Earth's terrestrial axes: IAU 2006/2000A precession and nutation and the Earth
// rotation angle (ERFA's eraC2t06a). J2000 is taken as the GCRS, as SPICE does. UT1 is that of
// `scales` where they have it, else UTC. Polar motion is that of `earth` (null: none) where it
// covers the day, else 0. The rate is that of the Earth's rotation angle; that of precession,
// nutation and polar motion (1e-11 rad/s) is left out.
// Throws Error(InvalidArgument) where there is no UTC (before 1960).
StateTurn EarthRotation(double tdb, const TimeScales& scales, const EarthOrientation* earth);

// Its error in words.
std::string EarthRotationAccuracy(double tdb, const TimeScales& scales,
                                  const EarthOrientation* earth);

} // namespace dspace

#endif
