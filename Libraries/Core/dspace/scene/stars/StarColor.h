// The colour of a star.
#ifndef DSPACE_SCENE_STAR_COLOR_H
#define DSPACE_SCENE_STAR_COLOR_H

#include <array>

namespace dspace {

// Temperature [K] of a star with colour index B-V: F. J. Ballesteros, "New insights into black
// bodies", EPL 97 (2012) 34008. B-V is limited to -0.4 to 2.0, where the formula is meant to hold.
double StarTemperature(double colorIndex);

// Linear light (red, green, blue, ITU-R BT.709) of a black body of the temperature of B-V against
// one of the Sun's (B-V 0.653), which is white: of luminance 1. Black bodies by Planck's law, and
// the eye by C. Wyman, P. Sloan, P. Shirley, "Simple Analytic Approximations to the CIE XYZ Color
// Matching Functions", JCGT 2 (2013). NaN: white.
std::array<float, 3> StarColor(double colorIndex);

} // namespace dspace

#endif
