// Bodies in the sky over a place.
#ifndef DSPACE_SKY_SKY_VIEW_H
#define DSPACE_SKY_SKY_VIEW_H

#include <functional>
#include <string>

#include <Eigen/Core>

#include <dspace/AstronomicalUnit.h>
#include <dspace/ephemeris/Ephemeris.h>
#include <dspace/orientation/Frames.h>
#include <dspace/orientation/Site.h>

namespace dspace {

// A place that turns with a body: `axes.position` is from its centre in `frame`.
struct SkyPlace {
  int body = 0;      // NAIF id
  std::string frame; // body-fixed axes, as BodyFixed of FrameTable.h names them
  LocalAxes axes;
};

// A target as it is seen: light time until it converges and stellar aberration, both with the
// place's own velocity; no refraction and no bending of light by gravity (at most 2 arcsec, beside
// the Sun's limb).
struct SkyBody {
  AzimuthElevation direction;  // of its centre
  Eigen::Vector3d eastNorthUp; // unit, the same
  double range = 0.0;          // [m] to its centre
  double radius_deg = 0.0;     // of its disc, by its largest radius; 0: its radii are not known
  double litFraction =
      1.0; // of its disc, as of a sphere that the Sun lights; the Sun: 1 (SkyEclipse.h)
  double lightTime = 0.0; // [s]
};

// Throws what Ephemeris and Frames throw; Error(InvalidArgument) where the target is the place's
// own body.
SkyBody Look(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& place, int target,
             double tdb);

// The angle by which light from the direction of `toTarget` seems to come from a direction nearer
// to `velocity` of the observer [m/s], as SPICE has it (stelab). Keeps the length.
Eigen::Vector3d Aberrated(const Eigen::Vector3d& toTarget, const Eigen::Vector3d& velocity);

// A target's state from an observer's state (both from the solar system's barycentre, J2000) with
// converged light time; no aberration. The velocity is that of the target less the observer's.
struct Sighting {
  State state;
  double lightTime = 0.0; // [s]
};
Sighting Sight(const Ephemeris& ephemeris, int target, const State& observer, double tdb);

// A point that moves, where it was when its light left for an observer.
struct SightedPoint {
  SkyPlace place;
  State observer;         // as `from` has it
  Eigen::Vector3d away;   // from the observer, J2000 [m]; no aberration
  double lightTime = 0.0; // [s]
};
// `point`: the place at a TDB. States are from the solar system's barycentre, or where the point is
// about the observer's own body from this body's centre: there the body's motion does not change
// the distance. Throws what `point` throws.
SightedPoint SightPoint(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& from,
                        const std::function<SkyPlace(double tdb)>& point, double tdb);
// The observer's elevation over the point's own horizontal [deg], without aberration.
double ElevationFrom(const Frames& frames, const SightedPoint& seen, double tdb);

// The place's state from its body's centre, and from the solar system's barycentre, in J2000.
State StateAboutBody(const Frames& frames, const SkyPlace& place, double tdb);
State PlaceState(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& place,
                 double tdb);

} // namespace dspace

#endif
