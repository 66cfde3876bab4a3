// Values by direction over a place.
#ifndef DSPACE_VISIBILITY_DIRECTION_TABLE_H
#define DSPACE_VISIBILITY_DIRECTION_TABLE_H

#include <cstddef>
#include <vector>

#include <dspace/orientation/Site.h>

namespace dspace {

// Rows of evenly spaced elevations, each with evenly spaced azimuths clockwise from north.
// Immutable.
class DirectionTable {
public:
  static constexpr std::size_t MostValues = 1000000;

  // `values`: a row for each elevation, from `lowest_deg` up to `highest_deg` (both included).
  // Throws Error(InvalidArgument): no value or more than MostValues, not a whole number of rows,
  // values that are not finite or below 0, elevations beyond -90 to 90 or that do not ascend.
  DirectionTable(std::vector<double> values, std::size_t azimuths, double lowest_deg,
                 double highest_deg);

  // Linear between the four nearest; beyond the rows that of the nearest row.
  double At(const AzimuthElevation& direction) const;

private:
  std::vector<double> Values_;
  std::size_t Azimuths_;
  std::size_t Rows_;
  double Lowest_deg_;
  double Highest_deg_;
};

} // namespace dspace

#endif
