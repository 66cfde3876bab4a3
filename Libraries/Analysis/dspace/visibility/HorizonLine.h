// The horizon around a place, and how much of a disc stands above it.
#ifndef DSPACE_VISIBILITY_HORIZON_LINE_H
#define DSPACE_VISIBILITY_HORIZON_LINE_H

#include <vector>

#include <dspace/orientation/Site.h>

namespace dspace {

// Elevation by azimuth, linear between evenly spaced azimuths. Immutable.
class HorizonLine {
public:
  static constexpr int Most = 1000000;       // azimuths
  static constexpr double MostRadius = 10.0; // [deg] of a disc

  // The same elevation [deg], -90 to 90, in all azimuths.
  explicit HorizonLine(double elevation_deg = 0.0);
  // Clockwise; `first_deg` is the azimuth from north of the first. 1 to Most elevations [deg], -90
  // to 90. Throws Error(InvalidArgument).
  explicit HorizonLine(std::vector<double> elevations_deg, double first_deg = 0.0);

  double ElevationAt(double azimuth_deg) const; // [deg]

  // The highest point of a disc over the horizon [deg] (of a radius of 0: its centre); negative:
  // all of it is below. `radius_deg`: 0 to MostRadius. As for LitFraction, the sky around the disc
  // is taken as flat.
  double TopOver(const AzimuthElevation& center, double radius_deg) const;
  // The part of the disc's area above the horizon, 0 to 1; of a radius of 0: 0 or 1. The disc is
  // cut into columns, so that the horizon may have any shape across it. The error is
  // below 1e-3 where the horizon's slope across the disc is less than 1, and up to 8e-3 at a
  // vertical edge. The sky is taken as flat: columns depart from verticals by tan(elevation)
  // radius^2 / 2 (for the Sun at 60 degrees: 0.002 degrees).
  double LitFraction(const AzimuthElevation& center, double radius_deg) const;

private:
  std::vector<double> Elevations_; // [deg]
  double First_ = 0.0;             // [deg]
  double Least_ = 0.0;             // [deg]
  double Greatest_ = 0.0;
};

} // namespace dspace

#endif
