// Ornaments made of several parts, each with its material.
#ifndef DSPACE_SCENE_MARKERS_H
#define DSPACE_SCENE_MARKERS_H

#include <array>
#include <vector>

#include <dspace/scene/Camera.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace {

// Unlit, so that they can be read at night. Lengths are metres, 1e-9 to 1e15.
// All throw Error(InvalidArgument) naming the marker and the value.

// Arrows along X (red), Y (green), Z (blue), sharing one mesh.
std::vector<Part> MakeAxes(double length);

// The view volume of a camera with an image of width × height pixels up to `length` along Z, in the
// camera's axes (X right, Y down, Z forward): its edges as lines, then its faces, translucent.
// Perspective kinds begin at the origin, an orthographic one at Z = 0. The corners are the outer
// borders of the corner pixels.
std::vector<Part> MakeFrustumPyramid(const Projection& projection, double length, int width,
                                     int height);

// A pole of `height` along Z from the origin with a flag towards +X, and a ring on the ground.
std::vector<Part> MakeGoalMarker(double height);

// A ring of `radius` in XY with its two diameters and a needle along Z. White: TiltColor through
// the object's material override gives it its colour.
std::vector<Part> MakeTiltMarker(double radius);

// sRGB: green upright, yellow at warn_deg, red from limit_deg on, linear between.
// tilt_deg is the angle from upright, 0 to 180; 0 < warn_deg < limit_deg <= 180.
std::array<double, 3> TiltColor(double tilt_deg, double warn_deg, double limit_deg);

} // namespace dspace

#endif
