// When a target stands above the horizon of a place.
#ifndef DSPACE_VISIBILITY_CONTACTS_H
#define DSPACE_VISIBILITY_CONTACTS_H

#include <functional>
#include <optional>
#include <vector>

#include <dspace/sky/SkyView.h>
#include <dspace/visibility/HorizonLine.h>

namespace dspace {

// How a target is seen at a time. The target is in contact while `margin_deg` is not negative.
struct Sighted {
  AzimuthElevation direction;
  double range = 0.0;      // [m]
  double margin_deg = 0.0; // the least of the heights over the horizon, and over the masks
};

// One contact. Times are TDB [s past J2000].
struct Contact {
  double rise = 0.0;
  double set = 0.0;
  double peak = 0.0;        // of the greatest elevation
  bool sinceBefore = false; // it has begun before the span: `rise` is the span's start
  bool untilAfter = false;  // it ends after the span: `set` is the span's end
  Sighted atRise, atSet, atPeak;
};

// Throws Error(InvalidArgument) unless `start` < `end`, and `step` > 0 cuts them into MostSteps at
// most.
constexpr int MostSteps = 2000000;
void RequireSpan(double start, double end, double step);

// Finds contacts in a span by samples `step` apart and by bisection, to 1e-3 s. Where three samples
// turn without a change of sign, the extremum between them is found first: contacts and gaps
// shorter than a step are found too, unless two of them lie within two steps. Throws what
// RequireSpan and `look` throw.
std::vector<Contact> FindContacts(const std::function<Sighted(double)>& look, double start,
                                  double end, double step);

// A body or spacecraft of the ephemeris, a station on a body, or a point that moves.
struct ContactTarget {
  int body = 0; // NAIF id
  // The place of a station or of a moving point at a TDB; empty: the body's centre counts.
  std::function<SkyPlace(double tdb)> point;
  // Of a station: least elevation of the place over the point's own horizontal; absent: the point's
  // axes do not count.
  std::optional<double> stationMask_deg;
};

// `target` at `tdb` over a place with a horizon: with light time and stellar aberration, without
// refraction. The velocity that aberrates is that of the place's body and of the turn of its axes,
// not the place's own over them (7 km/s: 5 arcsec). A point is where it was when its light left
// (SightPoint). A station sees the place where it is now, without aberration (at most 0.006
// degrees). `upper`: the top of the body's disc counts, not its centre. Bodies do not hide the
// target. Throws what Look and `point` throw; Error(InvalidArgument) for a station on the place's
// own body, and for a point where the place is.
Sighted LookOver(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& place,
                 const HorizonLine& horizon, const ContactTarget& target, double tdb,
                 bool upper = false);

} // namespace dspace

#endif
