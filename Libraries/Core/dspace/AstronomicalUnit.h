#ifndef DSPACE_ASTRONOMICAL_UNIT_H
#define DSPACE_ASTRONOMICAL_UNIT_H

namespace dspace {

inline constexpr double AstronomicalUnit = 149597870700.0; // [m] (IAU 2012, resolution B2)

} // namespace dspace

#endif
