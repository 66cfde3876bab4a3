// How the cells of a horizon map are lit over a time.
#ifndef DSPACE_MAPS_ILLUMINATION_H
#define DSPACE_MAPS_ILLUMINATION_H

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/maps/HorizonMap.h>
#include <dspace/maps/MapWork.h>

namespace dspace {

struct IlluminationOptions {
  enum class Quantity {
    LitFraction,     // of the time, 0 to 1: the mean of the visible part of the Sun's disc,
                     // eclipses included
    LongestNight,    // [s] with the disc completely hidden: consecutive steps times the step
    PermanentShadow, // 1: the disc is hidden at every step; 0: else
    EarthFraction,   // of the steps at which the Earth's centre is above the horizon, 0 to 1
    StationFraction  // of the steps at which a station is above the horizon, 0 to 1
  };
  static constexpr std::size_t MostSteps = 10000000;

  // Of the Sun's and the Earth's centres at every step, in the terrain's frame S [m]: the
  // body-fixed frame, or X east, Y north, Z up of a plane. 1 to MostSteps; the Earth's may be
  // absent. A body that eclipses the Sun may be given in the same way; eclipses are no nights.
  std::vector<Eigen::Vector3d> sun_S;
  std::vector<Eigen::Vector3d> earth_S;
  std::vector<Eigen::Vector3d> eclipser_S;
  // The stations in operation at every step: those that see the ground over their own masks.
  std::vector<std::vector<Eigen::Vector3d>> stations_S;
  double step_s = 3600.0;      // > 0
  double sunRadius = 695700e3; // [m], >= 0 (IAU 2015 resolution B3)
  double eclipserRadius = 0.0; // [m], >= 0
  std::vector<Quantity> quantities = {Quantity::LitFraction};
};

// Writes the map: a band a quantity, NaN where the horizon map has no data. Elevations are those
// over the local horizontal at the cell, at height 0. The horizon is linear between the map's
// azimuths, and the part of the disc above it is that above a straight line (LitFraction). Where
// nothing is in sight, and on a plane below 0, the horizon is level. Refraction does not count.
//
// Continues, finishes and ends as WriteHorizonMap does. Throws what it throws, and
// Error(InvalidArgument) for an option out of range.
bool WriteIllumination(const HorizonMap& horizons, const IlluminationOptions& options,
                       const std::string& path, const MapControl& control = {});

} // namespace dspace

#endif
