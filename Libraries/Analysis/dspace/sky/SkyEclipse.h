// Eclipses of the Sun over a place.
#ifndef DSPACE_SKY_SKY_ECLIPSE_H
#define DSPACE_SKY_SKY_ECLIPSE_H

#include <optional>

#include <dspace/sky/SkyView.h>

namespace dspace {

// The body that eclipses the Sun over places on `body` (NAIF ids): the Earth over the Moon, and the
// Moon over the Earth. None over others.
std::optional<int> EclipserOver(int body);

// The part of the Sun's disc, 0 to 1, that this body leaves, both as discs of their largest radii;
// whether they are above the horizon does not count. The Earth's air, which refracts some light
// into its shadow, does not count either. `sun`: as Look() sees it from the place at `tdb`. 1 where
// there is no such body. Throws what Look() throws.
double SunLeftOver(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& place,
                   const SkyBody& sun, double tdb);

} // namespace dspace

#endif
