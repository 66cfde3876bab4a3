// The points of a body below the Sun or below an observer.
#ifndef DSPACE_SKY_SUB_POINTS_H
#define DSPACE_SKY_SUB_POINTS_H

#include <optional>
#include <string>

#include <dspace/ephemeris/Ephemeris.h>
#include <dspace/orientation/Frames.h>

namespace dspace {

// Where the line from a body's centre to another body leaves its ellipsoid (SPICE's method
// "intercept").
struct SubPoint {
  double longitude_deg = 0.0;         // east, in (-180, 180]
  double latitude_deg = 0.0;          // planetocentric
  double geodetic_latitude_deg = 0.0; // of the ellipsoid's normal there
  Eigen::Vector3d position;           // [m] in the body-fixed axes
  double epoch = 0.0; // TDB [s] at the body: the observer's time less the light's travel to it
};

// `frame` is body-fixed; empty: the body's own (BodyFixed of FrameTable.h). With an observer, the
// point is that which light shows to it at `tdb`: of the epoch when that light left, under a Sun
// whose light arrived then. Without, the epoch is `tdb`. `correction`: how light shows the Sun to
// the body, and the body to the observer; light times are always iterated. Throws what Ephemeris
// and Frames throw.
SubPoint SubSolarPoint(const Ephemeris& ephemeris, const Frames& frames, int body,
                       const std::string& frame, double tdb, std::optional<int> observer = {},
                       Correction correction = Correction::ConvergedStar);
// Below an observer, which sees the point at `tdb`.
SubPoint SubObserverPoint(const Ephemeris& ephemeris, const Frames& frames, int body,
                          const std::string& frame, int observer, double tdb,
                          Correction correction = Correction::ConvergedStar);

} // namespace dspace

#endif
