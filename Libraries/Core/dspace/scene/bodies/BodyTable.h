// What is known of the Sun, planets and large moons.
#ifndef DSPACE_SCENE_BODY_TABLE_H
#define DSPACE_SCENE_BODY_TABLE_H

#include <string>
#include <vector>

#include <dspace/import/model/Reflectance.h>
#include <dspace/scene/bodies/CelestialBody.h>

namespace dspace {

// Where its numbers come from: `radii` B. Archinal et al., "Report of the IAU Working Group on
// Cartographic Coordinates and Rotational Elements: 2015", Celest. Mech. Dyn. Astr. 130 (2018) 22,
// as in NAIF's pck00011.tpc (the Earth: WGS 84; the Moon and Mars: the spheroids of their maps,
// IAU_2015, are close: 1737.4 km, and 3396.19 and 3376.2 km). `geometricAlbedo`, visual: D. R.
// Williams, NASA Planetary Fact Sheets, NSSDCA. Rings of Saturn: NASA PDS Ring-Moon Systems Node,
// optical depths rounded from J. Colwell et al. in "Saturn from Cassini-Huygens" (2009),
// chapter 13.
struct KnownBody {
  std::string name; // lower case
  BodyShape shape;
  double geometricAlbedo = 0.0; // 0: it is the Sun
  Reflectance::Model model = Reflectance::Model::Lambert;
};

const std::vector<KnownBody>& KnownBodies();

// By its name in any case. Throws Error(NotFound) naming `object`, the name and those that there
// are.
const KnownBody& FindBody(const std::string& object, const std::string& name);

// The normal albedo with which a sphere of this model has the geometric albedo: for Lambert 3/2 of
// it, for Lommel-Seeliger and lunar-Lambert at full phase itself.
double NormalAlbedo(double geometricAlbedo, Reflectance::Model model);

} // namespace dspace

#endif
