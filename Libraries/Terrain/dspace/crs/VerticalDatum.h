// The zero of heights, and the error of drawing without the grid of a geoid or areoid.
#ifndef DSPACE_TERRAIN_VERTICALDATUM_H
#define DSPACE_TERRAIN_VERTICALDATUM_H

#include <string>

namespace dspace {

// Semi-axes of the body's reference ellipsoid [m]; equal for a sphere, 0 where no CRS is known.
struct BodyAxes {
  double semiMajor = 0.0;
  double semiMinor = 0.0;
};

// The surface that heights are measured from. It is metadata of a grid and never guessed: a file
// that does not state it has Unknown, unless it is given by hand.
struct VerticalDatum {
  enum class Kind {
    Unknown,   // not stated
    Ellipsoid, // the ellipsoid of the CRS
    Sphere,    // a sphere of `radius` metres
    Radius,    // values are distances from the body's centre; heights are value - `radius`
    Areoid,    // Mars' equipotential (MOLA); its grid is not used
    Geoid,     // Earth's equipotential (EGM, NAVD88); its grid is not used
    Relative   // heights have no common zero: only differences mean anything
  };
  Kind kind = Kind::Unknown;
  double radius = 0.0; // [m], Sphere and Radius; 0 stands for the CRS's semi-major axis
  std::string name;    // as the file or the user names it; may be empty

  // "unknown", "ellipsoid", "sphere:R", "radius:R", "areoid", "geoid" or "relative", R in metres.
  std::string Text() const;

  // From such a text; ":R" may be left out. Throws Error(InvalidArgument) naming what is accepted.
  static VerticalDatum FromText(const std::string& text);
};

// Greatest distance [m] between `datum`'s zero and the sphere of the CRS's semi-major axis (for the
// Earth: the CRS's ellipsoid), for latitudes up to `latitude_deg` from the equator. 0 where the two
// coincide, +infinity where nothing is known. Mars: the areoid stays within 2 km of the ellipsoid
// 3396.19/3376.20 km (MOLA's own range is -0.8 to 1.6 km), to which the ellipsoid's own departure
// from the sphere at that latitude is added. Earth: the geoid (EGM2008) stays within 107 m.
double DatumErrorBound(const VerticalDatum& datum, const BodyAxes& axes, double latitude_deg);

// The warning that goes with drawing `datum`'s heights without its grid; empty where none is due.
std::string DatumWarning(const VerticalDatum& datum, const BodyAxes& axes, double latitude_deg);

} // namespace dspace

#endif
