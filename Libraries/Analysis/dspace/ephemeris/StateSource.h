// What ephemerides get their states from.
#ifndef DSPACE_ANALYSIS_STATE_SOURCE_H
#define DSPACE_ANALYSIS_STATE_SOURCE_H

#include <optional>
#include <string>
#include <vector>

#include <dspace/kernels/State.h>

namespace dspace {

// Of the masses of the Earth and the Moon together, with DE405's ratio of the two.
constexpr double MoonMassShare = 1.0 / (1.0 + 81.30056);

// A source of states of bodies: a kernel, a table of a trajectory, a theory. Bodies and frames have
// NAIF's ids. A source is immutable, and several threads call it.
class StateSource {
public:
  // A body's state from one other body, which is nearer to the solar system's barycentre (0).
  struct Link {
    int center = 0;
    int frame = 1; // axes of the state: 1 is J2000
    State state;
    int part = 0; // which of Coverages() it came from
  };
  // When a body's state is known.
  struct Coverage {
    int body = 0;
    int center = 0;
    int frame = 1;
    double begin = 0.0; // TDB [s past J2000]
    double end = 0.0;   // inclusive
    std::string name;   // "" or the segment's name in its file
  };

  virtual ~StateSource() = default;

  // "kernel '/data/de430.bsp'", "JPL DE405", "ERFA": unique among the sources of an ephemeris.
  virtual const std::string& Name() const = 0;
  // The stated accuracy of a body's states in words: "within 32 km"; empty: not stated.
  virtual std::string Accuracy(int body) const = 0;
  // A warning for who uses the body's states; empty: none. ERFA's states have one.
  virtual std::string Warning(int /*body*/) const { return {}; }
  virtual const std::vector<Coverage>& Coverages() const = 0;
  // The state of `body` at `tdb`; none: this source does not know the body, or not at that time.
  // Throws Error(Corrupt, Unsupported, Io) where it should know the state and cannot read it.
  virtual std::optional<Link> Find(int body, double tdb) const = 0;
};

} // namespace dspace

#endif
